/// Nodes that are moved before a run.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"

namespace osculate::app {

void move_imperfect_sets(Draft& draft) {
    model::Model& m = draft.plan.model;
    std::map<Index, std::string> moved; // bodies, and the last set that moved them
    for (const auto& [name, by] : draft.scene.imperfections) {
        if (by.isZero(0)) continue;
        const model::Set& set = draft.set(name);
        model::Body& body = m.bodies[static_cast<std::size_t>(set.body)];
        for (const Index node : set.nodes) {
            m.X[static_cast<std::size_t>(node)] += by;
            body.mesh.nodes[static_cast<std::size_t>(node - body.first_node)] += by;
        }
        moved[set.body] = name;
    }
    for (const auto& [number, name] : moved)
        for (const std::string& what : mesh_faults(m.bodies[static_cast<std::size_t>(number)].mesh, m.origin))
            draft.faults.push_back(fault("imperfections." + name, "smaller ones: elements fold", what));
}

} // namespace osculate::app
