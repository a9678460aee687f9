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
        const auto& [name, body] = scene.bodies[b];
        if (refined(body) == nullptr) continue;
        const std::string key = "bodies." + name + ".mesh.cad.contact.size";
        bool meets = false;
        for (const model::Set& set : draft.plan.model.sets) {
            if (set.body != static_cast<Index>(b) || !in_contact.contains(set.name)) continue;
            meets = true;
            if (set.facets.empty())
                faults.push_back(
                    fault(key, "elements of 'size' that are small enough to show facets of set '" + set.name + "'",
                          "a mesh without any"));
            for (const mesh::Facet& facet : set.facets) {
                const int corners = facet.count == 3 || facet.count == 6 ? 3 : 4;
                const auto corner = [&](int c) {
                    return unplaced(body.mesh.placement, draft.plan.model.X[facet.nodes[static_cast<std::size_t>(c)]] +
                                                             draft.plan.model.origin);
                };
                for (int c = 1; c + 1 < corners; ++c) triangles[b].push_back({corner(0), corner(c), corner(c + 1)});
            }
        }
        if (!meets)
            faults.push_back(
                fault(key, "a contact pair with a set of the body; elsewhere 'focus' makes small elements", "none"));
    }
    for (std::size_t a = 0; a < triangles.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
            const scene::CadMesh *first = refined(scene.bodies[a].second), *second = refined(scene.bodies[b].second);
            if (first == nullptr || second == nullptr || !alike(*first, *second)) continue;
            const std::size_t own = triangles[a].size();
            triangles[a].insert(triangles[a].end(), triangles[b].begin(), triangles[b].end());
            triangles[b].insert(triangles[b].end(), triangles[a].begin(),
                                triangles[a].begin() + static_cast<std::ptrdiff_t>(own));
        }
    return triangles;
}

} // namespace osculate::app
