#pragma once
/// The list of cell types: the row of a type contains all facts about it; readers, writers, surfaces and repairs use
/// only this. What elements compute is in the list of fe::with_element.

#include "osculate/mesh/face_shape.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <string_view>

namespace osculate::mesh {

/// Volume element shapes; node order is VTK's (VTK_TETRA, VTK_WEDGE, VTK_HEXAHEDRON, VTK_QUADRATIC_TETRA,
/// VTK_QUADRATIC_WEDGE, VTK_QUADRATIC_HEXAHEDRON). Note the wedge: the right-handed normal of its triangle (0, 1, 2) points out of the element,
/// away from (3, 4, 5). Nodes 4 to 9 of a tet10 are the midpoints of the edges 01, 12, 20, 03, 13, 23; nodes 6 to 14 of a wedge15
/// those of 01, 12, 20, of 34, 45, 53, and of 03, 14, 25; nodes 8 to 19 of a hex20 those of 01, 12, 23, 30, of 45, 56, 67, 74, and of 04, 15, 26, 37.
enum class CellType { tet4, wedge6, hex8, tet10, wedge15, hex20 };

inline constexpr int most_nodes_per_cell = 20;
using NodeOrder = std::array<int, most_nodes_per_cell>; ///< entry i: number of our node i in the other order

struct CellInfo {
    CellType type;
    std::string_view name;   ///< in scenes and messages
    std::string_view meshio; ///< in Python
    int nodes;
    int vtk;  ///< VTK's number
    int gmsh; ///< Gmsh's number
    NodeOrder from_gmsh;
    std::array<std::string_view, 3> deck; ///< names in Abaqus' and CalculiX' decks, and their order
    NodeOrder from_deck;
    NodeOrder mirrored;                        ///< the same cell seen in a mirror
    std::span<const LocalFace> faces;          ///< by their corners
    std::span<const LocalFace> facets;         ///< for surfaces: the pieces of every face in turn
    std::span<const LocalFace> deck_faces;     ///< S1, S2, ... by their corners, in our local nodes
    std::span<const std::array<int, 2>> edges; ///< with the midside nodes, in their order
    /// Of every corner, ordered so that the triple product of the edges to them is positive in a well-shaped element.
    /// One corner of a straight tetrahedron stands for all; none of a tet10, of which mesh::bad_corner sees all nodes. Of a
    /// hex20 they see the corners alone; fe::bad_jacobians sees the rest.
    std::span<const std::array<int, 3>> corner_neighbours;

    [[nodiscard]] constexpr int corners() const { return nodes - static_cast<int>(edges.size()); }
    /// Midside node between two corners; -1 if there is none.
    [[nodiscard]] constexpr int midway(int a, int b) const;
    /// Nodes of a face, in the order of FaceShape; the numbers past `count` are -1.
    struct FaceNodes {
        std::array<int, most_nodes_per_face> nodes;
        int count;
    };
    [[nodiscard]] constexpr FaceNodes face_nodes(const LocalFace& corners) const;
};

namespace cells {

inline constexpr LocalFace tet_faces[] = {
    {{0, 1, 3, -1}, 3}, {{1, 2, 3, -1}, 3}, {{2, 0, 3, -1}, 3}, {{0, 2, 1, -1}, 3}};
inline constexpr LocalFace tet_deck_faces[] = {
    {{0, 1, 2, -1}, 3}, {{0, 3, 1, -1}, 3}, {{1, 3, 2, -1}, 3}, {{2, 3, 0, -1}, 3}};
inline constexpr std::array<int, 3> tet_corners[] = {{1, 2, 3}};
inline constexpr std::array<int, 2> tet_edges[] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

inline constexpr LocalFace wedge_faces[] = {
    {{0, 1, 2, -1}, 3}, {{3, 5, 4, -1}, 3}, {{0, 3, 4, 1}, 4}, {{1, 4, 5, 2}, 4}, {{2, 5, 3, 0}, 4}};
inline constexpr LocalFace wedge_deck_faces[] = {
    {{0, 1, 2, -1}, 3}, {{3, 4, 5, -1}, 3}, {{0, 2, 5, 3}, 4}, {{2, 1, 4, 5}, 4}, {{1, 0, 3, 4}, 4}};
inline constexpr std::array<int, 3> wedge_corners[] = {{2, 1, 3}, {0, 2, 4}, {1, 0, 5},
                                                       {4, 5, 0}, {5, 3, 1}, {3, 4, 2}};

inline constexpr std::array<int, 2> wedge_edges[] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5},
                                                     {5, 3}, {0, 3}, {1, 4}, {2, 5}};

inline constexpr LocalFace hex_faces[] = {{{0, 4, 7, 3}, 4}, {{1, 2, 6, 5}, 4}, {{0, 1, 5, 4}, 4},
                                          {{3, 7, 6, 2}, 4}, {{0, 3, 2, 1}, 4}, {{4, 5, 6, 7}, 4}};
inline constexpr LocalFace hex_deck_faces[] = {{{0, 1, 2, 3}, 4}, {{4, 7, 6, 5}, 4}, {{0, 4, 5, 1}, 4},
                                               {{1, 5, 6, 2}, 4}, {{2, 6, 7, 3}, 4}, {{3, 7, 4, 0}, 4}};
inline constexpr std::array<int, 3> hex_corners[] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                                     {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};

inline constexpr std::array<int, 2> hex_edges[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                                   {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

constexpr int midway(std::span<const std::array<int, 2>> edges, int corners, int a, int b) {
    for (std::size_t e = 0; e < edges.size(); ++e)
        if ((edges[e][0] == a && edges[e][1] == b) || (edges[e][0] == b && edges[e][1] == a))
            return corners + static_cast<int>(e);
    return -1;
}

constexpr CellInfo::FaceNodes face_nodes(const LocalFace& face, std::span<const std::array<int, 2>> edges,
                                         int corners) {
    CellInfo::FaceNodes all{{-1, -1, -1, -1, -1, -1, -1, -1}, face.count};
    const auto n = static_cast<std::size_t>(face.count);
    for (std::size_t i = 0; i < n; ++i) {
        all.nodes[i] = face.nodes[i];
        if (!edges.empty()) all.nodes[n + i] = midway(edges, corners, face.nodes[i], face.nodes[(i + 1) % n]);
    }
    if (!edges.empty()) all.count = 2 * face.count;
    return all;
}

/// The pieces of all faces with midside nodes, so many of all.
template <int pieces, std::size_t n>
constexpr auto in_pieces(const LocalFace (&faces)[n], std::span<const std::array<int, 2>> edges, int corners) {
    std::array<LocalFace, pieces> result{};
    std::size_t filled = 0;
    for (const LocalFace& face : faces) {
        const CellInfo::FaceNodes all = face_nodes(face, edges, corners);
        for_each_piece(all.nodes, all.count, [&](const std::array<int, 4>& nodes, int count) {
            result[filled++] = {nodes, count};
        });
    }
    return result;
}
inline constexpr auto tet10_facets = in_pieces<16>(tet_faces, tet_edges, 4);
inline constexpr auto wedge15_facets = in_pieces<23>(wedge_faces, wedge_edges, 6);
inline constexpr auto hex20_facets = in_pieces<30>(hex_faces, hex_edges, 8);

// The first triangle of a wedge in decks and in Gmsh faces inward; ours faces outward.
inline constexpr CellInfo list[] = {
    {CellType::hex8,
     "hex8",
     "hexahedron",
     8,
     12,
     5,
     {0, 1, 2, 3, 4, 5, 6, 7},
     {"C3D8", "C3D8R", "C3D8I"},
     {0, 1, 2, 3, 4, 5, 6, 7},
     {4, 5, 6, 7, 0, 1, 2, 3},
     hex_faces,
     hex_faces,
     hex_deck_faces,
     {},
     hex_corners},
    {CellType::wedge6,
     "wedge6",
     "wedge",
     6,
     13,
     6,
     {0, 2, 1, 3, 5, 4},
     {"C3D6"},
     {0, 2, 1, 3, 5, 4},
     {0, 2, 1, 3, 5, 4},
     wedge_faces,
     wedge_faces,
     wedge_deck_faces,
     {},
     wedge_corners},
    {CellType::tet4,
     "tet4",
     "tetra",
     4,
     10,
     4,
     {0, 1, 2, 3},
     {"C3D4"},
     {0, 1, 2, 3},
     {1, 0, 2, 3},
     tet_faces,
     tet_faces,
     tet_deck_faces,
     {},
     tet_corners},
    {CellType::tet10,
     "tet10",
     "tetra10",
     10,
     24,
     11,
     {0, 1, 2, 3, 4, 5, 6, 7, 9, 8},
     {"C3D10"},
     {0, 1, 2, 3, 4, 5, 6, 7, 8, 9},
     {1, 0, 2, 3, 4, 6, 5, 8, 7, 9},
     tet_faces,
     tet10_facets,
     tet_deck_faces,
     tet_edges,
     {}},
    {CellType::wedge15,
     "wedge15",
     "wedge15",
     15,
     26,
     18,
     {0, 2, 1, 3, 5, 4, 7, 9, 6, 13, 14, 12, 8, 11, 10},
     {"C3D15"},
     {0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13},
     {0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13},
     wedge_faces,
     wedge15_facets,
     wedge_deck_faces,
     wedge_edges,
     wedge_corners},
    {CellType::hex20,
     "hex20",
     "hexahedron20",
     20,
     25,
     17,
     {0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15},
     {"C3D20", "C3D20R"},
     {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19},
     {4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11, 16, 17, 18, 19},
     hex_faces,
     hex20_facets,
     hex_deck_faces,
     hex_edges,
     hex_corners},
};

} // namespace cells

constexpr int CellInfo::midway(int a, int b) const {
    return cells::midway(edges, corners(), a, b);
}

constexpr CellInfo::FaceNodes CellInfo::face_nodes(const LocalFace& face) const {
    return cells::face_nodes(face, edges, corners());
}

/// All types, in the order of the blocks of a mesh.
[[nodiscard]] constexpr std::span<const CellInfo> cell_types() {
    return cells::list;
}

[[nodiscard]] constexpr const CellInfo& cell_info(CellType type) {
    std::size_t row = 0;
    while (cells::list[row].type != type) ++row;
    return cells::list[row];
}

[[nodiscard]] constexpr int nodes_per_cell(CellType type) {
    return cell_info(type).nodes;
}

/// The first row for which f is true; null if there is none.
template <class F> [[nodiscard]] constexpr const CellInfo* find_cell_type(F&& f) {
    for (const CellInfo& info : cell_types())
        if (f(info)) return &info;
    return nullptr;
}

/// The type with the same corners and faces and no midside nodes.
[[nodiscard]] constexpr const CellInfo& without_midside_nodes(const CellInfo& info) {
    return *find_cell_type([&](const CellInfo& other) {
        return other.nodes == info.corners() && other.faces.size() == info.faces.size();
    });
}
[[nodiscard]] constexpr bool is_wedge(CellType type) {
    return without_midside_nodes(cell_info(type)).type == CellType::wedge6;
}
static_assert(std::ranges::all_of(cell_types(),
                                  [](const CellInfo& info) { return without_midside_nodes(info).edges.empty(); }),
              "advice names the type without midside nodes");

/// Names of the types for which f is true, in a sentence, "hex8, wedge6 or tet4"; empty if there is none.
/// @param last  the word before the last name
template <class F> [[nodiscard]] std::string cell_names(std::string_view last, F&& f) {
    std::string names;
    const CellInfo* open = nullptr; // not yet written: only what follows tells whether it is the last
    const auto write = [&](std::string_view joint) { names.append(names.empty() ? "" : joint).append(open->name); };
    for (const CellInfo& info : cell_types()) {
        if (!f(info)) continue;
        if (open != nullptr) write(", ");
        open = &info;
    }
    if (open != nullptr) write(" " + std::string(last) + " ");
    return names;
}

} // namespace osculate::mesh
