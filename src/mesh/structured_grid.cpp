#include "mesh/structured_grid.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace osculate::mesh {
namespace {

using Hex = std::array<Index, 8>;

/// Mixes the bits of a number: neighbouring columns get unrelated values, the same on every machine.   [splitmix64]
std::uint64_t mix(std::uint64_t value) {
    value += 0x9e3779b97f4a7c15u;
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
    return value ^ (value >> 31);
}

/// Which columns (i fastest) are cut into wedges.
std::vector<char> columns_to_cut(std::size_t columns, CellType element, BlockPattern pattern) {
    if (pattern == BlockPattern::hybrid) {
        if (element != CellType::hex8)
            throw std::invalid_argument("a hybrid pattern mixes hex8 and wedge6: it goes with element hex8 only");
        if (columns < 2) throw std::invalid_argument("a hybrid pattern needs at least two columns of elements");
        std::vector<std::size_t> order(columns);
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::sort(order.begin(), order.end(), [](std::size_t a, std::size_t b) { return mix(a) < mix(b); });
        std::vector<char> cut(columns, 0);
        for (std::size_t n = 0; n < columns / 2; ++n) cut[order[n]] = 1;
        return cut;
    }
    return std::vector<char>(columns, pattern == BlockPattern::triangle || element == CellType::wedge6);
}

/// The column's diagonals alternate like a chequerboard, so that no direction is preferred.
void append_wedges(const Hex& hex, bool even, std::vector<Index>& connectivity) {
    constexpr std::array<std::array<int, 3>, 4> triangles{{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};
    for (int t = 0; t < 2; ++t) {
        const auto& [a, b, c] = triangles[(even ? 0 : 2) + t];
        // VTK's wedge: triangle (0, 1, 2) looks out of the element, here down.
        connectivity.insert(connectivity.end(), {hex[a], hex[c], hex[b], hex[a + 4], hex[c + 4], hex[b + 4]});
    }
}

/// Six tetrahedra around a main diagonal (Kuhn), mirrored in every second hexahedron along each direction, which makes
/// neighbours share the diagonals of their common face.
std::array<std::array<int, 4>, 6> tets_of_hex(const std::array<int, 3>& cell) {
    constexpr std::array<std::array<int, 3>, 6> paths{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}}; // even permutations first
    const auto corner = [&](const std::array<int, 3>& at) {
        constexpr std::array<int, 4> around{0, 1, 3, 2};
        return around[at[0] + 2 * at[1]] + 4 * at[2];
    };
    std::array<std::array<int, 4>, 6> tets;
    const std::array<int, 3> start{cell[0] % 2, cell[1] % 2, cell[2] % 2};
    const bool mirrored = (start[0] + start[1] + start[2]) % 2 != 0;
    for (std::size_t p = 0; p < paths.size(); ++p) {
        std::array<int, 3> at = start;
        std::array<int, 4>& tet = tets[p];
        tet[0] = corner(at);
        for (int step = 0; step < 3; ++step) {
            at[paths[p][step]] = 1 - at[paths[p][step]];
            tet[step + 1] = corner(at);
        }
        if ((p >= 3) != mirrored) std::swap(tet[2], tet[3]);
    }
    return tets;
}

void append_tets(const Hex& hex, const std::array<int, 3>& cell, std::vector<Index>& connectivity) {
    for (const auto& tet : tets_of_hex(cell))
        for (const int corner : tet) connectivity.push_back(hex[corner]);
}

/// Ten-node tetrahedra in two by two by two cells of the grid: its nodes between the corners are the midside nodes.
void append_tet10s(Index first, Index row, Index layer, const std::array<int, 3>& cell,
                   std::vector<Index>& connectivity) {
    constexpr std::array<std::array<int, 3>, 8> at{
        {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}}};
    constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
    for (const auto& tet : tets_of_hex(cell)) {
        const auto between = [&](int a, int b) {
            const auto &p = at[tet[a]], &q = at[tet[b]];
            return first + (p[0] + q[0]) / 2 + (p[1] + q[1]) / 2 * row + (p[2] + q[2]) / 2 * layer;
        };
        for (int corner = 0; corner < 4; ++corner) connectivity.push_back(between(corner, corner));
        for (const auto& [a, b] : edges) connectivity.push_back(between(a, b));
    }
}

/// Names the exterior facets after the side of the grid that all their nodes lie on.
void name_sides(const StructuredGrid& grid, Mesh& mesh) {
    const auto& n = grid.divisions;
    for (const Facet& facet : exterior_facets(mesh)) {
        std::array<bool, 6> on;
        on.fill(true);
        for (const Index node : facet) {
            const std::array<int, 3> at{node % (n[0] + 1), node / (n[0] + 1) % (n[1] + 1),
                                        node / (n[0] + 1) / (n[1] + 1)};
            for (int d = 0; d < 3; ++d) {
                on[2 * d] = on[2 * d] && at[d] == 0;
                on[2 * d + 1] = on[2 * d + 1] && at[d] == n[d];
            }
        }
        const auto side = std::find(on.begin(), on.end(), true) - on.begin();
        mesh.surfaces[grid.sides.at(static_cast<std::size_t>(side))].push_back(facet);
    }
}

} // namespace

std::array<int, 3> grid_divisions(std::array<int, 3> elements, CellType element) {
    if (element != CellType::tet10) return elements;
    for (int& n : elements) {
        if (n > std::numeric_limits<int>::max() / 2)
            throw std::invalid_argument("too many divisions: the mesh cannot be numbered");
        n *= 2;
    }
    return elements;
}

Mesh mesh_grid(const StructuredGrid& grid, CellType element, BlockPattern pattern) {
    const auto& n = grid.divisions;
    if (std::min({n[0], n[1], n[2]}) < 1) throw std::invalid_argument("divisions must be 1 or more");
    // In floating point the product cannot overflow; six tetrahedra of four nodes each are the largest array.
    if (24.0 * (n[0] + 1.0) * (n[1] + 1.0) * (n[2] + 1.0) > std::numeric_limits<Index>::max())
        throw std::invalid_argument("too many divisions: the mesh cannot be numbered");
    const std::vector<char> cut = columns_to_cut(static_cast<std::size_t>(n[0]) * n[1], element, pattern);

    Mesh mesh;
    mesh.nodes.reserve(static_cast<std::size_t>(n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    for (int k = 0; k <= n[2]; ++k)
        for (int j = 0; j <= n[1]; ++j)
            for (int i = 0; i <= n[0]; ++i) mesh.nodes.push_back(grid.position(i, j, k));

    ElementBlock hexes{CellType::hex8, {}}, wedges{CellType::wedge6, {}}, tets{CellType::tet4, {}},
        tet10s{CellType::tet10, {}};
    const int step = element == CellType::tet10 ? 2 : 1;
    const Index row = n[0] + 1, layer = row * (n[1] + 1);
    for (int k = 0; k < n[2]; k += step)
        for (int j = 0; j < n[1]; j += step)
            for (int i = 0; i < n[0]; i += step) {
                const Index o = i + j * row + k * layer;
                const Hex hex{o,         o + 1,         o + 1 + row,         o + row,
                              o + layer, o + 1 + layer, o + 1 + row + layer, o + row + layer};
                if (element == CellType::tet10)
                    append_tet10s(o, row, layer, {i / 2, j / 2, k / 2}, tet10s.connectivity);
                else if (element == CellType::tet4)
                    append_tets(hex, {i, j, k}, tets.connectivity);
                else if (cut[static_cast<std::size_t>(j) * n[0] + i])
                    append_wedges(hex, (i + j) % 2 == 0, wedges.connectivity);
                else
                    hexes.connectivity.insert(hexes.connectivity.end(), hex.begin(), hex.end());
            }
    for (ElementBlock* block : {&hexes, &wedges, &tets, &tet10s})
        if (block->size() > 0) mesh.blocks.push_back(std::move(*block));
    name_sides(grid, mesh);
    return mesh;
}

} // namespace osculate::mesh
