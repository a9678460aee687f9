#include "osculate/model/nodal_unknowns.hpp"

#include "osculate/model/general_contact.hpp"
#include "osculate/model/rigid_motion.hpp"

#include <algorithm>

namespace osculate::model {

namespace {
/// Of the bodies of a group, which move without strain together.
Extent extent(const Model& model, const std::vector<Index>& group, Index number) {
    Extent all;
    double nodes = 0;
    for (std::size_t b = 0; b < group.size(); ++b) {
        if (group[b] != number) continue;
        const double own = model.bodies[b].nodes();
        all.centre += own * extent(model.bodies[b], model.X).centre;
        nodes += own;
    }
    all.centre /= nodes;
    for (std::size_t b = 0; b < group.size(); ++b) {
        if (group[b] != number) continue;
        const Body& body = model.bodies[b];
        for (Index node = body.first_node; node < body.first_node + body.nodes(); ++node)
            all.radius = std::max(all.radius, (model.X[node] - all.centre).norm());
    }
    return all;
}
} // namespace

solve::NodalUnknowns nodal_unknowns(const Model& model, const linear::Constraints& constraints) {
    solve::NodalUnknowns result;
    const auto equation = [&](Index node, int k) {
        const Index e = constraints.equation(node, k);
        return e == linear::Constraints::held ? -1 : e;
    };
    const std::vector<Index> group = joined_groups(model);
    std::size_t free = 0;
    for (Index node = 0; node < model.nodes(); ++node) free += constraints.free_components(node) > 0 ? 1 : 0;
    for (auto* list : {&result.node, &result.body, &result.frame_number}) list->reserve(free);
    result.arm.reserve(free);
    result.equation.reserve(3 * free);
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const Body& body = model.bodies[b];
        const Index last = body.first_node + body.nodes();
        const auto [centre, radius] = extent(model, group, group[b]);
        for (Index node = body.first_node; node < last; ++node) {
            if (constraints.free_components(node) == 0) continue;
            result.node.push_back(node);
            result.body.push_back(group[b]);
            const Mat3& frame = constraints.frame(node);
            if (frame != result.frames.back() && !frame.isIdentity(0)) result.frames.push_back(frame);
            result.frame_number.push_back(frame.isIdentity(0) ? 0 : static_cast<Index>(result.frames.size()) - 1);
            result.arm.push_back((model.X[node] - centre) / radius);
            for (int k = 0; k < 3; ++k) result.equation.push_back(equation(node, k));
        }
    }
    for (const RigidBody& rigid : model.rigid)
        for (const Index node : {rigid.reference, rigid.rotation()})
            if (constraints.free_components(node) > 0)
                result.hubs.push_back(
                    {node, {equation(node, 0), equation(node, 1), equation(node, 2)}, constraints.frame(node)});
    std::ranges::sort(result.hubs, {}, &solve::NodalUnknowns::Hub::node);
    if (!model.share) return result;
    result.owner.reserve(result.node.size());
    for (const Index node : result.node) result.owner.push_back(model.share->owner()[static_cast<std::size_t>(node)]);
    for (const auto& pair : model.pairs) {
        result.coupled.insert(result.coupled.end(), pair->slaves().node.begin(), pair->slaves().node.end());
        result.coupled.insert(result.coupled.end(), pair->master_nodes().begin(), pair->master_nodes().end());
    }
    if (model.general)
        for (const OuterSurface& surface : model.general->surfaces())
            for (const mesh::Facet& facet : surface.facets)
                result.coupled.insert(result.coupled.end(), facet.begin(), facet.end());
    const auto followed = followed_nodes(model);
    for (std::size_t k = 0; k < result.coupled.size() && !followed.empty(); ++k) // and those of these
        for (const auto& [node, other] :
             std::ranges::equal_range(followed, result.coupled[k], {}, &std::pair<Index, Index>::first))
            result.coupled.push_back(other);
    std::ranges::sort(result.coupled);
    result.coupled.erase(std::unique(result.coupled.begin(), result.coupled.end()), result.coupled.end());
    return result;
}

} // namespace osculate::model
