#include "app/plan/flat_master.hpp"

#include <algorithm>
#include <limits>

namespace osculate::app {

namespace {

bool in_one_plane(const std::vector<Vec3>& x) {
    const Vec3& origin = x.front();
    double largest = 0; // coordinate
    for (const Vec3& p : x) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    const Vec3 along =
        *std::ranges::max_element(x, {}, [&](const Vec3& p) { return (p - origin).squaredNorm(); }) - origin;
    const Vec3 across = along.cross(*std::ranges::max_element(x, {}, [&](const Vec3& p) {
        return along.cross(p - origin).squaredNorm();
    }) - origin);
    if (!(across.norm() > 0)) return false;
    const Vec3 normal = across.normalized();
    constexpr double digits = 16; // last digits of a coordinate
    const double round_off = digits * std::numeric_limits<double>::epsilon() * largest;
    return std::ranges::all_of(x, [&](const Vec3& p) { return std::abs(normal.dot(p - origin)) <= round_off; });
}

/// Whether all of the nodes are held alike in every direction.
bool move_as_one(const linear::Constraints& constraints, const std::vector<Index>& nodes) {
    for (const Index node : nodes)
        for (int k = 0; k < 3; ++k) {
            const linear::NodeConstraint *first = constraints.constraint(nodes.front(), k),
                                         *own = constraints.constraint(node, k);
            if (own == nullptr || first == nullptr) return false;
            if (own->driven != first->driven || own->target != first->target || own->course != first->course)
                return false;
            if (own->driven && constraints.frame(node).col(k) != constraints.frame(nodes.front()).col(k)) return false;
        }
    return true;
}

} // namespace

bool stays_flat(const Plan& plan, const model::ContactPair& pair) {
    if (!in_one_plane(pair.vertices(plan.model.X))) return false;
    if (model::body_of(plan.model, pair.master_nodes().front())->rigid) return true;
    return std::ranges::all_of(plan.stages, [&](const time::Stage& stage) {
        return move_as_one(linear::Constraints(plan.model.nodes(), stage.constraints), pair.master_nodes());
    });
}

} // namespace osculate::app
