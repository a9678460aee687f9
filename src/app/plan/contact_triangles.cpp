#include "app/plan/contact_triangles.hpp"

#include "app/plan/draft.hpp"

#include <Eigen/Geometry>
#include <set>

namespace osculate::app {

namespace {

using Triangles = std::vector<std::array<Vec3, 3>>;

const scene::CadMesh* refined(const scene::Body& body) {
    const auto* cad = std::get_if<scene::CadMesh>(&body.mesh.source);
    return cad != nullptr && cad->contact.size > 0 ? cad : nullptr;
}

std::set<std::string> sets_in_contact(const scene::Scene& scene) {
    std::set<std::string> names;
    for (const auto& [name, pair] : scene.contact)
        names.insert({pair.slave, pair.master.set, pair.between[0], pair.between[1]});
    return names;
}

/// Where a point of a placed body was before. See mesh::place().
Vec3 unplaced(const scene::Placement& p, const Vec3& x) {
    const Vec3 X = (x - p.translation) / p.scale;
    return p.angle == 0 ? X : Vec3(Eigen::AngleAxisd(-p.angle, p.axis.normalized()) * X);
}

/// Whether two bodies are parts of one mesh.
bool alike(scene::CadMesh a, const scene::CadMesh& b) {
    a.part = b.part;
    a.piece = b.piece;
    return a == b;
}

} // namespace

std::vector<Triangles> contact_triangles(const scene::Scene& scene, const std::vector<mesh::Mesh>& coarse,
                                         std::vector<Fault>& faults) {
    std::vector<Triangles> triangles(scene.bodies.size());
    if (std::ranges::none_of(scene.bodies, [](const auto& body) { return refined(body.second) != nullptr; }))
        return triangles;
    Timings timings;
    Draft draft{scene, 1, timings};
    add_bodies(draft, coarse);
    if (draft.faults.empty()) add_sets(draft);
    if (!draft.faults.empty()) return triangles; // compile() meets them again, and names them
    const std::set<std::string> in_contact = sets_in_contact(scene);
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const scene::CadMesh* cad = refined(scene.bodies[b].second);
        if (cad == nullptr) continue;
        const std::string key = "bodies." + scene.bodies[b].first + ".mesh.cad.contact.size";
        bool meets = false;
        for (const model::Set& set :
             draft.plan.model.sets) { // of all parts of the geometry, in one order: it is meshed once
            const scene::Body& body = scene.bodies[static_cast<std::size_t>(set.body)].second;
            const scene::CadMesh* other = refined(body);
            if (other == nullptr || !alike(*cad, *other) || !in_contact.contains(set.name)) continue;
            meets = true;
            if (set.facets.empty())
                faults.push_back(
                    fault(key, "elements of 'size' that are small enough to show facets of set '" + set.name + "'",
                          "a mesh without any"));
            for (const mesh::Facet& facet : set.facets) { // of tetrahedra: the first three nodes are corners
                std::array<Vec3, 3>& corners = triangles[b].emplace_back();
                for (std::size_t c = 0; c < 3; ++c)
                    corners[c] =
                        unplaced(body.mesh.placement, draft.plan.model.X[facet.nodes[c]] + draft.plan.model.origin);
            }
        }
        if (!meets)
            faults.push_back(
                fault(key, "a contact pair with a set of the body; elsewhere 'focus' makes small elements", "none"));
    }
    return triangles;
}

} // namespace osculate::app
