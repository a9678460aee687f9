#include "output/locate_point.hpp"

#include "osculate/core/without_traps.hpp"
#include "output/elements.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <limits>
#include <optional>

namespace osculate::output {

namespace {

constexpr double at_the_edge = 1e-9; ///< natural coordinates

/// Of an element type, behind one interface: this is not where time goes, and compiling all of it for every type is.
struct ShapeFunctions {
    Vec3 middle;
    Vector (*N)(const Vec3& xi);
    Eigen::MatrixX3d (*dN)(const Vec3& xi);
    bool (*contains)(const Vec3& xi, double tolerance);
};

ShapeFunctions shape_functions(mesh::CellType type) {
    return fe::with_element(type, []<class E>() {
        return ShapeFunctions{E::node_positions().rowwise().mean(),
                              [](const Vec3& xi) -> Vector { return E::shape(xi); },
                              [](const Vec3& xi) -> Eigen::MatrixX3d { return E::gradient(xi); }, &E::contains};
    });
}

/// Natural coordinates of X by Newton's method from the element's middle; none where they lie outside.
std::optional<Vec3> natural_coordinates(const ShapeFunctions& element, const Eigen::Matrix3Xd& nodes, const Vec3& X) {
    constexpr int most_iterations = 30;
    constexpr double far = 4; // of the middle: outside
    Vec3 xi = element.middle;
    const WithoutTraps strange_elements;
    for (int k = 0; k < most_iterations; ++k) {
        const Vec3 miss = X - nodes * element.N(xi);
        const Mat3 J = nodes * element.dN(xi);
        const Vec3 step = J.partialPivLu().solve(miss);
        if (!step.allFinite() || (xi + step - element.middle).norm() > far) return {};
        xi += step;
        if (step.norm() < 1e-14) break;
    }
    return element.contains(xi, at_the_edge) ? std::optional(xi) : std::nullopt;
}

} // namespace

LocatedPoint locate_point(const model::Body& body, const Vec3& X) {
    LocatedPoint found;
    found.distance = std::numeric_limits<double>::infinity();
    for_each_element(body, [&](const ElementOf& element) {
        if (!found.place.points.empty()) return;
        const std::vector<Index> nodes = nodes_of(body, element);
        const Eigen::Matrix3Xd positions = positions_of(body, nodes);
        Eigen::AlignedBox3d box(positions.rowwise().minCoeff(), positions.rowwise().maxCoeff());
        found.distance = std::min(found.distance, box.exteriorDistance(X));
        const Vec3 air = Vec3::Constant(at_the_edge * box.diagonal().norm());
        box = Eigen::AlignedBox3d(box.min() - air, box.max() + air);
        if (!box.contains(X)) return;
        const ShapeFunctions functions =
            shape_functions(body.mesh.blocks[static_cast<std::size_t>(element.block)].type);
        if (const auto xi = natural_coordinates(functions, positions, X)) found.place = {nodes, functions.N(*xi)};
    });
    return found;
}

} // namespace osculate::output
