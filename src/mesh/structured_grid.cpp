#include "mesh/structured_grid.hpp"

#include "mesh/faces.hpp"
#include "osculate/mesh/generators.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>

namespace osculate::mesh {
namespace {

/// A hexahedron of the grid, which has a node midway between any two of its corners if its elements need them.
struct GridCell {
    std::array<int, 3> at;
    std::array<Index, 8> corners;
};

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
    if (pattern != BlockPattern::quad && !has_patterns(element))
        throw std::invalid_argument("elements of type " + std::string(cell_info(element).name) +
                                    " go with pattern quad only");
    return std::vector<char>(columns, pattern == BlockPattern::triangle || is_wedge(element));
}

/// Appends an element by its corners in the hexahedron. Node numbers are linear in i, j, k, so that the number half way
/// between two is that of the node midway.
void append_element(const GridCell& cell, std::span<const int> corners, const CellInfo& info,
                    std::vector<Index>& connectivity) {
    const auto node = [&](int corner) { return cell.corners[corners[corner]]; };
    for (int corner = 0; corner < info.corners(); ++corner) connectivity.push_back(node(corner));
    for (const auto& [a, b] : info.edges) connectivity.push_back(node(a) + (node(b) - node(a)) / 2);
}

void append_hex(const GridCell& cell, const CellInfo& info, std::vector<Index>& connectivity) {
    constexpr std::array<int, 8> all{0, 1, 2, 3, 4, 5, 6, 7};
    append_element(cell, all, info, connectivity);
}

/// The column's diagonals alternate like a chequerboard, so that no direction is preferred.
void append_wedges(const GridCell& cell, const CellInfo& info, std::vector<Index>& connectivity) {
    constexpr std::array<std::array<int, 3>, 4> triangles{{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}};
    const bool even = (cell.at[0] + cell.at[1]) % 2 == 0;
    for (int t = 0; t < 2; ++t) {
        const auto& [a, b, c] = triangles[(even ? 0 : 2) + t];
        // VTK's wedge: triangle (0, 1, 2) looks out of the element, here down.
        append_element(cell, std::array{a, c, b, a + 4, c + 4, b + 4}, info, connectivity);
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

void append_tets(const GridCell& cell, const CellInfo& info, std::vector<Index>& connectivity) {
    for (const auto& tet : tets_of_hex(cell.at)) append_element(cell, tet, info, connectivity);
}

/// How elements of a type fill a hexahedron of the grid.
struct Filling {
    CellType type;
    void (*append)(const GridCell& cell, const CellInfo& info, std::vector<Index>& connectivity);
};

constexpr Filling fillings[] = {{CellType::tet4, append_tets},      {CellType::wedge6, append_wedges},
                                {CellType::hex8, append_hex},       {CellType::tet10, append_tets},
                                {CellType::wedge15, append_wedges}, {CellType::hex20, append_hex}};

const Filling& filling_of(CellType type) {
    const auto* const found = std::ranges::find(fillings, type, &Filling::type);
    if (found == std::end(fillings))
        throw std::invalid_argument("no generator makes " + std::string(cell_info(type).name) + " elements");
    return *found;
}

/// Hexahedra of the grid along each edge of an element.
int steps_of(CellType element) {
    return cell_info(element).edges.empty() ? 1 : 2;
}

/// The sides of the grid that each node lies on: side s is bit s.
std::vector<unsigned> sides_of_nodes(const std::array<int, 3>& n) {
    std::vector<unsigned> sides;
    sides.reserve(static_cast<std::size_t>(n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    const auto of = [&](int d, int at) { return (at == 0 ? 1U : 0U) << (2 * d) | (at == n[d] ? 2U : 0U) << (2 * d); };
    for (int k = 0; k <= n[2]; ++k)
        for (int j = 0; j <= n[1]; ++j)
            for (int i = 0; i <= n[0]; ++i) sides.push_back(of(0, i) | of(1, j) | of(2, k));
    return sides;
}

/// Names the facets all of whose nodes lie on a side of the grid after it: they are the exterior ones.
void name_sides(const StructuredGrid& grid, Mesh& mesh) {
    const std::vector<unsigned> sides = sides_of_nodes(grid.divisions);
    Faces(mesh).for_each([&](std::size_t, const Facet& facet) {
        unsigned on = ~0U;
        for (const Index node : facet) on &= sides[static_cast<std::size_t>(node)];
        if (on != 0) mesh.surfaces[grid.sides.at(static_cast<std::size_t>(std::countr_zero(on)))].push_back(facet);
    });
}

/// Removes nodes of the grid that no element has, as those midway in the faces of serendipity elements.
void remove_unused_nodes(Mesh& mesh) {
    std::vector<Index> number(mesh.nodes.size(), -1);
    for (const ElementBlock& block : mesh.blocks)
        for (const Index node : block.connectivity) number[static_cast<std::size_t>(node)] = 0;
    if (std::ranges::find(number, -1) == number.end()) return;
    Index used = 0;
    for (std::size_t node = 0; node < number.size(); ++node)
        if (number[node] == 0) {
            mesh.nodes[static_cast<std::size_t>(used)] = mesh.nodes[node];
            number[node] = used++;
        }
    mesh.nodes.resize(static_cast<std::size_t>(used));
    for (ElementBlock& block : mesh.blocks)
        for (Index& node : block.connectivity) node = number[static_cast<std::size_t>(node)];
    for (auto& [name, facets] : mesh.surfaces)
        for (Facet& facet : facets)
            for (int c = 0; c < facet.count; ++c) {
                Index& node = facet.nodes[static_cast<std::size_t>(c)];
                node = number[static_cast<std::size_t>(node)];
            }
}

} // namespace

std::span<const CellType> generated_types() {
    static constexpr auto types = [] {
        std::array<CellType, std::size(fillings)> all{};
        std::ranges::transform(fillings, all.begin(), &Filling::type);
        return all;
    }();
    return types;
}

std::array<int, 3> grid_divisions(std::array<int, 3> elements, CellType element) {
    const int steps = steps_of(element);
    for (int& n : elements) {
        if (n > std::numeric_limits<int>::max() / steps)
            throw std::invalid_argument("too many divisions: the mesh cannot be numbered");
        n *= steps;
    }
    return elements;
}

Mesh mesh_grid(const StructuredGrid& grid, CellType element, BlockPattern pattern) {
    const Filling &whole = filling_of(element), &wedges = is_wedge(element) ? whole : filling_of(CellType::wedge6);
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

    std::vector<ElementBlock> blocks;
    for (const CellInfo& info : cell_types()) blocks.push_back({info.type, {}});
    const int step = steps_of(element);
    const Index row = n[0] + 1, layer = row * (n[1] + 1);
    for (int k = 0; k < n[2]; k += step)
        for (int j = 0; j < n[1]; j += step)
            for (int i = 0; i < n[0]; i += step) {
                const Index o = i + j * row + k * layer, di = step, dj = step * row, dk = step * layer;
                const GridCell cell{
                    {i / step, j / step, k / step},
                    {o, o + di, o + di + dj, o + dj, o + dk, o + di + dk, o + di + dj + dk, o + dj + dk}};
                const bool into_wedges = cut[static_cast<std::size_t>(j) * n[0] + i] != 0;
                const Filling& filling = into_wedges ? wedges : whole;
                ElementBlock& block = *std::ranges::find(blocks, filling.type, &ElementBlock::type);
                filling.append(cell, cell_info(filling.type), block.connectivity);
            }
    for (ElementBlock& block : blocks)
        if (block.size() > 0) mesh.blocks.push_back(std::move(block));
    name_sides(grid, mesh);
    remove_unused_nodes(mesh);
    return mesh;
}

} // namespace osculate::mesh
