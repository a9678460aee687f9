/// Slave nodes that are moved onto the master before a run.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/rigid_surface.hpp"
#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/mesh/quality.hpp"

#include <fmt/format.h>

namespace osculate::app {

namespace {

/// Places on the master of the nodes that are near enough.
std::vector<std::pair<Index, Vec3>> places(const model::Model& m, const model::Set& slave, const model::Set& master,
                                           double distance) {
    const mesh::HalfEdgeSurface surface(master.facets, m.X.values());
    std::vector<Vec3> vertices;
    for (const Index node : surface.vertex_nodes()) vertices.push_back(m.X[static_cast<std::size_t>(node)]);
    contact::FacetSearch search(surface);
    search.build(vertices);
    const std::unique_ptr<contact::MasterSurface> facets = contact::make_facets_surface(surface);
    std::vector<std::pair<Index, Vec3>> found;
    for (const Index node : mesh::nodes_of(slave.facets)) {
        const contact::FacetHit hit = search.global(m.X[static_cast<std::size_t>(node)], vertices);
        if (hit.facet < 0 || hit.overhang > 0 || hit.distance > distance) continue;
        contact::ContactPoint point;
        facets->evaluate(m.X[static_cast<std::size_t>(node)], hit, vertices, point, nullptr);
        if (point.found) found.emplace_back(node, point.foot);
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
        for (const auto& [node, X] : places(m, slave, master, *pair.adjust))
            m.X[static_cast<std::size_t>(node)] = body.mesh.nodes[static_cast<std::size_t>(node - body.first_node)] = X;
        for (const std::string& what : mesh::faults(body.mesh))
            draft.faults.push_back(
                fault(key, "a smaller one: elements fold where nodes are moved onto the master", what));
    }
}

} // namespace osculate::app
