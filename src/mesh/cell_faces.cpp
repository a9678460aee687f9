#include "mesh/cell_faces.hpp"

namespace osculate::mesh {
namespace {

constexpr LocalFace tet_faces[] = {{{0, 1, 3, -1}, 3}, {{1, 2, 3, -1}, 3}, {{2, 0, 3, -1}, 3}, {{0, 2, 1, -1}, 3}};
// VTK numbers a wedge so that triangle (0, 1, 2) looks out of the element.
constexpr LocalFace wedge_faces[] = {
    {{0, 1, 2, -1}, 3}, {{3, 5, 4, -1}, 3}, {{0, 3, 4, 1}, 4}, {{1, 4, 5, 2}, 4}, {{2, 5, 3, 0}, 4}};
constexpr LocalFace hex_faces[] = {{{0, 4, 7, 3}, 4}, {{1, 2, 6, 5}, 4}, {{0, 1, 5, 4}, 4},
                                   {{3, 7, 6, 2}, 4}, {{0, 3, 2, 1}, 4}, {{4, 5, 6, 7}, 4}};

// Every six-node face as its three corner triangles and the middle one, in the order of SurfaceFace::quarters.
constexpr LocalFace tet10_faces[] = {{{0, 4, 7, -1}, 3}, {{4, 1, 8, -1}, 3}, {{7, 8, 3, -1}, 3}, {{4, 8, 7, -1}, 3}, //
                                     {{1, 5, 8, -1}, 3}, {{5, 2, 9, -1}, 3}, {{8, 9, 3, -1}, 3}, {{5, 9, 8, -1}, 3}, //
                                     {{2, 6, 9, -1}, 3}, {{6, 0, 7, -1}, 3}, {{9, 7, 3, -1}, 3}, {{6, 7, 9, -1}, 3}, //
                                     {{0, 6, 4, -1}, 3}, {{6, 2, 5, -1}, 3}, {{4, 5, 1, -1}, 3}, {{6, 5, 4, -1}, 3}};

constexpr std::array<int, 3> tet_corners[] = {{1, 2, 3}};
constexpr std::array<int, 3> wedge_corners[] = {{2, 1, 3}, {0, 2, 4}, {1, 0, 5}, {4, 5, 0}, {5, 3, 1}, {3, 4, 2}};
constexpr std::array<int, 3> hex_corners[] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                              {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};

} // namespace

std::span<const LocalFace> cell_faces(CellType type) {
    switch (type) {
    case CellType::tet4: return tet_faces;
    case CellType::wedge6: return wedge_faces;
    case CellType::hex8: return hex_faces;
    case CellType::tet10: return tet10_faces;
    }
    return {};
}

std::array<int, 6> six_node_face(std::size_t face) {
    // its corners are those of its first three quarters, its middle nodes the corners of the last
    const LocalFace* quarters = tet10_faces + 4 * face;
    return {quarters[0].nodes[0], quarters[1].nodes[1], quarters[2].nodes[2],
            quarters[3].nodes[0], quarters[3].nodes[1], quarters[3].nodes[2]};
}

std::span<const std::array<int, 3>> corner_neighbours(CellType type) {
    switch (type) {
    case CellType::tet4: return tet_corners;
    case CellType::wedge6: return wedge_corners;
    case CellType::hex8: return hex_corners;
    case CellType::tet10: break; // its edges are curved
    }
    return {};
}

} // namespace osculate::mesh
