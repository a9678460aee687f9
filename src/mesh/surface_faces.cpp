#include "osculate/mesh/surface_faces.hpp"

#include "osculate/core/error.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>

namespace osculate::mesh {
namespace {

/// A piece of a face of an element.
struct Piece {
    std::size_t face, number; ///< place in CellInfo::faces and in FaceShape::pieces
};

/// Which piece of which face of its element a facet is.
Piece piece_of(const CellInfo& info, const Facet& facet, const Index* cell, Index first_node) {
    const auto on_facet = [&](int local) {
        return std::find(facet.begin(), facet.end(), cell[local] + first_node) != facet.end();
    };
    std::size_t all = 0; // pieces of the faces before
    for (std::size_t f = 0; f < info.faces.size(); ++f) {
        const std::size_t pieces = face_shape(info.face_nodes(info.faces[f]).count).pieces.size();
        for (std::size_t p = 0; p < pieces; ++p)
            if (const LocalFace& local = info.facets[all + p];
                std::all_of(local.nodes.begin(), local.nodes.begin() + local.count, on_facet))
                return {f, p};
        all += pieces;
    }
    throw InternalError("a facet has nodes that no face of its element has");
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
    std::map<std::tuple<Index, Index, std::size_t>, std::size_t> begun; // by block, element and local face
    for (const Facet& facet : facets) {
        const ElementBlock* block = facet.block < 0 ? nullptr : &mesh.blocks[static_cast<std::size_t>(facet.block)];
        if (block == nullptr || cell_info(block->type).edges.empty()) {
            faces.push_back(plane_face(facet));
            continue;
        }
        const CellInfo& info = cell_info(block->type);
        const Index* cell = block->connectivity.data() + static_cast<std::ptrdiff_t>(facet.element) * info.nodes;
        const Piece piece = piece_of(info, facet, cell, first_node);
        const auto [known, first] = begun.try_emplace({facet.block, facet.element, piece.face}, faces.size());
        if (first) {
            SurfaceFace& face = faces.emplace_back();
            const CellInfo::FaceNodes local = info.face_nodes(info.faces[piece.face]);
            face.count = local.count;
            for (int i = 0; i < local.count; ++i) face.nodes[i] = cell[local.nodes[i]] + first_node;
            face.pieces.fill(false);
        }
        faces[known->second].pieces[piece.number] = true;
    }
    return faces;
}

} // namespace osculate::mesh
