#include "osculate/mesh/generators.hpp"

#include "mesh/structured_grid.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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

/// Every line and the middle of every part.
std::vector<double> with_middles(const std::vector<double>& lines) {
    std::vector<double> result{lines.front()};
    for (std::size_t i = 1; i < lines.size(); ++i) {
        result.push_back((lines[i - 1] + lines[i]) / 2);
        result.push_back(lines[i]);
    }
    return result;
}

/// Height of a crowned underside above its lowest point, as a function of x and y.
std::function<double(double, double)> rise_of(const Crown& crown, const Vec3& lowest, const Vec3& origin,
                                              const Vec3& size) {
    if (crown.radius == 0) return [](double, double) { return 0.0; };
    const double R = crown.radius;
    const auto distance = [lowest, along = crown.along](double x, double y) {
        const double dx = along == Crown::Along::x ? 0 : x - lowest.x(),
                     dy = along == Crown::Along::y ? 0 : y - lowest.y();
        return std::hypot(dx, dy);
    };
    // R - sqrt(R^2 - d^2) without cancellation
    const auto rise = [R, distance](double x, double y) {
        const double d = distance(x, y);
        return d * d / (R + std::sqrt((R - d) * (R + d)));
    };
    for (const double x : {origin.x(), origin.x() + size.x()})
        for (const double y : {origin.y(), origin.y() + size.y()})
            if (!(R > distance(x, y)) || !(rise(x, y) < size.z()))
                throw std::invalid_argument("radius of crown is too small for a block of this size");
    return rise;
}

} // namespace

Mesh make_block(const Vec3& origin, const Vec3& size, const std::array<int, 3>& divisions, CellType element,
                BlockPattern pattern, const Focus& focus, const Crown& crown) {
    require_positive({{"size x", size.x()}, {"size y", size.y()}, {"size z", size.z()}});
    if (!origin.allFinite()) throw std::invalid_argument("origin must be finite");
    const Vec3 end = origin + size;
    std::array<int, 3> n = grid_divisions(divisions, element);
    std::array<std::vector<double>, 3> lines; // empty: equal parts
    if (focus.size != 0)
        for (int d = 0; d < 3; ++d) {
            if (!focus.axes[static_cast<std::size_t>(d)]) continue;
            std::vector<double>& line = lines[static_cast<std::size_t>(d)];
            line = focused_lines(origin(d), end(d), focus.point(d), focus);
            if (!cell_info(element).edges.empty()) line = with_middles(line);
            n[static_cast<std::size_t>(d)] = static_cast<int>(line.size()) - 1;
        }
    const auto along = [&](std::size_t d, int step) {
        const auto i = static_cast<Index>(d);
        return lines[d].empty() ? divide(origin(i), end(i), step, n[d]) : lines[d][static_cast<std::size_t>(step)];
    };
    const auto rise = rise_of(crown, focus.point, origin, size);
    const auto position = [&](int i, int j, int k) -> Vec3 {
        const double x = along(0, i), y = along(1, j), z = along(2, k);
        return {x, y, k == n[2] ? z : z + rise(x, y) * (end.z() - z) / size.z()};
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
