/// Nodes that are moved before a run.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"
#include "osculate/mesh/cell_type.hpp"

#include <fmt/format.h>

namespace osculate::app {

namespace {

/// How far a node may be placed elsewhere, of its imperfection: round-off in the places that ties compute stays below.
constexpr double kept = 0.01;

/// Midside nodes that no set moves stay in the middle of their edges. @param own  (nodes) sets say where they go
void take_midside_nodes_along(const model::Body& body, const std::vector<char>& own, Field& moved) {
    for (const mesh::ElementBlock& block : body.mesh.blocks) {
        const mesh::CellInfo& info = mesh::cell_info(block.type);
        for (std::size_t first = 0; first < block.connectivity.size(); first += static_cast<std::size_t>(info.nodes)) {
            const auto node = [&](int local) {
                return static_cast<std::size_t>(body.first_node +
                                                block.connectivity[first + static_cast<std::size_t>(local)]);
            };
            for (std::size_t e = 0; e < info.edges.size(); ++e)
                if (const std::size_t midside = node(info.corners() + static_cast<int>(e)); own[midside] == 0)
                    moved[midside] = 0.5 * (moved[node(info.edges[e][0])] + moved[node(info.edges[e][1])]);
        }
    }
}

} // namespace

void move_imperfect_sets(Draft& draft) {
    if (draft.scene.imperfections.empty()) return;
    model::Model& m = draft.plan.model;
    Field moved(m.X.size());
    std::vector<char> own(m.X.size(), 0);
    std::map<Index, std::string> last; // set that moved a body
    for (const auto& [name, by] : draft.scene.imperfections) {
        const model::Set& set = draft.set(name);
        for (const Index node : set.nodes) {
            moved[node] += by;
            own[static_cast<std::size_t>(node)] = 1;
        }
        last[set.body] = name;
    }
    for (const auto& [name, by] : draft.scene.imperfections)
        for (const Index node : draft.set(name).nodes)
            if (moved[node].norm() > 0)
                draft.imperfect.push_back(
                    {node, m.X[static_cast<std::size_t>(node)] + moved[node], moved[node].norm(), name});
    for (const auto& [number, name] : last) {
        model::Body& body = m.bodies[static_cast<std::size_t>(number)];
        take_midside_nodes_along(body, own, moved);
        for (std::size_t i = 0; i < body.mesh.nodes.size(); ++i) {
            const Vec3& by = moved[body.first_node + static_cast<Index>(i)];
            m.X[body.first_node + static_cast<Index>(i)] += by;
            body.mesh.nodes[i] += by;
        }
        for (const std::string& what : mesh_faults(body.mesh, m.origin))
            draft.faults.push_back(fault("imperfections." + name, "smaller ones: elements fold", what));
    }
}

void check_imperfect_sets(Draft& draft) {
    const model::Model& m = draft.plan.model;
    std::map<std::string, std::pair<Index, MovedNode>> elsewhere; // by set: how many, and the farthest
    const auto off = [&](const MovedNode& moved) {
        return (m.X[static_cast<std::size_t>(moved.node)] - moved.X).norm();
    };
    for (const MovedNode& moved : draft.imperfect) {
        if (!(off(moved) > kept * moved.by)) continue;
        auto& [count, farthest] = elsewhere.try_emplace(moved.set, 0, moved).first->second;
        ++count;
        if (off(moved) > off(farthest)) farthest = moved;
    }
    for (const auto& [set, found] : elsewhere) {
        const auto& [count, farthest] = found;
        const Vec3 X = farthest.X + m.origin;
        draft.faults.push_back(
            fault("imperfections." + set,
                  "nodes that no tie, sector or `adjust` places: move the master's, whose nodes take these along",
                  fmt::format("{}, placed elsewhere by these: up to {:.3g} m from [{:.6g}, {:.6g}, {:.6g}] m",
                              count == 1 ? "one" : std::to_string(count), off(farthest), X[0], X[1], X[2])));
    }
}

} // namespace osculate::app
