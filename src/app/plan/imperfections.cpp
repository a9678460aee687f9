/// Nodes that are moved before a run.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"
#include "osculate/mesh/cell_type.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace osculate::app {

namespace {

/// Least part of an imperfection that nodes must keep. Those that follow a curved master are placed along its facets.
constexpr double kept = 0.9;

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

void check_imperfect_sets(Draft& draft, const Draft& plain) {
    const model::Model& m = draft.plan.model;
    Field asked(m.X.size());
    for (const auto& [name, by] : draft.scene.imperfections)
        for (const Index node : draft.set(name).nodes) asked[node] += by;
    for (const auto& [name, by] : draft.scene.imperfections) {
        if (by.isZero(0)) continue;
        const auto part = [&](Index node) { // of what was asked for
            const Vec3& all = asked[static_cast<std::size_t>(node)];
            const Vec3 is = m.X[static_cast<std::size_t>(node)] - plain.plan.model.X[static_cast<std::size_t>(node)];
            return all.isZero(0) ? 1 : is.dot(all) / all.squaredNorm();
        };
        const std::vector<Index>& nodes = draft.set(name).nodes;
        const auto lost = std::ranges::count_if(nodes, [&](Index node) { return !(part(node) >= kept); });
        if (lost == 0) continue;
        const Index least = *std::ranges::min_element(nodes, {}, part);
        const Vec3 X = m.X[static_cast<std::size_t>(least)] + m.origin;
        draft.faults.push_back(fault(
            "imperfections." + name, "nodes that no tie, sector or `adjust` puts back: move those of the master, too",
            fmt::format("{} that {}, one at [{:.6g}, {:.6g}, {:.6g}] m by all but {:.3g} of it", lost,
                        lost == 1 ? "is" : "are", X[0], X[1], X[2], part(least))));
    }
}

} // namespace osculate::app
