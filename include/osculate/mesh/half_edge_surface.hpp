#pragma once
/// A surface as a doubly connected edge list: neighbours in rings, across edges and around vertices.

#include "osculate/mesh/mesh.hpp"

#include <numbers>
#include <span>
#include <vector>

namespace osculate::mesh {

/// Edges whose facet normals differ by more than this angle, rad, are feature edges: coarse arcs stay smooth, corners
/// do not.
inline constexpr double default_feature_angle = 40 * std::numbers::pi / 180;

/// One side of an edge, directed along the boundary of its facet; the facet is on its left, seen from outside.
struct HalfEdge {
    Index origin = -1; ///< local vertex at its start
    Index next = -1;   ///< next half-edge around the facet
    Index twin = -1;   ///< half-edge of the facet across the edge; -1 on the boundary
    Index facet = -1;
};

/// Topology of an oriented surface of triangles and quadrilaterals; immutable. Vertices have local numbers 0, 1, ... in
/// ascending order of their mesh nodes; facets keep the order given; half-edge numbers follow facets and corners.
class HalfEdgeSurface {
public:
    /// @param facets         oriented facets of one surface, closed or not, connected or not
    /// @param positions      of all mesh nodes, metres; for feature edges and facet sizes only
    /// @param feature_angle  rad
    /// Throws std::runtime_error, with the nodes, for an edge with three facets or more, for an edge whose facets
    /// disagree about the outside, and for a facet that has the same corner twice. O(n log n).
    HalfEdgeSurface(std::vector<Facet> facets, const std::vector<Vec3>& positions,
                    double feature_angle = default_feature_angle);

    [[nodiscard]] Index facet_count() const { return static_cast<Index>(facets_.size()); }
    [[nodiscard]] Index vertex_count() const { return static_cast<Index>(vertex_nodes_.size()); }
    [[nodiscard]] Index edge_count() const { return edge_count_; }
    [[nodiscard]] Index boundary_loop_count() const { return boundary_loop_count_; }

    [[nodiscard]] const std::vector<Facet>& facets() const { return facets_; }
    /// Mesh node of every local vertex, ascending.
    [[nodiscard]] const std::vector<Index>& vertex_nodes() const { return vertex_nodes_; }
    /// Local vertex of a mesh node; -1 when the surface does not have it. O(log n).
    [[nodiscard]] Index vertex_of(Index node) const;

    [[nodiscard]] const std::vector<HalfEdge>& half_edges() const { return half_edges_; }
    /// Half-edge that starts at corner 0 of a facet; the one at corner c has this number plus c.
    [[nodiscard]] Index first_half_edge(Index facet) const { return corner_start_[facet]; }
    /// Local vertices of a facet, counter-clockwise seen from outside.
    [[nodiscard]] std::span<const Index> facet_vertices(Index facet) const;
    /// Facets around a vertex, counter-clockwise seen from outside; at a boundary from one end of the fan to the other.
    /// If several fans meet only in this vertex, they are listed one after another.
    [[nodiscard]] std::span<const Index> vertex_facets(Index vertex) const;
    /// Facet across every edge of a facet, edge c from corner c to the next; -1 at a boundary and for c past the last
    /// edge.
    [[nodiscard]] std::array<Index, 4> edge_neighbours(Index facet) const;
    /// Facets that share a vertex with a facet, without this facet, ascending.
    [[nodiscard]] std::vector<Index> vertex_neighbours(Index facet) const;

    [[nodiscard]] bool is_boundary_edge(Index half_edge) const { return half_edges_[half_edge].twin < 0; }
    [[nodiscard]] bool is_boundary_vertex(Index vertex) const { return boundary_vertex_[vertex] != 0; }
    /// Whether the normals across the edge differ by more than the feature angle; never at a boundary.
    [[nodiscard]] bool is_feature_edge(Index half_edge) const { return feature_edge_[half_edge] != 0; }

    /// Facets of the k-ring, ascending: ring 0 is the facet; ring k adds those that share a vertex with ring k-1 and can
    /// be reached around that vertex without crossing a feature edge. Cost: the size of the ring.
    [[nodiscard]] std::vector<Index> ring_facets(Index facet, int k) const;
    /// Local vertices of the k-ring, ascending: all corners of its facets.
    [[nodiscard]] std::vector<Index> facet_ring(Index facet, int k) const;

    /// Reference size of a facet: the square root of its area, metres.
    [[nodiscard]] double facet_size(Index facet) const { return facet_size_[facet]; }
    [[nodiscard]] double mean_facet_size() const { return mean_facet_size_; }
    /// Gives all facets one size, where others than these tell how finely lengths are to be judged.
    void use_facet_size(double size) {
        facet_size_.assign(facet_size_.size(), size);
        mean_facet_size_ = size;
    }

private:
    [[nodiscard]] Index previous(Index half_edge) const;
    void number_vertices();
    void pair_twins();
    void order_fans();
    void count_boundary_loops();
    void measure(const std::vector<Vec3>& positions, double feature_angle);

    std::vector<Facet> facets_;
    std::vector<Index> vertex_nodes_;
    std::vector<Index> corner_start_; ///< per facet, one more at the end
    std::vector<Index> corners_;      ///< local vertices, facet by facet
    std::vector<HalfEdge> half_edges_;
    std::vector<Index> fan_start_; ///< per vertex, one more at the end
    std::vector<Index> fans_;      ///< facets, vertex by vertex
    std::vector<char> boundary_vertex_, feature_edge_;
    std::vector<double> facet_size_;
    double mean_facet_size_ = 0;
    Index edge_count_ = 0, boundary_loop_count_ = 0;
};

} // namespace osculate::mesh
