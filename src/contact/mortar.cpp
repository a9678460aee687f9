#include "osculate/contact/mortar.hpp"

#include "contact/facet_rule.hpp"
#include "osculate/contact/latch.hpp"
#include "osculate/core/parallel.hpp"
#include "osculate/core/rounded_sum.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

namespace osculate::contact {

namespace {
/// Gaps are averages too, and those over a sliver are far from any of its gaps.
constexpr double least_cover = 0.05;
} // namespace

Mortar::Mortar(const mesh::HalfEdgeSurface& surface, const std::vector<SlaveFacet>& facets, const std::vector<Vec3>& S,
               std::vector<Mat3> in_plane, const SmoothSlave* smooth)
    : surface_(surface), weights_(surface, facets, S, least_cover), in_plane_(std::move(in_plane)),
      carriers_(S.size(), 0), normal_length_(S.size(), 0.0) {
    // master facets near the slave's size need few points; smaller ones must not slip through between the points
    double size = 0;
    for (Index f = 0; f < surface.facet_count(); ++f) size += surface.facet_size(f) / surface.facet_count();
    for (Index f = 0; f < weights_.facet_count(); ++f) {
        const SlaveFacet& corners = weights_.corners(f);
        Facet& facet = facets_.emplace_back();
        facet.corners = corners;
        const double ratio = std::sqrt(SlavePlane(weights_.X(f)).area()) / size;
        constexpr int fewest = 2, most = 8;
        const int n = std::clamp(static_cast<int>(std::ceil(ratio - 1e-6)) + 1, fewest, most);
        for (const RulePoint& q : facet_rule(corners.count, n)) {
            GapPoint& point = facet.gap_points.emplace_back();
            point.xi = q.xi;
            point.N = shape(corners.count, q.xi).N;
            point.weight = q.weight * reference_area(weights_.X(f), q.xi);
            interpolate(point, f, smooth);
            for (const Share& share : point.shares) facet.gap_slaves.push_back(share.slave);
        }
        sort_unique(facet.gap_slaves);
    }
}

void Mortar::interpolate(GapPoint& q, Index f, const SmoothSlave* smooth) const {
    const std::vector<Vec3>& X = weights_.X(f);
    Vec3 chord = Vec3::Zero();
    for (std::size_t c = 0; c < X.size(); ++c) chord += q.N(static_cast<Index>(c)) * X[c];
    ContactPoint on_surface;
    if (smooth != nullptr) {
        FacetHit hit;
        hit.facet = f;
        hit.u = q.xi;
        smooth->shape->evaluate(chord, hit, smooth->X, on_surface);
    }
    std::map<Index, Mat3> C;
    if (!on_surface.found)
        for (std::size_t c = 0; c < X.size(); ++c)
            C[weights_.corners(f).node[c]] = q.N(static_cast<Index>(c)) * Mat3::Identity();
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
    std::unique_ptr<Mortar> other(new Mortar(*this));
    for (Facet& facet : other->facets_)
        for (GapPoint& q : facet.gap_points) q.point.trace.reset(); // refers to our placement
    return other;
}

void Mortar::begin(const PairPositions& at, const FacetTracking& tracking, int threads) {
    weights_.begin(at);
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
                const bool latched = q.changes >= tracking.changes_before_latch;
                q.hit = at.search.track(s, q.facet, at.vertices, latched ? latched_hysteresis : tracking.hysteresis);
                q.hit.latched = latched;
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
            std::vector<Index> below;
            DualSum sum(facet.corners.count);
            for (const GapPoint& q : facet.gap_points) {
                if (q.facet >= 0) below.push_back(q.facet);
                if (q.point.found) sum.add(q.N, q.weight);
            }
            sum.finish(weights_.area(f), least_cover, facet.dual);
            weights_.update(f, at, std::move(below));
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

double Mortar::gap_area(Index j) const {
    double sum = 0;
    for (const auto& [f, c] : weights_.around(j)) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (facet.dual.usable) sum += facet.dual.D(c);
    }
    return sum;
}

void Mortar::gather(Index j, const std::vector<Vec3>& x, ContactPoint& point) {
    point.found = point.behind = false;
    point.nodes.clear();
    carriers_[static_cast<std::size_t>(j)] = 0;
    const double by_gap = gap_area(j), by_weight = weights_.share(j);
    double deepest_gap = 0;
    for (const auto& [f, c] : weights_.around(j))
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
    for (const auto& [f, c] : weights_.around(j)) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        for (const Index k : facet.corners)
            if (k != j) slaves.push_back(surface_.vertex_count() + k);
        for (const Index k : facet.gap_slaves)
            if (k != j) slaves.push_back(surface_.vertex_count() + k);
        if (!facet.dual.usable) continue;
        const int n = facet.corners.count;
        for (const GapPoint& q : facet.gap_points) {
            if (!q.point.found) continue;
            const double psi = q.weight * facet.dual.A.row(c).dot(q.N.head(n));
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
    weights_.add_vertices(j, carrying);
    sort_unique(carrying);
    sort_unique(sensing);
    sort_unique(slaves);
    point.nodes = carrying;
    std::set_difference(sensing.begin(), sensing.end(), carrying.begin(), carrying.end(),
                        std::back_inserter(point.nodes));
    point.nodes.insert(point.nodes.end(), slaves.begin(), slaves.end());
    carriers_[static_cast<std::size_t>(j)] = static_cast<Index>(carrying.size());

    point.weights = Vector::Zero(static_cast<Index>(point.nodes.size()));
    weights_.add_weights(j, carrying, point.weights);
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
    for (const auto& [f, c] : weights_.around(j)) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (!facet.dual.usable) continue;
        for (const GapPoint& q : facet.gap_points) {
            if (!q.point.found) continue;
            Vec3 tail = q.tail;
            for (const Share& share : q.shares) tail += share.C * at.slave_tails[static_cast<std::size_t>(share.slave)];
            double of_gap = q.point.normal.dot(tail);
            for (std::size_t i = 0; i < q.point.nodes.size(); ++i)
                of_gap += q.point.pressing.row(static_cast<Index>(i))
                              .dot(at.vertex_tails[static_cast<std::size_t>(q.point.nodes[i])]);
            lost += q.weight * facet.dual.A.row(c).dot(q.N.head(facet.corners.count)) * of_gap;
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
