#include "output/set_areas.hpp"

#include "osculate/fe/facet_quadrature.hpp"

#include <map>

namespace osculate::output {

std::vector<double> areas_of(const model::Model& model, const model::Set& set) {
    const model::Body& body = model.bodies[static_cast<std::size_t>(set.body)];
    std::map<Index, double> share;
    for (const mesh::SurfaceFace& face : mesh::surface_faces(body.mesh, set.facets, body.first_node)) {
        const auto own = fe::tributary_areas(face, model.X);
        for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i) share[face.nodes[i]] += own[i];
    }
    std::vector<double> areas;
    for (const Index node : set.nodes) {
        const auto at = share.find(node);
        areas.push_back(at == share.end() ? 0 : at->second);
    }
    return areas;
}

} // namespace osculate::output
