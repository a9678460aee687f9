#include "contact/merge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace osculate::contact {

namespace {

constexpr double same_node = 0.01; ///< of the mean distance between nearest nodes, as in RpimPatch::fit

void make_unique(std::vector<Index>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Mean distance to the nearest other vertex over those of the facets around a vertex, `ring` deep.
double node_distance(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, Index vertex, int ring) {
    std::vector<Index> facets(surface.vertex_facets(vertex).begin(), surface.vertex_facets(vertex).end()), nodes;
    for (int k = 1; k < ring; ++k) {
        std::vector<Index> wider = facets;
        for (const Index f : facets) {
            const auto next = surface.vertex_neighbours(f);
            wider.insert(wider.end(), next.begin(), next.end());
        }
        make_unique(wider);
        facets = std::move(wider);
    }
    for (const Index f : facets) {
        const auto v = surface.facet_vertices(f);
        nodes.insert(nodes.end(), v.begin(), v.end());
    }
    make_unique(nodes);
    double sum = 0;
    for (const Index a : nodes) {
        double nearest = std::numeric_limits<double>::max();
        for (const Index b : nodes)
            if (a != b) nearest = std::min(nearest, (X[a] - X[b]).squaredNorm());
        sum += std::sqrt(nearest);
    }
    return sum / static_cast<double>(nodes.size());
}

/// Per vertex the lowest one of its cluster of near duplicates.
std::vector<Index> kept_vertices(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, int ring) {
    std::vector<Index> kept(static_cast<std::size_t>(surface.vertex_count()));
    std::iota(kept.begin(), kept.end(), 0);
    const auto lowest = [&](Index v) {
        while (kept[v] != v) v = kept[v];
        return v;
    };
    const auto for_each_pair = [&](auto&& f) { // edges and diagonals
        for (Index facet = 0; facet < surface.facet_count(); ++facet) {
            const auto v = surface.facet_vertices(facet);
            for (std::size_t a = 0; a < v.size(); ++a)
                for (std::size_t b = 0; b < a; ++b) f(v[a], v[b], (X[v[a]] - X[v[b]]).norm());
        }
    };
    double longest = 0;
    for_each_pair([&](Index, Index, double distance) { longest = std::max(longest, distance); });
    for_each_pair([&](Index a, Index b, double distance) {
        if (distance >= same_node * longest) return; // no mean distance is longer
        if (distance >= same_node * std::max(node_distance(surface, X, a, ring), node_distance(surface, X, b, ring)))
            return;
        const Index one = lowest(a), other = lowest(b);
        kept[std::max(one, other)] = std::min(one, other);
    });
    for (Index v = 0; v < surface.vertex_count(); ++v) kept[v] = lowest(v);
    return kept;
}

/// Corners that are left of a facet; nothing where they no longer span an area.
std::optional<mesh::Facet> collapsed(const mesh::Facet& facet, std::span<const Index> vertices,
                                     const std::vector<Index>& kept) {
    mesh::Facet result = facet;
    result.nodes.fill(-1);
    result.count = 0;
    const std::size_t n = vertices.size();
    for (std::size_t c = 0; c < n; ++c) {
        const Index v = kept[vertices[c]];
        if (v == kept[vertices[(c + 1) % n]]) continue;
        if (std::find(result.begin(), result.end(), v) != result.end()) return std::nullopt; // both ends of a diagonal
        result.nodes[static_cast<std::size_t>(result.count++)] = v;
    }
    if (result.count < 3) return std::nullopt;
    return result;
}

/// A feature angle that tells the features of the surface from its smooth edges: the default, where it does.
double feature_angle(const mesh::HalfEdgeSurface& surface, const std::vector<mesh::Facet>& facets,
                     const std::vector<Vec3>& X) {
    double smooth = 0, feature = std::numeric_limits<double>::max();
    for (Index h = 0; h < static_cast<Index>(surface.half_edges().size()); ++h) {
        const mesh::HalfEdge& edge = surface.half_edges()[h];
        if (edge.twin < 0) continue;
        const Vec3 a = mesh::facet_area_vector(facets[edge.facet], X);
        const Vec3 b = mesh::facet_area_vector(facets[surface.half_edges()[edge.twin].facet], X);
        const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
        if (surface.is_feature_edge(h))
            feature = std::min(feature, angle);
        else
            smooth = std::max(smooth, angle);
    }
    if (mesh::default_feature_angle < smooth) return smooth;
    return mesh::default_feature_angle < feature ? mesh::default_feature_angle : std::midpoint(smooth, feature);
}

/// Facets in vertex numbers.
std::vector<mesh::Facet> local_facets(const mesh::HalfEdgeSurface& surface) {
    std::vector<mesh::Facet> facets = surface.facets();
    for (Index f = 0; f < surface.facet_count(); ++f) {
        const auto v = surface.facet_vertices(f);
        std::copy(v.begin(), v.end(), facets[f].nodes.begin());
    }
    return facets;
}

/// Of the surviving facets nearest to f, the one that holds most of what is left of it.
Index find_host(const mesh::HalfEdgeSurface& surface, Index f, const std::vector<Index>& kept,
                const std::vector<Index>& became) {
    const auto own = surface.facet_vertices(f);
    const auto shared = [&](Index g) {
        const auto v = surface.facet_vertices(g);
        return std::count_if(v.begin(), v.end(), [&](Index w) {
            return std::any_of(own.begin(), own.end(), [&](Index o) { return kept[o] == kept[w]; });
        });
    };
    std::vector<Index> near{f};
    for (std::size_t before = 0; before < near.size();) {
        before = near.size();
        std::vector<Index> wider = near;
        for (const Index g : near) {
            const auto next = surface.vertex_neighbours(g);
            wider.insert(wider.end(), next.begin(), next.end());
        }
        make_unique(wider);
        near = std::move(wider);
        Index best = -1;
        for (const Index g : near)
            if (became[g] >= 0 && (best < 0 || shared(g) > shared(best))) best = g;
        if (best >= 0) return became[best];
    }
    return -1;
}

} // namespace

std::unique_ptr<MergedSurface> merged(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, int ring) {
    const std::vector<Index> kept = kept_vertices(surface, X, ring);
    Index same = 0;
    for (Index v = 0; v < surface.vertex_count(); ++v) same += kept[v] == v ? 1 : 0;
    if (same == surface.vertex_count()) return nullptr;
    const std::vector<mesh::Facet> before = local_facets(surface);
    std::vector<mesh::Facet> facets;
    std::vector<Index> became;
    for (Index f = 0; f < surface.facet_count(); ++f) {
        const auto facet = collapsed(before[f], surface.facet_vertices(f), kept);
        became.push_back(facet ? static_cast<Index>(facets.size()) : -1);
        if (facet) facets.push_back(*facet);
    }
    std::vector<Index> host = became;
    for (Index f = 0; f < surface.facet_count(); ++f)
        if (host[f] < 0 && (host[f] = find_host(surface, f, kept, became)) < 0) return nullptr;
    try {
        mesh::HalfEdgeSurface topology(facets, X, feature_angle(surface, before, X));
        std::vector<Index> vertex = topology.vertex_nodes();
        std::vector<Vec3> positions;
        for (const Index v : vertex) positions.push_back(X[v]);
        return std::make_unique<MergedSurface>(
            MergedSurface{std::move(topology), std::move(vertex), std::move(host), std::move(positions)});
    } catch (const std::runtime_error&) { // not a surface any more: its nodes belong to different parts of it
        return nullptr;
    }
}

} // namespace osculate::contact
