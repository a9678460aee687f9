#include "osculate/mesh/half_edge_surface.hpp"

#include "mesh/sort_unique.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <unordered_set>
#include <utility>

namespace osculate::mesh {
namespace {

[[noreturn]] void fail(const std::string& what, Index node_a, Index node_b) {
    throw std::runtime_error("surface: " + what + " at the edge between nodes " + std::to_string(node_a) + " and " +
                             std::to_string(node_b));
}

} // namespace

HalfEdgeSurface::HalfEdgeSurface(std::vector<Facet> facets, const std::vector<Vec3>& positions, double feature_angle)
    : facets_(std::move(facets)) {
    number_vertices();
    pair_twins();
    order_fans();
    count_boundary_loops();
    measure(positions, feature_angle);
}

Index HalfEdgeSurface::vertex_of(Index node) const {
    const auto found = std::lower_bound(vertex_nodes_.begin(), vertex_nodes_.end(), node);
    return found != vertex_nodes_.end() && *found == node ? static_cast<Index>(found - vertex_nodes_.begin()) : -1;
}

std::span<const Index> HalfEdgeSurface::facet_vertices(Index facet) const {
    return {corners_.data() + corner_start_[facet], static_cast<std::size_t>(facets_[facet].count)};
}

std::span<const Index> HalfEdgeSurface::vertex_facets(Index vertex) const {
    return {fans_.data() + fan_start_[vertex], fans_.data() + fan_start_[vertex + 1]};
}

std::array<Index, 4> HalfEdgeSurface::edge_neighbours(Index facet) const {
    std::array<Index, 4> neighbours{-1, -1, -1, -1};
    for (int c = 0; c < facets_[facet].count; ++c)
        if (const Index twin = half_edges_[corner_start_[facet] + c].twin; twin >= 0)
            neighbours[c] = half_edges_[twin].facet;
    return neighbours;
}

std::vector<Index> HalfEdgeSurface::vertex_neighbours(Index facet) const {
    std::vector<Index> neighbours;
    for (const Index vertex : facet_vertices(facet))
        for (const Index other : vertex_facets(vertex))
            if (other != facet) neighbours.push_back(other);
    sort_unique(neighbours);
    return neighbours;
}

std::vector<Index> HalfEdgeSurface::ring_facets(Index facet, int k) const {
    std::vector<Index> ring{facet};
    std::unordered_set<Index> reached{facet};
    std::size_t grown = 0; // facets of the ring before this one have passed on their neighbours
    const auto passable = [&](Index h) { return half_edges_[h].twin >= 0 && !feature_edge_[h]; };
    const auto reach = [&](Index h) {
        if (reached.insert(half_edges_[h].facet).second) ring.push_back(half_edges_[h].facet);
    };
    for (int level = 0; level < k; ++level) {
        for (const std::size_t end = ring.size(); grown < end; ++grown) {
            const Index first = corner_start_[ring[grown]];
            for (Index start = first; start < first + facets_[ring[grown]].count; ++start) {
                // Around the origin of `start`, counter-clockwise and then clockwise, until something stops the walk.
                bool full_circle = false;
                for (Index h = start; passable(previous(h)) && !full_circle; full_circle = h == start) {
                    h = half_edges_[previous(h)].twin;
                    reach(h);
                }
                if (full_circle) continue;
                for (Index h = start; passable(h);) {
                    h = half_edges_[half_edges_[h].twin].next;
                    reach(h);
                }
            }
        }
    }
    std::sort(ring.begin(), ring.end());
    return ring;
}

std::vector<Index> HalfEdgeSurface::facet_ring(Index facet, int k) const {
    std::vector<Index> vertices;
    for (const Index member : ring_facets(facet, k)) {
        const auto corners = facet_vertices(member);
        vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
    sort_unique(vertices);
    return vertices;
}

Index HalfEdgeSurface::previous(Index half_edge) const {
    const Index facet = half_edges_[half_edge].facet, first = corner_start_[facet];
    return half_edge == first ? first + facets_[facet].count - 1 : half_edge - 1;
}

void HalfEdgeSurface::number_vertices() {
    for (const Facet& facet : facets_) vertex_nodes_.insert(vertex_nodes_.end(), facet.begin(), facet.end());
    const std::size_t corner_count = vertex_nodes_.size();
    sort_unique(vertex_nodes_);

    corner_start_.reserve(facets_.size() + 1);
    corners_.reserve(corner_count);
    half_edges_.reserve(corner_count);
    for (Index f = 0; f < facet_count(); ++f) {
        const Facet& facet = facets_[f];
        const auto first = static_cast<Index>(corners_.size());
        corner_start_.push_back(first);
        for (int c = 0; c < facet.count; ++c) {
            if (std::count(facet.begin(), facet.end(), facet.nodes[c]) > 1)
                throw std::runtime_error("surface: a facet has node " + std::to_string(facet.nodes[c]) + " twice");
            corners_.push_back(vertex_of(facet.nodes[c]));
            half_edges_.push_back({corners_.back(), first + (c + 1) % facet.count, -1, f});
        }
    }
    corner_start_.push_back(static_cast<Index>(corners_.size()));
}

void HalfEdgeSurface::pair_twins() {
    struct Side {
        Index low, high, half_edge;
    };
    std::vector<Side> sides;
    sides.reserve(half_edges_.size());
    for (std::size_t h = 0; h < half_edges_.size(); ++h) {
        const Index a = half_edges_[h].origin, b = half_edges_[half_edges_[h].next].origin;
        sides.push_back({std::min(a, b), std::max(a, b), static_cast<Index>(h)});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.half_edge) < std::tie(b.low, b.high, b.half_edge);
    });
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        const Side& side = sides[first];
        while (last < sides.size() && sides[last].low == side.low && sides[last].high == side.high) ++last;
        ++edge_count_;
        const auto fail_here = [&](const char* what) { fail(what, vertex_nodes_[side.low], vertex_nodes_[side.high]); };
        if (last - first > 2) fail_here("more than two facets meet");
        if (last - first < 2) continue;
        const Index a = side.half_edge, b = sides[first + 1].half_edge;
        if (half_edges_[a].origin == half_edges_[b].origin) fail_here("two facets disagree about the outside");
        half_edges_[a].twin = b;
        half_edges_[b].twin = a;
    }
}

void HalfEdgeSurface::order_fans() {
    // Outgoing half-edges vertex by vertex, ascending.
    fan_start_.assign(vertex_nodes_.size() + 1, 0);
    for (const HalfEdge& h : half_edges_) ++fan_start_[h.origin + 1];
    std::partial_sum(fan_start_.begin(), fan_start_.end(), fan_start_.begin());
    std::vector<Index> outgoing(half_edges_.size()), place(fan_start_.begin(), fan_start_.end() - 1);
    for (std::size_t h = 0; h < half_edges_.size(); ++h)
        outgoing[place[half_edges_[h].origin]++] = static_cast<Index>(h);

    fans_.reserve(half_edges_.size());
    boundary_vertex_.assign(vertex_nodes_.size(), 0);
    std::vector<char> done(half_edges_.size(), 0);
    const auto walk = [&](Index start) {
        for (Index h = start; h >= 0 && !done[h]; h = half_edges_[previous(h)].twin) {
            done[h] = 1;
            fans_.push_back(half_edges_[h].facet);
        }
    };
    for (Index v = 0; v < vertex_count(); ++v) {
        const std::span<const Index> here(outgoing.data() + fan_start_[v], outgoing.data() + fan_start_[v + 1]);
        // A fan that ends at the boundary begins with the facet that has nothing on its clockwise side.
        for (const Index h : here)
            if (half_edges_[h].twin < 0) {
                boundary_vertex_[v] = 1;
                walk(h);
            }
        for (const Index h : here) walk(h);
    }
}

void HalfEdgeSurface::count_boundary_loops() {
    std::vector<char> done(half_edges_.size(), 0);
    for (std::size_t first = 0; first < half_edges_.size(); ++first) {
        if (half_edges_[first].twin >= 0 || done[first]) continue;
        ++boundary_loop_count_;
        for (auto h = static_cast<Index>(first); !done[h];) {
            done[h] = 1;
            h = half_edges_[h].next;
            while (half_edges_[h].twin >= 0) h = half_edges_[half_edges_[h].twin].next;
        }
    }
}

void HalfEdgeSurface::measure(const std::vector<Vec3>& positions, double feature_angle) {
    std::vector<Vec3> areas;
    areas.reserve(facets_.size());
    facet_size_.reserve(facets_.size());
    for (const Facet& facet : facets_) {
        areas.push_back(facet_area_vector(facet, positions));
        facet_size_.push_back(std::sqrt(areas.back().norm()));
    }
    if (!facets_.empty())
        mean_facet_size_ = std::accumulate(facet_size_.begin(), facet_size_.end(), 0.0) / facet_count();

    feature_edge_.assign(half_edges_.size(), 0);
    for (std::size_t h = 0; h < half_edges_.size(); ++h) {
        if (half_edges_[h].twin < 0) continue;
        const Vec3 &a = areas[half_edges_[h].facet], &b = areas[half_edges_[half_edges_[h].twin].facet];
        feature_edge_[h] = std::atan2(a.cross(b).norm(), a.dot(b)) > feature_angle;
    }
}

} // namespace osculate::mesh
