#include "osculate/contact/mortar.hpp"

#include "contact/facet_rule.hpp"
#include "osculate/core/parallel.hpp"
#include "osculate/core/rounded_sum.hpp"
#include "osculate/core/without_traps.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace osculate::contact {

namespace {

/// Facets that lie over the master with less than this part of their area do not count: the dual functions of a sliver
/// are huge.
constexpr double least_cover = 0.05;

} // namespace

Mortar::Mortar(const mesh::HalfEdgeSurface& surface, const std::vector<SlaveFacet>& facets, const std::vector<Vec3>& S,
               std::vector<Mat3> in_plane, const SmoothSlave* smooth)
    : surface_(surface), incident_(S.size()), in_plane_(std::move(in_plane)), carriers_(S.size(), 0),
      normal_length_(S.size(), 0.0) {
    // master facets near the slave's size need few points; smaller ones must not slip through between the points
    double size = 0;
    for (Index f = 0; f < surface.facet_count(); ++f) size += surface.facet_size(f) / surface.facet_count();
    for (const SlaveFacet& corners : facets) {
        Facet& facet = facets_.emplace_back();
        facet.corners = corners;
        for (int c = 0; c < corners.count; ++c) {
            facet.X.push_back(S[static_cast<std::size_t>(corners.node[static_cast<std::size_t>(c)])]);
            incident_[static_cast<std::size_t>(corners.node[static_cast<std::size_t>(c)])].push_back(
                {static_cast<Index>(facets_.size()) - 1, c});
        }
        const double ratio = std::sqrt(SlavePlane(facet.X).area()) / size;
        constexpr int fewest = 2, most = 8;
        const int n = std::clamp(static_cast<int>(std::ceil(ratio - 1e-6)) + 1, fewest, most);
        for (const RulePoint& q : facet_rule(corners.count, n)) {
            GapPoint& point = facet.gap_points.emplace_back();
            point.xi = q.xi;
            point.N = shape(corners.count, q.xi).N;
            point.weight = q.weight * reference_area(facet, q.xi);
            facet.area += point.weight;
            interpolate(point, facet, static_cast<Index>(facets_.size()) - 1, smooth);
            for (const Share& share : point.shares) facet.gap_slaves.push_back(share.slave);
        }
        sort_unique(facet.gap_slaves);
    }
}

double Mortar::reference_area(const Facet& facet, const Vec2& xi) {
    const Shape N = shape(facet.corners.count, xi);
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    for (std::size_t c = 0; c < facet.X.size(); ++c) {
        a += N.N_a(static_cast<Index>(c), 0) * facet.X[c];
        b += N.N_a(static_cast<Index>(c), 1) * facet.X[c];
    }
    return a.cross(b).norm();
}

std::vector<Vec3> Mortar::corners(const Facet& facet, std::span<const Vec3> s) {
    std::vector<Vec3> x;
    for (const Index node : facet.corners) x.push_back(s[static_cast<std::size_t>(node)]);
    return x;
}

void Mortar::interpolate(GapPoint& q, const Facet& facet, Index number, const SmoothSlave* smooth) {
    Vec3 chord = Vec3::Zero();
    for (std::size_t c = 0; c < facet.X.size(); ++c) chord += q.N(static_cast<Index>(c)) * facet.X[c];
    ContactPoint on_surface;
    if (smooth != nullptr) {
        FacetHit hit;
        hit.facet = number;
        hit.u = q.xi;
        smooth->shape->evaluate(chord, hit, smooth->X, on_surface);
    }
    std::map<Index, Mat3> C;
    if (!on_surface.found)
        for (int c = 0; c < facet.corners.count; ++c)
            C[facet.corners.node[static_cast<std::size_t>(c)]] = q.N(c) * Mat3::Identity();
    else
        for (std::size_t i = 0; i < on_surface.nodes.size(); ++i) {
            const auto v = static_cast<std::size_t>(on_surface.nodes[i]);
            const double weight = on_surface.weights(static_cast<Index>(i));
            C.try_emplace(smooth->node[v], Mat3::Zero()).first->second += weight * smooth->image[v].M;
            q.offset += weight * smooth->image[v].t;
            q.mirrored = q.mirrored || !smooth->image[v].M.isIdentity(0) || !smooth->image[v].t.isZero(0);
        }
    for (const auto& [slave, share] : C) q.shares.push_back({slave, share});
}

Vec3 Mortar::position(const GapPoint& q, std::span<const Vec3> s, Vec3* tail) {
    Vec3 at = q.offset;
    if (q.mirrored) {
        for (const Share& share : q.shares) at += share.C * s[static_cast<std::size_t>(share.slave)];
        return at;
    }
    // from one of the nodes: round-off of the products must not grow with the distance from the origin
    const Vec3& origin = s[static_cast<std::size_t>(q.shares.front().slave)];
    Vec3 from_origin = Vec3::Zero();
    for (const Share& share : q.shares) from_origin += share.C * (s[static_cast<std::size_t>(share.slave)] - origin);
    const Vec3 rounded = rounded_off(origin, from_origin, at);
    if (tail != nullptr) *tail = rounded;
    return at;
}

std::unique_ptr<Discretisation> Mortar::clone() const {
    auto other = std::make_unique<Mortar>(surface_, std::vector<SlaveFacet>{}, std::vector<Vec3>{}, in_plane_);
    other->facets_ = facets_;
    for (Facet& facet : other->facets_)
        for (GapPoint& q : facet.gap_points) q.point.trace.reset(); // refers to our placement
    other->incident_ = incident_;
    other->carriers_ = carriers_;
    other->normal_length_ = normal_length_;
    return other;
}

void Mortar::begin(const PairPositions& at, const FacetTracking& tracking, int threads) {
    parallel_for(threads, static_cast<Index>(facets_.size()), [&](Index begin, Index end) {
        for (Index f = begin; f < end; ++f) {
            Facet& facet = facets_[static_cast<std::size_t>(f)];
            for (GapPoint& q : facet.gap_points) {
                const Index from = tracking.facet[static_cast<std::size_t>(facet.corners.node[0])];
                q.facet = at.search.track(position(q, at.slaves), from, at.vertices, 0).facet;
                q.changes = 0;
            }
        }
    });
}

int Mortar::evaluate(const PairPositions& at, FacetTracking& tracking, std::vector<ContactPoint>& points, int threads) {
    const auto count = static_cast<Index>(facets_.size());
    parallel_for(threads, count, [&](Index begin, Index end) {
        for (Index f = begin; f < end; ++f)
            for (GapPoint& q : facets_[static_cast<std::size_t>(f)].gap_points) {
                const Vec3 s = position(q, at.slaves);
                q.hit = q.changes < tracking.changes_before_latch
                            ? at.search.track(s, q.facet, at.vertices, tracking.hysteresis)
                            : at.search.closest_on(q.facet, s, at.vertices);
                q.hit.latched = q.changes >= tracking.changes_before_latch;
            }
    });
    int changed = 0;
    std::vector<FacetHit> hits;
    for (Facet& facet : facets_)
        for (GapPoint& q : facet.gap_points) {
            if (q.hit.facet != q.facet) {
                q.changes += q.facet < 0 || q.hit.facet < 0 || at.master.tells_apart(q.facet, q.hit.facet);
                q.facet = q.hit.facet;
                ++changed;
            }
            hits.push_back(q.hit);
        }
    at.master.place(hits, at.vertices, threads, placement_);
    parallel_for(threads, count, [&](Index begin, Index end) {
        for (Index f = begin; f < end; ++f) {
            Facet& facet = facets_[static_cast<std::size_t>(f)];
            for (GapPoint& q : facet.gap_points)
                at.master.evaluate(position(q, at.slaves, &q.tail), q.hit, at.vertices, q.point, nullptr,
                                   placement_.get());
            find_overlaps(facet, at);
            make_duals(facet);
        }
    });
    parallel_for(threads, static_cast<Index>(points.size()), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) {
            points[static_cast<std::size_t>(j)].facet = tracking.facet[static_cast<std::size_t>(j)];
            gather(j, at.vertices, points[static_cast<std::size_t>(j)]);
        }
    });
    return changed;
}

void Mortar::find_overlaps(Facet& facet, const PairPositions& at) const {
    facet.overlaps.clear();
    const std::vector<Vec3>& x = at.vertices;
    const std::vector<Vec3> corner = corners(facet, at.slaves);
    const SlavePlane plane(corner);
    // from the facets below its points on to their neighbours, as long as they overlap
    std::vector<Index> waiting, seen;
    for (const GapPoint& q : facet.gap_points)
        if (q.facet >= 0) waiting.push_back(q.facet);
    sort_unique(waiting);
    seen = waiting;
    while (!waiting.empty()) {
        const Index candidate = waiting.back();
        waiting.pop_back();
        std::vector<Vec3> master;
        for (const Index v : surface_.facet_vertices(candidate)) master.push_back(x[static_cast<std::size_t>(v)]);
        auto points = plane.overlap(master);
        if (points.empty()) continue;
        for (OverlapPoint& q : points) { // from the area in the plane to that of the reference facet
            const Shape N = shape(facet.corners.count, q.xi);
            Vec3 a = Vec3::Zero(), b = Vec3::Zero();
            for (std::size_t c = 0; c < corner.size(); ++c) {
                a += N.N_a(static_cast<Index>(c), 0) * corner[c];
                b += N.N_a(static_cast<Index>(c), 1) * corner[c];
            }
            q.area *= reference_area(facet, q.xi) / plane.normal().dot(a.cross(b));
        }
        facet.overlaps.push_back({candidate, std::move(points)});
        for (const Index v : surface_.facet_vertices(candidate))
            for (const Index next : surface_.vertex_facets(v)) {
                const auto place = std::lower_bound(seen.begin(), seen.end(), next);
                if (place != seen.end() && *place == next) continue;
                seen.insert(place, next);
                waiting.push_back(next);
            }
    }
    std::sort(facet.overlaps.begin(), facet.overlaps.end(),
              [](const Overlap& a, const Overlap& b) { return a.facet < b.facet; });
}

void Mortar::make_duals(Facet& facet) const {
    const int corners = facet.corners.count;
    double covered = 0;
    Square M;
    const auto clear = [&] {
        M = Square::Zero(corners, corners);
        covered = 0;
    };
    const auto add = [&](const Row4& N, double weight) {
        M += weight * N.head(corners) * N.head(corners).transpose();
        covered += weight;
    };
    const auto finish = [&](Dual& dual) {
        dual.usable = covered > least_cover * facet.area;
        dual.D.setZero();
        if (!dual.usable) return;
        dual.D.head(corners) = M.rowwise().sum();
        const WithoutTraps singular; // where it is, that is seen below
        dual.A = dual.D.head(corners).asDiagonal() * M.inverse().eval();
        // too few points, or points in a row
        dual.usable = dual.A.allFinite() && dual.A.cwiseAbs().maxCoeff() * least_cover * least_cover < 1;
    };
    clear();
    for (const GapPoint& q : facet.gap_points)
        if (q.point.found) add(q.N, q.weight);
    finish(facet.gap_dual);
    clear();
    for (Overlap& overlap : facet.overlaps)
        for (const OverlapPoint& q : overlap.points) add(shape(corners, q.xi).N, q.area);
    finish(facet.weight_dual);
}

double Mortar::gap_area(Index j) const {
    double sum = 0;
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)]) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (facet.gap_dual.usable) sum += facet.gap_dual.D(c);
    }
    return sum;
}

double Mortar::weight_area(Index j) const {
    double sum = 0;
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)]) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (facet.weight_dual.usable) sum += facet.weight_dual.D(c);
    }
    return sum;
}

void Mortar::gather(Index j, const std::vector<Vec3>& x, ContactPoint& point) {
    point.found = point.behind = false;
    point.nodes.clear();
    carriers_[static_cast<std::size_t>(j)] = 0;
    const double by_gap = gap_area(j), by_weight = weight_area(j);
    double deepest_gap = 0;
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)])
        for (const GapPoint& q : facets_[static_cast<std::size_t>(f)].gap_points)
            if (q.point.behind) {
                point.behind = true;
                deepest_gap = std::min(deepest_gap, q.point.gap);
            }
    if (!(by_gap > 0) || !(by_weight > 0)) {
        if (point.behind) point.gap = deepest_gap;
        return;
    }
    point.behind = false;

    // gap and normal
    double g = 0;
    Vec3 N = Vec3::Zero();
    std::vector<Index> carrying, sensing, slaves;
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)]) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        for (const Index k : facet.corners)
            if (k != j) slaves.push_back(surface_.vertex_count() + k);
        for (const Index k : facet.gap_slaves)
            if (k != j) slaves.push_back(surface_.vertex_count() + k);
        if (facet.weight_dual.usable)
            for (const Overlap& overlap : facet.overlaps) {
                const auto v = surface_.facet_vertices(overlap.facet);
                carrying.insert(carrying.end(), v.begin(), v.end());
            }
        if (!facet.gap_dual.usable) continue;
        const int n = facet.corners.count;
        for (const GapPoint& q : facet.gap_points) {
            if (!q.point.found) continue;
            const double psi = q.weight * facet.gap_dual.A.row(c).dot(q.N.head(n));
            g += psi * q.point.gap;
            N += psi * q.point.normal;
            sensing.insert(sensing.end(), q.point.nodes.begin(), q.point.nodes.end());
        }
    }
    if (!in_plane_.empty()) N = in_plane_[static_cast<std::size_t>(j)] * N;
    N /= by_gap;
    const double length = N.norm();
    if (!(length > 0.1)) return; // normals that cancel
    point.found = true;
    point.gap = g / by_gap;
    point.normal = N / length;
    normal_length_[static_cast<std::size_t>(j)] = length;

    // who takes part: carriers of force first
    sort_unique(carrying);
    sort_unique(sensing);
    sort_unique(slaves);
    point.nodes = carrying;
    std::set_difference(sensing.begin(), sensing.end(), carrying.begin(), carrying.end(),
                        std::back_inserter(point.nodes));
    point.nodes.insert(point.nodes.end(), slaves.begin(), slaves.end());
    carriers_[static_cast<std::size_t>(j)] = static_cast<Index>(carrying.size());

    point.weights = Vector::Zero(static_cast<Index>(point.nodes.size()));
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)]) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (!facet.weight_dual.usable) continue;
        const int n = facet.corners.count;
        for (const Overlap& overlap : facet.overlaps) {
            const auto vertices = surface_.facet_vertices(overlap.facet);
            Row4 sum = Row4::Zero();
            for (const OverlapPoint& q : overlap.points)
                sum += q.area * facet.weight_dual.A.row(c).dot(shape(n, q.xi).N.head(n)) *
                       shape(static_cast<int>(vertices.size()), q.u).N;
            for (std::size_t i = 0; i < vertices.size(); ++i)
                point.weights(place_in(carrying, vertices[i])) += sum(static_cast<Index>(i)) / by_weight;
        }
    }
    point.pressing = -point.weights * point.normal.transpose();
    point.foot.setZero();
    for (std::size_t i = 0; i < carrying.size(); ++i)
        point.foot += point.weights(static_cast<Index>(i)) * x[static_cast<std::size_t>(carrying[i])];
}

Index Mortar::carriers(Index j, const ContactPoint&) const {
    return carriers_[static_cast<std::size_t>(j)];
}

void Mortar::force_change(const ContactPoint&, const Vec3& lambda, const Vec3&, std::span<const double> dweights,
                          const double*, double* df) const {
    // p_i = -W_i n: what is left is f_i = -W_i lambda
    for (std::size_t i = 0; i < dweights.size(); ++i) Eigen::Map<Vec3>(df + 3 * i) = -dweights[i] * lambda;
}

void Mortar::weights_along(const ContactPoint&, const ContactVariation& variation, const Vector& dy, Vector& dweights,
                           Vector&) const {
    dweights.noalias() = variation.dweights * dy;
}

double Mortar::gap_rounded_off(Index j, const PairPositions& at, const ContactPoint&) const {
    double lost = 0;
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)]) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (!facet.gap_dual.usable) continue;
        for (const GapPoint& q : facet.gap_points) {
            if (!q.point.found) continue;
            Vec3 tail = q.tail;
            for (const Share& share : q.shares) tail += share.C * at.slave_tails[static_cast<std::size_t>(share.slave)];
            double of_gap = q.point.normal.dot(tail);
            for (std::size_t i = 0; i < q.point.nodes.size(); ++i)
                of_gap += q.point.pressing.row(static_cast<Index>(i))
                              .dot(at.vertex_tails[static_cast<std::size_t>(q.point.nodes[i])]);
            lost += q.weight * facet.gap_dual.A.row(c).dot(q.N.head(facet.corners.count)) * of_gap;
        }
    }
    return lost / gap_area(j);
}

void Mortar::follow(const FacetHit&, const ContactPoint& point, Index carried, std::vector<Index>& vertices,
                    std::vector<double>& shares) const {
    vertices.assign(point.nodes.begin(), point.nodes.begin() + carried);
    shares.assign(point.weights.begin(), point.weights.begin() + carried);
}

} // namespace osculate::contact
