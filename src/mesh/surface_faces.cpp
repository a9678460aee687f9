#include "osculate/mesh/surface_faces.hpp"

#include "osculate/core/error.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>

namespace osculate::mesh {
namespace {

constexpr std::size_t quarters_per_face = 4;

/// Which of CellInfo::facets of its element a facet is.
std::size_t quarter_of(const CellInfo& info, const Facet& facet, const Index* cell, Index first_node) {
    const auto locals = info.facets;
    for (std::size_t q = 0; q < locals.size(); ++q) {
        const auto matches = [&](int local) {
            return std::find(facet.begin(), facet.end(), cell[local] + first_node) != facet.end();
        };
        if (std::all_of(locals[q].nodes.begin(), locals[q].nodes.begin() + locals[q].count, matches)) return q;
    }
    throw InternalError("a facet has nodes that no face of its element has");
}

/// Local node numbers of a six-node face: corners, then the nodes midway on the edges 01, 12 and 20.
std::array<int, 6> six_node_face(const CellInfo& info, std::size_t face) {
    // its corners are those of its first three quarters, its middle nodes the corners of the last
    const auto quarters = info.facets.subspan(quarters_per_face * face, quarters_per_face);
    return {quarters[0].nodes[0], quarters[1].nodes[1], quarters[2].nodes[2],
            quarters[3].nodes[0], quarters[3].nodes[1], quarters[3].nodes[2]};
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
        const ElementBlock* block = facet.block < 0 ? nullptr : &mesh.blocks[static_cast<std::size_t>(facet.block)];
        if (block == nullptr || cell_info(block->type).edges.empty()) {
            faces.push_back(plane_face(facet));
            continue;
        }
        const CellInfo& info = cell_info(block->type);
        const Index* cell = block->connectivity.data() + static_cast<std::ptrdiff_t>(facet.element) * info.nodes;
        const std::size_t quarter = quarter_of(info, facet, cell, first_node), local = quarter / quarters_per_face;
        const auto [known, first] = begun.try_emplace({facet.block, facet.element, local}, faces.size());
        if (first) {
            SurfaceFace& face = faces.emplace_back();
            const auto corner = six_node_face(info, local);
            face.count = 6;
            for (std::size_t i = 0; i < corner.size(); ++i) face.nodes[i] = cell[corner[i]] + first_node;
            face.quarters.fill(false);
        }
        faces[known->second].quarters[quarter % quarters_per_face] = true;
    }
    return faces;
}

} // namespace osculate::mesh
