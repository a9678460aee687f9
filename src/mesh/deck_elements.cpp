#include "mesh/deck_elements.hpp"

#include "mesh/face_cells.hpp"
#include "osculate/mesh/deck_mesh.hpp"

#include <span>

namespace osculate::mesh {
namespace {

// A wedge of a deck has its first triangle facing inward, ours outward.
constexpr DeckElementType element_types[] = {
    {"C3D8", CellType::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},         {"C3D8R", CellType::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},
    {"C3D8I", CellType::hex8, {0, 1, 2, 3, 4, 5, 6, 7}},        {"C3D4", CellType::tet4, {0, 1, 2, 3}},
    {"C3D10", CellType::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}, {"C3D6", CellType::wedge6, {0, 2, 1, 3, 5, 4}},
};

// Faces S1 to S6 by local nodes of ours.
constexpr CornerFace hex_faces[] = {{{0, 1, 2, 3}, 4}, {{4, 7, 6, 5}, 4}, {{0, 4, 5, 1}, 4},
                                    {{1, 5, 6, 2}, 4}, {{2, 6, 7, 3}, 4}, {{3, 7, 4, 0}, 4}};
constexpr CornerFace wedge_faces[] = {
    {{0, 1, 2, -1}, 3}, {{3, 4, 5, -1}, 3}, {{0, 2, 5, 3}, 4}, {{2, 1, 4, 5}, 4}, {{1, 0, 3, 4}, 4}};
constexpr CornerFace tet_faces[] = {{{0, 1, 2, -1}, 3}, {{0, 3, 1, -1}, 3}, {{1, 3, 2, -1}, 3}, {{2, 3, 0, -1}, 3}};

std::span<const CornerFace> deck_faces(CellType type) {
    switch (type) {
    case CellType::hex8: return hex_faces;
    case CellType::wedge6: return wedge_faces;
    case CellType::tet4:
    case CellType::tet10: return tet_faces;
    }
    return {};
}

} // namespace

const DeckElementType* deck_element_type(std::string_view name) {
    for (const DeckElementType& type : element_types)
        if (type.name == name) return &type;
    return nullptr;
}

std::string deck_element_names() {
    std::string names;
    for (const DeckElementType& type : element_types) names += (names.empty() ? "" : ", ") + std::string(type.name);
    return names;
}

RawFace deck_face(const RawCell& cell, int face) {
    const auto faces = deck_faces(cell.type);
    RawFace found;
    if (face < 0 || face >= static_cast<int>(faces.size())) return found;
    const CornerFace& corners = faces[face];
    found.count = corners.count;
    for (int i = 0; i < corners.count; ++i) found.nodes[i] = cell.nodes[corners.nodes[i]];
    if (cell.type != CellType::tet10) return found;
    constexpr int mid[4][4] = {{-1, 4, 6, 7}, {4, -1, 5, 8}, {6, 5, -1, 9}, {7, 8, 9, -1}};
    found.count = 6;
    for (int i = 0; i < 3; ++i) found.nodes[3 + i] = cell.nodes[mid[corners.nodes[i]][corners.nodes[(i + 1) % 3]]];
    return found;
}

} // namespace osculate::mesh
