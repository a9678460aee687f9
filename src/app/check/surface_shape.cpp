#include "app/check/surface_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace osculate::app {

namespace {

/// A facet of the master with local vertices in place of nodes.
mesh::Facet local_facet(const mesh::HalfEdgeSurface& surface, Index facet) {
    mesh::Facet result;
    for (const Index v : surface.facet_vertices(facet)) result.nodes[static_cast<std::size_t>(result.count++)] = v;
    return result;
}

std::vector<Vec3> master_normals(const model::ContactPair& pair, const std::vector<Vec3>& vertices) {
    std::vector<Vec3> normals;
    for (Index f = 0; f < pair.surface().facet_count(); ++f)
        normals.push_back(mesh::facet_normal(local_facet(pair.surface(), f), vertices));
    return normals;
}

/// One of those that are alike.
std::vector<Vec3> distinct(const std::vector<Vec3>& normals) {
    constexpr double cells = 20; // a unit: 3 degrees
    std::map<std::array<long, 3>, Vec3> found;
    for (const Vec3& n : normals)
        found.try_emplace({std::lround(cells * n.x()), std::lround(cells * n.y()), std::lround(cells * n.z())}, n);
    std::vector<Vec3> result;
    for (const auto& [cell, n] : found) result.push_back(n);
    return result;
}

/// Numbers of the parts into which sharp edges cut a surface, by facet.
std::vector<Index> smooth_parts(const mesh::HalfEdgeSurface& surface) {
    std::vector<Index> part(static_cast<std::size_t>(surface.facet_count()), -1), left;
    Index parts = 0;
    for (Index seed = 0; seed < surface.facet_count(); ++seed) {
        if (part[seed] >= 0) continue;
        left.push_back(seed);
        part[seed] = parts;
        while (!left.empty()) {
            const Index f = left.back();
            left.pop_back();
            const Index first = surface.first_half_edge(f);
            for (Index h = first; h < first + static_cast<Index>(surface.facet_vertices(f).size()); ++h) {
                if (surface.is_boundary_edge(h) || surface.is_feature_edge(h)) continue;
                const Index beside = surface.half_edges()[surface.half_edges()[h].twin].facet;
                if (part[beside] >= 0) continue;
                part[beside] = parts;
                left.push_back(beside);
            }
        }
        ++parts;
    }
    return part;
}

} // namespace

std::vector<std::size_t> side_facets(const model::ContactPair& pair, const std::vector<Vec3>& X) {
    constexpr double sideways = -0.3; // cosine between the two normals: 107 degrees
    const std::vector<mesh::Facet>& facets = pair.slaves().facets;
    std::vector<Index> part;
    try {
        part = smooth_parts(mesh::HalfEdgeSurface(facets, X));
    } catch (const std::runtime_error&) {
        return {}; // slaves need not be manifold, and then have no parts
    }
    const std::vector<Vec3> masters = distinct(master_normals(pair, pair.vertices(X)));
    std::map<Index, bool> looks; // part
    for (std::size_t f = 0; f < facets.size(); ++f) {
        bool& at_master = looks.try_emplace(part[f], false).first->second;
        if (at_master) continue;
        const Vec3 n = mesh::facet_normal(facets[f], X);
        at_master = std::ranges::any_of(masters, [&](const Vec3& m) { return n.dot(m) < sideways; });
    }
    std::vector<std::size_t> sides;
    for (std::size_t f = 0; f < facets.size(); ++f)
        if (!looks.at(part[f])) sides.push_back(f);
    if (sides.size() == facets.size()) sides.clear(); // then the sides of the pair are wrong as a whole
    return sides;
}

SharpEdges sharp_edges(const model::ContactPair& pair, const std::vector<Vec3>& X) {
    const mesh::HalfEdgeSurface& surface = pair.surface();
    const std::vector<Vec3> x = pair.vertices(X);
    SharpEdges found;
    for (Index h = 0; h < static_cast<Index>(surface.half_edges().size()); ++h) {
        const mesh::HalfEdge& edge = surface.half_edges()[h];
        if (edge.twin < h || !surface.is_feature_edge(h)) continue; // each edge once
        const Index a = edge.origin, b = surface.half_edges()[edge.next].origin;
        if (pair.own_vertex(a) != a || pair.own_vertex(b) != b) continue; // of a mirror image
        const mesh::Facet here = local_facet(surface, edge.facet),
                          there = local_facet(surface, surface.half_edges()[edge.twin].facet);
        const Vec3 across = mesh::facet_centroid(there, x) - mesh::facet_centroid(here, x);
        const bool convex = across.dot(mesh::facet_normal(here, x)) < 0;
        Index& count = convex ? found.convex : found.concave;
        if (count++ == 0) (convex ? found.first_convex : found.first_concave) = 0.5 * (x[a] + x[b]);
    }
    return found;
}

bool fits(const model::ContactEvaluation& evaluation) {
    const model::ContactPair& pair = evaluation.pair();
    constexpr double near = 2;    // sagittas
    constexpr double turns = 3;   // facets
    constexpr double flat = 1e-3; // rad from facet to facet
    const mesh::HalfEdgeSurface& surface = pair.surface();
    // the facets' normals at the points say all that is needed: on `facets` they are those of the facets
    std::map<Index, Vec3> normal;
    double least = std::numeric_limits<double>::infinity();
    for (Index j = 0; j < pair.size(); ++j)
        if (const contact::ContactPoint& point = evaluation.point(j); point.found) {
            normal.emplace(point.facet, point.normal);
            least = std::min(least, point.gap);
        }
    const auto turn = [&](Index facet) { // to its neighbours, the largest
        double angle = 0;
        for (const Index beside : surface.edge_neighbours(facet))
            if (const auto at = normal.find(beside); at != normal.end())
                angle = std::max(angle, std::acos(std::clamp(at->second.dot(normal.at(facet)), -1.0, 1.0)));
        return angle;
    };
    std::vector<Vec3> alongside;
    double largest = 0; // turn from facet to facet
    std::map<Index, double> turn_of;
    for (const auto& [facet, n] : normal) turn_of[facet] = turn(facet);
    std::map<Index, bool> taken;
    for (Index j = 0; j < pair.size(); ++j) {
        const contact::ContactPoint& point = evaluation.point(j);
        if (!point.found) continue;
        const double angle = turn_of.at(point.facet);
        if (angle < flat || angle > mesh::default_feature_angle) continue;
        const double sagitta = surface.facet_size(point.facet) * angle / 8;
        if (point.gap - least > near * sagitta) continue;
        if (!taken.emplace(point.facet, true).second) continue;
        alongside.push_back(point.normal);
        largest = std::max(largest, angle);
    }
    for (const Vec3& a : alongside)
        if (std::acos(std::clamp(a.dot(alongside.front()), -1.0, 1.0)) > turns * largest) return true;
    return false;
}

} // namespace osculate::app
