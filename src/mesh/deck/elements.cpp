#include "mesh/deck/elements.hpp"

#include "osculate/mesh/deck_mesh.hpp"

#include <algorithm>

namespace osculate::mesh {
const CellInfo* deck_element_type(std::string_view name) {
    return find_cell_type(
        [&](const CellInfo& info) { return !name.empty() && std::ranges::find(info.deck, name) != info.deck.end(); });
}

std::string deck_element_names() {
    std::string names;
    for (const CellInfo& info : cell_types())
        for (const std::string_view name : info.deck)
            if (!name.empty()) names += (names.empty() ? "" : ", ") + std::string(name);
    return names + ", CPE3, CPE4, CPE6, CPE8, CPS3, CPS4, CPS6, CPS8, CAX3, CAX4, CAX6, CAX8, R3D3, R3D4";
}

RawFace deck_face(const RawCell& cell, int face) {
    const CellInfo& info = cell_info(cell.type);
    const auto faces = info.deck_faces;
    RawFace found;
    if (face < 0 || face >= static_cast<int>(faces.size())) return found;
    const CellInfo::FaceNodes local = info.face_nodes(faces[static_cast<std::size_t>(face)]);
    found.count = local.count;
    for (int i = 0; i < local.count; ++i) found.nodes[i] = cell.nodes[local.nodes[i]];
    return found;
}

} // namespace osculate::mesh
