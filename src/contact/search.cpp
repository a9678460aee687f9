#include "osculate/contact/search.hpp"

#include "contact/box_tree.hpp"
#include "osculate/contact/facet_patch.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace osculate::contact {

namespace {
/// Distances that differ by less than this fraction of the facet size count as equal.
constexpr double tie = 1e-6;

bool inside(const Vec2& u, int corners) {
    if (corners == 4) return u.cwiseAbs().maxCoeff() <= 1;
    return u.minCoeff() >= 0 && u.sum() <= 1;
}

FacetHit nothing() {
    FacetHit none;
    none.distance = std::numeric_limits<double>::max();
    return none;
}

/// Natural coordinates of the point at fraction t of edge b of a facet.
Vec2 on_edge(int corners, int b, double t) {
    static const Vec2 square[4] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    static const Vec2 triangle[3] = {{0, 0}, {1, 0}, {0, 1}};
    const Vec2* corner = corners == 4 ? square : triangle;
    return (1 - t) * corner[b] + t * corner[(b + 1) % corners];
}

/// Whether the facets that count end at an edge.
bool ends_at(const mesh::HalfEdgeSurface& surface, Index half_edge, const FacetSearch::Choice& counts) {
    if (surface.is_boundary_edge(half_edge)) return true;
    return counts && !counts(surface.half_edges()[surface.half_edges()[half_edge].twin].facet);
}

/// How far s lies past the boundary edges that meet in a vertex, the farthest of them. A point over the fold between two
/// facets that end there lies beyond the edges of both, but not past the end of the surface.
double past_boundary(const mesh::HalfEdgeSurface& surface, Index vertex, const Vec3& s, const std::vector<Vec3>& x,
                     const FacetSearch::Choice& counts) {
    double farthest = -std::numeric_limits<double>::max();
    for (const Index facet : surface.vertex_facets(vertex)) {
        if (counts && !counts(facet)) continue;
        const auto v = surface.facet_vertices(facet);
        const std::size_t n = v.size();
        for (std::size_t c = 0; c < n; ++c) {
            const Vec3 &a = x[v[c]], &b = x[v[(c + 1) % n]], &before = x[v[(c + n - 1) % n]];
            if ((v[c] != vertex && v[(c + 1) % n] != vertex) ||
                !ends_at(surface, surface.first_half_edge(facet) + static_cast<Index>(c), counts))
                continue;
            const Vec3 along = b - a, normal = along.cross(before - a);
            farthest = std::max(farthest, along.cross(normal).normalized().dot(s - x[vertex]));
        }
    }
    return farthest;
}
} // namespace

struct FacetSearch::Tree {
    bgi::rtree<Leaf, bgi::rstar<16>> boxes;
};

FacetSearch::FacetSearch(const mesh::HalfEdgeSurface& surface) : surface_(&surface) {
    Neighbours neighbours;
    for (Index f = 0; f < surface.facet_count(); ++f) {
        const std::vector<Index> around = surface.vertex_neighbours(f);
        neighbours.facet.insert(neighbours.facet.end(), around.begin(), around.end());
        neighbours.start.push_back(static_cast<Index>(neighbours.facet.size()));
    }
    neighbours_ = std::make_shared<const Neighbours>(std::move(neighbours));
    rules_ = std::make_shared<const Rules>();
}

FacetSearch::FacetSearch(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const Vec3& about)
    : FacetSearch(FacetSearch(surface), X, about) {}

FacetSearch::FacetSearch(const FacetSearch& other, const std::vector<Vec3>& X, const Vec3& about) : FacetSearch(other) {
    Rules rules;
    for (Index f = 0; f < surface_->facet_count(); ++f) {
        const auto vertices = surface_->facet_vertices(f);
        Vec3 centre = Vec3::Zero(), area = Vec3::Zero();
        for (std::size_t b = 0; b < vertices.size(); ++b) {
            const Vec3 here = X[vertices[b]] - about, next = X[vertices[(b + 1) % vertices.size()]] - about;
            centre += here / static_cast<double>(vertices.size());
            area += here.cross(next);
        }
        rules.centre.push_back(centre);
        rules.normal.push_back(area.normalized());
    }
    rules_ = std::make_shared<const Rules>(std::move(rules));
}

FacetHit FacetSearch::best_of(std::vector<FacetHit>& hits) const {
    FacetHit best;
    best.distance = std::numeric_limits<double>::max();
    for (const FacetHit& hit : hits)
        if (hit.distance < best.distance || (hit.distance == best.distance && hit.facet < best.facet)) best = hit;
    const std::vector<Vec3>&centre = rules_->centre, &normal = rules_->normal;
    if (best.facet < 0 || centre.empty()) return best;
    // what is equal but for round-off is told apart all at once: one by one, the order would decide
    const double size = surface_->facet_size(best.facet);
    std::erase_if(hits, [&](const FacetHit& hit) { return hit.distance > best.distance + tie * size; });
    double nearest = std::numeric_limits<double>::max();
    for (const FacetHit& hit : hits) nearest = std::min(nearest, centre[hit.facet].norm());
    std::erase_if(hits, [&](const FacetHit& hit) { return centre[hit.facet].norm() > nearest + tie * size; });
    const auto turns = [&](const FacetHit& a, const FacetHit& b) {
        return centre[a.facet].cross(centre[b.facet]).dot(normal[a.facet] + normal[b.facet]) > tie * size * size;
    };
    const FacetHit* lowest = &hits.front();
    for (const FacetHit& a : hits) {
        if (std::ranges::all_of(hits, [&](const FacetHit& b) { return b.facet == a.facet || turns(a, b); })) return a;
        if (a.facet < lowest->facet) lowest = &a;
    }
    return *lowest; // symmetric: nothing but its number tells a facet apart
}

FacetSearch::~FacetSearch() = default;
FacetSearch::FacetSearch(const FacetSearch& other)
    : surface_(other.surface_), neighbours_(other.neighbours_), rules_(other.rules_) {}
FacetSearch::FacetSearch(FacetSearch&&) noexcept = default;
FacetSearch& FacetSearch::operator=(FacetSearch&&) noexcept = default;

FacetHit FacetSearch::closest_on(Index facet, const Vec3& s, const std::vector<Vec3>& x, const Choice& counts) const {
    const auto vertices = surface_->facet_vertices(facet);
    const int corners = static_cast<int>(vertices.size());
    Eigen::Matrix<double, 4, 3> storage;
    for (int b = 0; b < corners; ++b) storage.row(b) = x[vertices[b]].transpose();
    const FacetPatch patch(corners);
    const MatrixX3 corner = storage.topRows(corners);
    FacetHit hit;
    hit.facet = facet;
    const auto foot = patch.foot(s, corner, patch.centre());
    if (foot && inside(foot->u, corners)) {
        hit.u = foot->u;
        hit.distance = (s - foot->point.X).norm();
        return hit;
    }
    hit.distance = std::numeric_limits<double>::max();
    int edge = 0;
    double fraction = 0;
    for (int b = 0; b < corners; ++b) {
        const Vec3 a = corner.row(b).transpose(), d = corner.row((b + 1) % corners).transpose() - a;
        if (d.isZero(0)) continue; // its neighbours end there
        const double t = std::clamp(d.dot(s - a) / d.squaredNorm(), 0.0, 1.0);
        const double distance = (s - a - t * d).norm();
        if (distance < hit.distance) {
            hit.distance = distance;
            edge = b;
            fraction = t;
        }
    }
    hit.u = on_edge(corners, edge, fraction);
    const PatchPoint p = patch.point(hit.u, corner);
    const Vec3 d = s - p.X, n = p.normal();
    hit.overhang = (d - n * n.dot(d)).norm();
    const auto on_boundary = [&](int b) {
        const Index v = vertices[b % corners];
        return surface_->is_boundary_vertex(v) || (counts && !std::ranges::all_of(surface_->vertex_facets(v), counts));
    };
    hit.boundary = fraction == 0   ? on_boundary(edge)
                   : fraction == 1 ? on_boundary(edge + 1)
                                   : ends_at(*surface_, surface_->first_half_edge(facet) + edge, counts);
    hit.limited = counts && hit.boundary;
    if (hit.boundary && fraction > 0 && fraction < 1)
        hit.beyond = hit.overhang;
    else if (hit.boundary)
        hit.beyond =
            std::max(0.0, past_boundary(*surface_, vertices[(edge + (fraction == 1)) % corners], s, x, counts));
    return hit;
}

void FacetSearch::build(const std::vector<Vec3>& x) {
    std::vector<Leaf> leaves;
    leaves.reserve(static_cast<std::size_t>(surface_->facet_count()));
    for (Index f = 0; f < surface_->facet_count(); ++f) {
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
        for (const Index v : surface_->facet_vertices(f)) {
            low = low.cwiseMin(x[v]);
            high = high.cwiseMax(x[v]);
        }
        leaves.emplace_back(Box(to_point(low), to_point(high)), f);
    }
    tree_ = std::make_unique<Tree>();
    tree_->boxes = decltype(tree_->boxes)(leaves.begin(), leaves.end());
}

FacetHit FacetSearch::global(const Vec3& s, const std::vector<Vec3>& x) const {
    return global(s, x, std::numeric_limits<double>::max(), {});
}

FacetHit FacetSearch::global(const Vec3& s, const std::vector<Vec3>& x, double farthest, const Choice& counts) const {
    if (!tree_) return nothing();
    // the k nearest boxes, k doubled until the farthest of them is farther than the best facet: an incremental query for
    // all boxes in order of distance would sort far more of them than it hands out
    const Point at = to_point(s);
    const auto every = static_cast<unsigned>(surface_->facet_count());
    std::vector<Leaf> nearest;
    std::vector<FacetHit> hits;
    for (unsigned k = 8;; k *= 2) {
        nearest.clear();
        hits.clear();
        tree_->boxes.query(bgi::nearest(at, std::min(k, every)), std::back_inserter(nearest));
        double reached = 0, reach = farthest;
        for (const auto& [box, facet] : nearest) {
            const double away = bg::distance(at, box);
            reached = std::max(reached, away);
            if (away > reach || (counts && !counts(facet))) continue;
            const FacetHit hit = closest_on(facet, s, x, counts);
            if (hit.distance > reach) continue;
            hits.push_back(hit);
            reach = std::min(reach, hits.back().distance + tie * surface_->facet_size(facet));
        }
        if (k >= every || reached > reach) return best_of(hits);
    }
}

FacetHit FacetSearch::track(const Vec3& s, Index from, const std::vector<Vec3>& x, double hysteresis,
                            const Choice& counts) const {
    if (from < 0) return nothing();
    const FacetHit old = closest_on(from, s, x, counts);
    FacetHit best = old;
    std::vector<FacetHit> hits;
    for (Index moves = 0; moves < surface_->facet_count(); ++moves) {
        const Index centre = best.facet;
        hits.assign(1, best);
        double reach = best.distance + tie * surface_->facet_size(centre);
        for (Index k = neighbours_->start[centre]; k < neighbours_->start[centre + 1]; ++k) {
            const Index facet = neighbours_->facet[k];
            if (counts && !counts(facet)) continue;
            // no point of the facet is closer than the box of its corners
            Vec3 low = x[surface_->facet_vertices(facet)[0]], high = low;
            for (const Index v : surface_->facet_vertices(facet)) {
                low = low.cwiseMin(x[v]);
                high = high.cwiseMax(x[v]);
            }
            if ((low - s).cwiseMax(s - high).cwiseMax(0).squaredNorm() > reach * reach) continue;
            hits.push_back(closest_on(facet, s, x, counts));
            reach = std::min(reach, hits.back().distance + tie * surface_->facet_size(facet));
        }
        best = best_of(hits);
        if (best.facet < 0) return old; // no distances are numbers
        if (best.facet == centre) break;
    }
    const double margin = hysteresis * surface_->facet_size(from);
    return old.overhang <= margin && old.distance <= best.distance + margin ? old : best;
}

} // namespace osculate::contact
