#include "osculate/mesh/surface_faces.hpp"

#include "mesh/cell_faces.hpp"
#include "osculate/core/error.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>

namespace osculate::mesh {
namespace {

constexpr std::size_t quarters_per_face = 4;

/// Which of the quarters of its element's faces a facet is, in the order of cell_faces.
std::size_t quarter_of(const Facet& facet, const Index* cell, Index first_node) {
    const auto locals = cell_faces(CellType::tet10);
    for (std::size_t q = 0; q < locals.size(); ++q) {
        const auto matches = [&](int local) {
            return std::find(facet.begin(), facet.end(), cell[local] + first_node) != facet.end();
        };
        if (std::all_of(locals[q].nodes.begin(), locals[q].nodes.begin() + locals[q].count, matches)) return q;
    }
    throw InternalError("a facet of a ten-node tetrahedron has nodes that none of its faces has");
}

} // namespace

SurfaceFace plane_face(const Facet& facet) {
    SurfaceFace face;
    face.count = facet.count;
    std::copy(facet.begin(), facet.end(), face.nodes.begin());
    return face;
}

std::vector<SurfaceFace> surface_faces(const Mesh& mesh, const std::vector<Facet>& facets, Index first_node) {
    std::vector<SurfaceFace> faces;
    faces.reserve(facets.size());
    std::map<std::tuple<Index, Index, std::size_t>, std::size_t>
        begun; // six-node faces by block, element and local face
    for (const Facet& facet : facets) {
        if (facet.block < 0 || mesh.blocks[static_cast<std::size_t>(facet.block)].type != CellType::tet10) {
            faces.push_back(plane_face(facet));
            continue;
        }
        const Index* cell = mesh.blocks[static_cast<std::size_t>(facet.block)].connectivity.data() +
                            static_cast<std::ptrdiff_t>(facet.element) * nodes_per_cell(CellType::tet10);
        const std::size_t quarter = quarter_of(facet, cell, first_node), local = quarter / quarters_per_face;
        const auto [known, first] = begun.try_emplace({facet.block, facet.element, local}, faces.size());
        if (first) {
            SurfaceFace& face = faces.emplace_back();
            const auto corner = six_node_face(local);
            face.count = 6;
            for (std::size_t i = 0; i < corner.size(); ++i) face.nodes[i] = cell[corner[i]] + first_node;
            face.quarters.fill(false);
        }
        faces[known->second].quarters[quarter % quarters_per_face] = true;
    }
    return faces;
}

} // namespace osculate::mesh
