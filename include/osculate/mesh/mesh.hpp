#pragma once
/// The volume mesh of one body: nodes, element blocks, named node sets and named surfaces.

#include "osculate/core/types.hpp"
#include "osculate/mesh/cell_type.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace osculate::mesh {

/// Elements of one shape, stored contiguously.
struct ElementBlock {
    CellType type = CellType::hex8;
    std::vector<Index> connectivity; ///< nodes_per_cell(type) node numbers per element
    int section = 0;                 ///< which of the parts that were asked for, from 1; 0: none of them

    [[nodiscard]] Index size() const { return static_cast<Index>(connectivity.size()) / nodes_per_cell(type); }
};

/// A triangle or quadrilateral of a surface, corners counter-clockwise seen from outside the body. The six-node face of
/// a tet10 is divided into four triangles, so that its midside nodes are corners of facets, as all other nodes.
struct Facet {
    std::array<Index, 4> nodes{-1, -1, -1, -1}; ///< nodes[3] is -1 for a triangle
    int count = 0;                              ///< 3 or 4
    Index block = -1;                           ///< element block and element the facet belongs to
    Index element = -1;

    [[nodiscard]] auto begin() const { return nodes.begin(); }
    [[nodiscard]] auto end() const { return nodes.begin() + count; }
};

struct Mesh {
    std::vector<Vec3> nodes;            ///< reference positions, metres
    std::vector<std::int64_t> node_ids; ///< numbers in the file, several nodes may have one; empty: not from a file
    std::vector<ElementBlock> blocks;
    std::map<std::string, std::vector<Index>> node_sets;
    std::map<std::string, std::vector<Facet>> surfaces; ///< named parts of the exterior

    [[nodiscard]] Index node_count() const { return static_cast<Index>(nodes.size()); }
    [[nodiscard]] Index element_count() const;
};

/// Divides blocks so that the elements of each are of one section. @param section  of every element, block by block
void divide(Mesh& mesh, const std::vector<std::vector<int>>& section);

/// Facets that belong to exactly one element, oriented outward, in order of block, element and local face.
/// O(n log n) in the number of element faces.
[[nodiscard]] std::vector<Facet> exterior_facets(const Mesh& mesh);
/// The numbers of all nodes of facets, ascending.
[[nodiscard]] std::vector<Index> nodes_of(const std::vector<Facet>& facets);

/// Outward area vector of a facet at given nodal positions, square metres: the integral of n dA (exact for a bilinear
/// quadrilateral too).
[[nodiscard]] Vec3 facet_area_vector(const Facet& facet, const std::vector<Vec3>& positions);

/// Centroid and outward unit normal of a facet at given nodal positions (bilinear centre for a quadrilateral).
[[nodiscard]] Vec3 facet_centroid(const Facet& facet, const std::vector<Vec3>& positions);
[[nodiscard]] Vec3 facet_normal(const Facet& facet, const std::vector<Vec3>& positions);

} // namespace osculate::mesh
