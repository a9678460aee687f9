/// Sets of a plan.

#include "app/fault.hpp"
#include "app/overloaded.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/rigid_surface.hpp"
#include "osculate/mesh/select.hpp"
#include "osculate/scene/nearest.hpp"

#include <fmt/format.h>
#include <set>

namespace osculate::app {

namespace {

/// A part that the mesh names; one fault when it does not.
mesh::Region select(Draft& draft, const std::string& set_name, const std::string& body, const scene::SelectNamed& s,
                    const mesh::Mesh& m, const std::vector<mesh::Facet>& exterior) {
    if (auto named = mesh::select_named(m, exterior, s.name)) return *named;
    std::vector<std::string> known;
    for (const auto& [surface, facets] : m.surfaces) known.push_back(surface);
    for (const auto& [nodes, list] : m.node_sets)
        if (!m.surfaces.contains(nodes)) known.push_back(nodes);
    std::string names;
    for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
    draft.faults.push_back(fault("sets." + set_name + (s.nodes ? ".nodes" : ".surface"),
                                 "a surface or node set of body '" + body + "' (it has " + names + ")",
                                 "'" + s.name + "'"));
    draft.faults.back().nearest = scene::nearest(s.name, known);
    return {};
}

/// The named surface nearest to a point; a fault where the mesh names none, or two are as near.
mesh::Region select(Draft& draft, const std::string& set_name, const std::string& body, const scene::SelectNearest& s,
                    const mesh::Mesh& m, const std::vector<mesh::Facet>& exterior) {
    const std::vector<std::string> nearest = mesh::nearest_surfaces(m, s.point - draft.plan.model.origin);
    if (nearest.size() == 1) return *mesh::select_named(m, exterior, nearest.front());
    draft.faults.push_back(
        fault("sets." + set_name + ".nearest",
              nearest.empty() ? "a body whose mesh names surfaces" : "a point away from edges of surfaces",
              nearest.empty() ? "body '" + body + "', whose mesh names none"
                              : fmt::format("one as near to {}", fmt::join(nearest, " and "))));
    return {};
}

/// Nodes by their numbers; one fault where any number is of none.
mesh::Region select(Draft& draft, const std::string& set_name, const std::string& body, const scene::SelectNumbers& s,
                    const mesh::Mesh& m, const std::vector<mesh::Facet>& exterior) {
    const std::set<std::int64_t> known(m.node_ids.begin(), m.node_ids.end());
    const auto missing = std::ranges::find_if(s.numbers, [&](int number) { return !known.contains(number); });
    if (missing != s.numbers.end())
        draft.faults.push_back(
            fault("sets." + set_name + ".node_numbers",
                  known.empty() ? "a body whose mesh is from a file" : "numbers of nodes of body '" + body + "'",
                  known.empty() ? "body '" + body + "'" : std::to_string(*missing)));
    return mesh::select_numbers(m, exterior, s.numbers);
}

/// The node nearest to a point; a fault where others are as near.
mesh::Region select(Draft& draft, const std::string& set_name, const scene::SelectNode& s, const mesh::Mesh& m) {
    const std::vector<Index> nearest = mesh::nearest_nodes(m, s.point - draft.plan.model.origin);
    if (nearest.size() > 1)
        draft.faults.push_back(fault("sets." + set_name + ".node", "a point that is nearer to one node than to others",
                                     fmt::format("{} nodes as near", nearest.size())));
    return {nearest, {}};
}

/// The whole surface of each body with an exact one.
void add_surface_sets(Draft& draft) {
    model::Model& m = draft.plan.model;
    for (const model::RigidBody& rigid : m.rigid) {
        if (!rigid.shape) continue;
        m.sets.push_back({surface_set(rigid.name), rigid.body, rigid.nodes,
                          model::exterior_facets(m.bodies[static_cast<std::size_t>(rigid.body)])});
    }
}
} // namespace

void add_sets(Draft& draft) {
    for (const auto& [name, spec] : draft.scene.sets) {
        const Index b = draft.body_index(spec.body);
        const mesh::Mesh& m = draft.plan.model.bodies[b].mesh;
        const auto& exterior = draft.plan.model.bodies[b].exterior;
        const std::size_t before = draft.faults.size();
        const Vec3& o = draft.plan.model.origin;
        const mesh::Region region = std::visit(
            Overloaded{
                [&, &name = name, &spec = spec](const scene::SelectNamed& s) {
                    return select(draft, name, spec.body, s, m, exterior);
                },
                [&, &name = name, &spec = spec](const scene::SelectNearest& s) {
                    return select(draft, name, spec.body, s, m, exterior);
                },
                [&](const scene::SelectPlane& s) { return mesh::select_plane(m, exterior, s.point - o, s.normal); },
                [&](const scene::SelectCylinder& s) {
                    return mesh::select_cylinder(m, exterior, s.point - o, s.axis, s.radius);
                },
                [&](const scene::SelectBox& s) { return mesh::select_box(m, exterior, s.min - o, s.max - o); },
                [&, &name = name, &spec = spec](const scene::SelectNumbers& s) {
                    return select(draft, name, spec.body, s, m, exterior);
                },
                [&, &name = name](const scene::SelectNode& s) { return select(draft, name, s, m); },
                [&](const scene::SelectNormal& s) { return mesh::select_normal(m, exterior, s.direction, s.angle); },
            },
            spec.select);
        if (region.nodes.empty() && draft.faults.size() == before)
            draft.faults.push_back(fault("sets." + name, "at least one node of body '" + spec.body + "'",
                                         "an empty set: nothing lies there"));
        model::Set global{name, b, region.nodes, region.facets};
        const Index shift = draft.plan.model.bodies[b].first_node;
        for (Index& node : global.nodes) node += shift;
        for (mesh::Facet& facet : global.facets)
            for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] += shift;
        draft.plan.model.sets.push_back(std::move(global));
    }
    add_surface_sets(draft);
}

} // namespace osculate::app
