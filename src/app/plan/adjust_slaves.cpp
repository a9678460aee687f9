/// Slave nodes that are moved onto the master before a run.

#include "app/fault.hpp"
#include "app/plan/contact_pairs.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/gaps.hpp"
#include "app/plan/loose_slaves.hpp"
#include "app/plan/rigid_surface.hpp"

#include <cmath>
#include <stdexcept>

namespace osculate::app {

namespace {

/// Places on the master, as contact sees it, of the nodes that are near enough.
std::vector<std::pair<Index, Vec3>> places(Draft& draft, const std::string& name, scene::Pair spec,
                                           const model::Set& slave, const model::Set& master) {
    spec.discretisation = Discretisation::node; // distances of nodes, no averages
    const auto pair = make_contact_pair(draft.scene, name, spec, draft.plan.model, slave, master,
                                        loose_slaves(draft, spec.slave), nullptr);
    model::ContactEvaluation evaluation(*pair);
    (void)initial_gaps(evaluation, draft.plan.model.X, draft.timings, draft.threads);
    std::vector<std::pair<Index, Vec3>> found;
    for (Index j = 0; j < pair->size(); ++j) {
        const contact::ContactPoint& point = evaluation.point(j);
        if (point.found && std::abs(point.gap) <= *spec.adjust)
            found.emplace_back(pair->slaves().node[static_cast<std::size_t>(j)], point.foot);
    }
    return found;
}

} // namespace

void adjust_slaves(Draft& draft) {
    model::Model& m = draft.plan.model;
    for (const auto& [name, pair] : draft.plan.contact) {
        if (!pair.adjust) continue;
        const std::string key = "contact." + name + ".adjust";
        const model::Set &slave = draft.set(pair.slave), &master = draft.set(master_set(pair.master));
        if (slave.facets.empty() || master.facets.empty()) continue; // found wanting by add_pairs
        model::Body& body = m.bodies[static_cast<std::size_t>(slave.body)];
        if (body.rigid) {
            draft.faults.push_back(fault(key, "a slave that deforms", "rigid body '" + body.name + "'"));
            continue;
        }
        if (draft.scene.bodies[static_cast<std::size_t>(slave.body)].second.slice) {
            draft.faults.push_back(fault(key, "a slave that is no slice: nodes above one another must stay so",
                                         "a surface of slice '" + body.name + "'"));
            continue;
        }
        std::vector<std::pair<Index, Vec3>> found;
        try {
            found = places(draft, name, pair, slave, master);
        } catch (const std::runtime_error&) { // of the master's surface: add_pairs tells of it
            continue;
        }
        for (const auto& [node, X] : found)
            m.X[static_cast<std::size_t>(node)] = body.mesh.nodes[static_cast<std::size_t>(node - body.first_node)] = X;
        for (const std::string& what : mesh_faults(body.mesh, m.origin))
            draft.faults.push_back(
                fault(key, "a smaller one: elements fold where nodes are moved onto the master", what));
    }
}

} // namespace osculate::app
