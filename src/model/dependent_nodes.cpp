/// Nodes whose motion follows from that of others.

#include "osculate/model/model.hpp"

#include <algorithm>
#include <numeric>

namespace osculate::model {

std::vector<Index> dependent_nodes(const Model& model) {
    std::vector<Index> nodes;
    for (const RigidBody& body : model.rigid) nodes.insert(nodes.end(), body.nodes.begin(), body.nodes.end());
    for (const Tie& tie : model.ties)
        for (const TiedNode& tied : tie.nodes) nodes.push_back(tied.node);
    for (const CyclicSymmetry& ring : model.cyclic)
        for (const LikeNode& one : ring.nodes) nodes.push_back(one.node);
    for (const SkinNode& one : model.skin) nodes.push_back(one.node);
    return nodes;
}

std::vector<std::pair<Index, Index>> followed_nodes(const Model& model) {
    std::vector<std::pair<Index, Index>> pairs;
    for (const RigidBody& body : model.rigid) {
        for (const Index node : body.nodes) pairs.emplace_back(node, body.reference);
        pairs.emplace_back(body.rotation(), body.reference);
    }
    for (const Tie& tie : model.ties)
        for (const TiedNode& tied : tie.nodes)
            for (const auto& [node, weight] : tied.carriers) pairs.emplace_back(tied.node, node);
    for (const CyclicSymmetry& ring : model.cyclic)
        for (const LikeNode& one : ring.nodes) pairs.emplace_back(one.node, one.like);
    for (const LedNode& one : model.led)
        for (const auto& [node, by] : one.by) pairs.emplace_back(one.node, node);
    for (const SkinNode& one : model.skin) {
        pairs.emplace_back(one.node, one.host);
        for (const auto& [node, weight] : one.carriers) pairs.emplace_back(one.node, node);
    }
    std::ranges::sort(pairs);
    return pairs;
}

std::vector<Index> tied_groups(const Model& model) {
    std::vector<Index> group(model.bodies.size());
    std::iota(group.begin(), group.end(), Index{0});
    for (const Tie& tie : model.ties) {
        const Index from = group[static_cast<std::size_t>(tie.slave_body)],
                    to = group[static_cast<std::size_t>(tie.master_body)];
        std::ranges::replace(group, from, to);
    }
    return group;
}

std::vector<linear::LedDirection> led_directions(const Model& model) {
    std::vector<linear::LedDirection> led;
    for (const LedNode& one : model.led) led.push_back({one.node, one.direction});
    return led;
}

void move_tied(const Model& model, Field& u) {
    for (const LedNode& one : model.led) { // in any order: they lead none that lead
        double value = 0;
        for (const auto& [node, by] : one.by) value += by.dot(u[static_cast<std::size_t>(node)]);
        Vec3& own = u[static_cast<std::size_t>(one.node)];
        own += (value - one.direction.dot(own)) * one.direction;
    }
    for (const CyclicSymmetry& ring : model.cyclic)
        for (const LikeNode& one : ring.nodes) {
            Vec3& own = u[static_cast<std::size_t>(one.node)];
            own += one.free * (ring.turn * u[static_cast<std::size_t>(one.like)] - own);
        }
    for (const Tie& tie : model.ties)
        for (const TiedNode& tied : tie.nodes) {
            Vec3 sum = Vec3::Zero();
            for (const auto& [node, weight] : tied.carriers) sum += weight * u[static_cast<std::size_t>(node)];
            u[static_cast<std::size_t>(tied.node)] = tied.free * sum;
        }
    for (const SkinNode& one : model.skin) {
        Vec3 sum = Vec3::Zero();
        for (const auto& [node, weight] : one.carriers) sum += weight * u[static_cast<std::size_t>(node)];
        const Vec3& host = u[static_cast<std::size_t>(one.host)];
        u[static_cast<std::size_t>(one.node)] = host + one.free * (sum - host);
    }
}

Index material_node(const Model& model, Index node) {
    if (model.skin.empty()) return node;
    const Index at = node - model.skin.front().node;
    return at < 0 || at >= static_cast<Index>(model.skin.size()) ? node : model.skin[static_cast<std::size_t>(at)].host;
}

} // namespace osculate::model
