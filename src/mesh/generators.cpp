#include "osculate/mesh/generators.hpp"

#include "mesh/structured_grid.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace osculate::mesh {
namespace {

void require_positive(std::initializer_list<std::pair<const char*, double>> lengths) {
    for (const auto& [name, value] : lengths)
        if (!(value > 0) || !std::isfinite(value))
            throw std::invalid_argument(std::string(name) + " must be positive and finite, not " +
                                        std::to_string(value));
}

/// The point at `step` of `steps` equal parts between a and b; exactly a and b at the ends, symmetric about the middle.
double divide(double a, double b, int step, int steps) {
    return (a * (steps - step) + b * step) / steps;
}

} // namespace

Mesh make_block(const Vec3& origin, const Vec3& size, const std::array<int, 3>& divisions, CellType element,
                BlockPattern pattern) {
    require_positive({{"size x", size.x()}, {"size y", size.y()}, {"size z", size.z()}});
    if (!origin.allFinite()) throw std::invalid_argument("origin must be finite");
    const Vec3 end = origin + size;
    const std::array<int, 3> n = grid_divisions(divisions, element);
    const auto position = [&](int i, int j, int k) {
        return Vec3(divide(origin.x(), end.x(), i, n[0]), divide(origin.y(), end.y(), j, n[1]),
                    divide(origin.z(), end.z(), k, n[2]));
    };
    return mesh_grid({n, {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}, position}, element, pattern);
}

Mesh make_half_tube(double inner_radius, double thickness, double length, const std::array<int, 3>& divisions,
                    CellType element) {
    require_positive({{"inner_radius", inner_radius}, {"thickness", thickness}, {"length", length}});
    const double half_turn = std::numbers::pi / 2;
    // k runs inward: around, along y and inward are right-handed.
    const std::array<int, 3> n = grid_divisions(divisions, element);
    const auto position = [&](int i, int j, int k) {
        const double theta = divide(-half_turn, half_turn, i, n[0]);
        const double r = divide(inner_radius + thickness, inner_radius, k, n[2]);
        // cos(pi/2) is not quite zero: the rims lie in the plane z = 0 exactly.
        const double cosine = i == 0 || i == n[0] ? 0.0 : std::cos(theta);
        return Vec3(r * std::sin(theta), divide(0, length, j, n[1]), -r * cosine);
    };
    return mesh_grid({n, {"rim_left", "rim_right", "y_min", "y_max", "outer", "inner"}, position}, element,
                     BlockPattern::quad);
}

Mesh make_contactor(double radius, double width, double length, double height, double rear,
                    const std::array<int, 3>& divisions, CellType element) {
    require_positive({{"radius", radius}, {"width", width}, {"length", length}, {"height", height}});
    if (!std::isfinite(rear)) throw std::invalid_argument("rear must be finite");
    const double half = width / 2, top = height - radius;
    if (half > radius) throw std::invalid_argument("width must not exceed twice the radius");
    if (!(top > -std::sqrt(radius * radius - half * half)))
        throw std::invalid_argument("height is too small: the flat top would cut the underside");
    const std::array<int, 3> n = grid_divisions(divisions, element);
    const auto position = [&](int i, int j, int k) {
        const double x = divide(-half, half, i, n[0]);
        const double bottom = -std::sqrt(radius * radius - x * x);
        return Vec3(x, divide(rear, rear + length, j, n[1]), divide(bottom, top, k, n[2]));
    };
    return mesh_grid({n, {"left", "right", "rear", "front", "bottom", "top"}, position}, element, BlockPattern::quad);
}

void place(Mesh& mesh, const Vec3& axis, double angle, const Vec3& translation, double scale) {
    require_positive({{"scale", scale}, {"length of the axis", axis.norm()}});
    if (!std::isfinite(angle) || !translation.allFinite())
        throw std::invalid_argument("angle and translation must be finite");
    const Mat3 rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    for (Vec3& node : mesh.nodes) node = scale * (rotation * node) + translation;
}

} // namespace osculate::mesh
