#include "osculate/contact/edge_crossing.hpp"
#include "osculate/core/parallel.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <utility>

namespace osculate::contact {

namespace {

/// Part of an edge by which a crossing may lie beyond its end: where edges bend, a crossing that is inside lies beyond both.
/// And one that began there may run on within an attempt, so that two edges do not give it to and fro. How near it may come
/// to the end that is not the slave.
constexpr double slack = 0.05, beyond_end = 0.15, farthest = 0.9;
/// Place from which on the other end of an edge is clearly nearer.
constexpr double clearly_nearer = 0.6;
/// A crossing that is deeper at the start, in lengths of the shorter edge, is on the other side of a thin part; one that is
/// new is of edges that did not meet, but whose lines do.
constexpr double deepest_known = 0.3, deepest_new = 0.02;
/// An end that is this near, in lengths, meets the other edge as a node on a face, if the normal is that of a face up to this
/// sine.
constexpr double at_end = 0.04, of_face = 0.02;

class EdgeDiscretisation final : public Discretisation {
public:
    EdgeDiscretisation(const mesh::HalfEdgeSurface& surface, std::vector<EdgesThatMeet> edges)
        : surface_(surface), edges_(std::move(edges)), start_(edges_.size()) {}

    [[nodiscard]] std::unique_ptr<Discretisation> clone() const override {
        return std::make_unique<EdgeDiscretisation>(surface_, edges_);
    }

    void begin(const PairPositions& at, const FacetTracking& tracking, int threads) override {
        start_.assign(edges_.size(), {});
        parallel_for(threads, static_cast<Index>(edges_.size()), [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j) start_[static_cast<std::size_t>(j)] = start(j, at, tracking);
        });
    }

    int evaluate(const PairPositions& at, FacetTracking& tracking, std::vector<ContactPoint>& points,
                 int threads) override {
        parallel_for(threads, static_cast<Index>(edges_.size()), [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j)
                evaluate(j, at, tracking.hits[static_cast<std::size_t>(j)], points[static_cast<std::size_t>(j)]);
        });
        for (std::size_t j = 0; j < edges_.size(); ++j) tracking.facet[j] = tracking.hits[j].facet;
        return 0;
    }

    void vary(Index j, const PairPositions& at, const FacetHit&, const ContactPoint& point,
              ContactVariation& variation) const override {
        const auto [a0, a1, b0, b1] = ends(j, at);
        const LineCrossing crossing = cross_lines(a0, a1, b0, b1);
        const Vec3 a = a1 - a0, b = b1 - b0;
        const double s = crossing.s, t = crossing.t, rest = 1 - s, side = start_[static_cast<std::size_t>(j)].side;
        const Vec3& n = point.normal;
        // y = (a0, a1, b0, b1)
        const std::array<double, 4> shares{1 - s, s, -(1 - t), -t};
        variation.patches.clear();
        variation.dg.resize(1, 12);
        for (int k = 0; k < 4; ++k)
            variation.dg.middleCols<3>(3 * k) = shares[static_cast<std::size_t>(k)] * n.transpose();
        const auto cross_matrix = [](const Vec3& v) {
            Mat3 m;
            m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
            return m;
        };
        const double area = a.cross(b).norm();
        const Mat3 project = side / area * (Mat3::Identity() - n * n.transpose());
        const Mat3 by_a = -project * cross_matrix(b), by_b = project * cross_matrix(a); // d(a x b) = da x b + a x db
        variation.dn.resize(3, 12);
        variation.dn << -by_a, by_a, -by_b, by_b;
        // offset . a = 0 and offset . b = 0 hold all the time
        Mat2 M;
        M << a.dot(a), -b.dot(a), a.dot(b), -b.dot(b);
        Eigen::Matrix<double, 2, 12> right;
        for (int k = 0; k < 4; ++k) {
            right.block<1, 3>(0, 3 * k) = shares[static_cast<std::size_t>(k)] * a.transpose();
            right.block<1, 3>(1, 3 * k) = shares[static_cast<std::size_t>(k)] * b.transpose();
        }
        const Vec3& r = crossing.offset;
        right.block<1, 3>(0, 0) -= r.transpose();
        right.block<1, 3>(0, 3) += r.transpose();
        right.block<1, 3>(1, 6) -= r.transpose();
        right.block<1, 3>(1, 9) += r.transpose();
        const Eigen::Matrix<double, 2, 12> d = -M.inverse() * right; // of s and t
        variation.dweights.resize(3, 12);
        variation.dweights.row(0) = -d.row(0) / (rest * rest);
        variation.dweights.row(1) = ((1 - t) / rest * d.row(0) - d.row(1)) / rest;
        variation.dweights.row(2) = (t / rest * d.row(0) + d.row(1)) / rest;
        variation.dpressing.resize(9, 12);
        for (Index i = 0; i < 3; ++i) // p_i = -Phi_i n
            variation.dpressing.middleRows<3>(3 * i) = -n * variation.dweights.row(i) - point.weights(i) * variation.dn;
    }

    [[nodiscard]] Index carriers(Index, const ContactPoint& point) const override { return point.found ? 3 : 0; }

    void force_change(const ContactPoint& point, const Vec3& lambda, const Vec3&, std::span<const double> dweights,
                      const double*, double* df) const override {
        // f_i = -Phi_i lambda
        for (Index i = 0; i < static_cast<Index>(dweights.size()); ++i)
            for (int c = 0; c < 3; ++c) df[3 * i + c] = -dweights[static_cast<std::size_t>(i)] * lambda(c);
        (void)point;
    }

    void weights_along(const ContactPoint&, const ContactVariation& variation, const Vector& dy, Vector& dweights,
                       Vector& dpressing) const override {
        dweights.noalias() = variation.dweights * dy;
        dpressing.noalias() = variation.dpressing * dy;
    }

    [[nodiscard]] double gap_rounded_off(Index j, const PairPositions& at, const ContactPoint& point) const override {
        const Vec3& n = point.normal;
        const double rest = 1 / (1 - point.weights(0)); // 1 - s
        double lost = n.dot(at.slave_tails[static_cast<std::size_t>(j)]);
        for (Index i = 0; i < 3; ++i)
            lost -= point.weights(i) * n.dot(tail(at, point.nodes[static_cast<std::size_t>(i)]));
        return rest * lost;
    }

    void follow(const FacetHit&, const ContactPoint& point, Index, std::vector<Index>& vertices,
                std::vector<double>& shares) const override {
        vertices = point.nodes;
        shares.assign(point.weights.begin(), point.weights.end());
    }

private:
    /// What holds for an attempt.
    struct Start {
        double side = 0;      ///< of the normal along a x b; 0: no contact
        double overshoot = 0; ///< part of an edge, see beyond_end
        bool flat = false;    ///< the normal is that of a face
    };

    [[nodiscard]] std::array<Vec3, 4> ends(Index j, const PairPositions& at) const {
        const EdgesThatMeet& edge = edges_[static_cast<std::size_t>(j)];
        const auto [b0, b1] = master_ends(edge);
        return {at.slaves[static_cast<std::size_t>(j)], at.slaves[static_cast<std::size_t>(edge.end)],
                at.vertices[static_cast<std::size_t>(b0)], at.vertices[static_cast<std::size_t>(b1)]};
    }
    [[nodiscard]] std::pair<Index, Index> master_ends(const EdgesThatMeet& edge) const {
        const mesh::HalfEdge& half = surface_.half_edges()[static_cast<std::size_t>(edge.half_edge)];
        return {half.origin, surface_.half_edges()[static_cast<std::size_t>(half.next)].origin};
    }
    [[nodiscard]] const Vec3& tail(const PairPositions& at, Index vertex) const {
        const Index count = surface_.vertex_count();
        return vertex < count ? at.vertex_tails[static_cast<std::size_t>(vertex)]
                              : at.slave_tails[static_cast<std::size_t>(vertex - count)];
    }

    /// Whether item j has the crossing and not the one from the other end.
    [[nodiscard]] bool begins_here(Index j, double s, const FacetTracking& tracking) const {
        const Index reverse = edges_[static_cast<std::size_t>(j)].reverse;
        const auto in_force = [&](Index item) { return tracking.facet[static_cast<std::size_t>(item)] >= 0; };
        if (in_force(j) != in_force(reverse)) return in_force(j) ? s <= clearly_nearer : 1 - s > clearly_nearer;
        return s < 0.5 || (s == 0.5 && j < reverse);
    }

    [[nodiscard]] Start start(Index j, const PairPositions& positions, const FacetTracking& tracking) const {
        const EdgesThatMeet& edge = edges_[static_cast<std::size_t>(j)];
        const std::array<Vec3, 4> at = ends(j, positions);
        // the same numbers for both items of an edge
        const bool first = j < edge.reverse;
        LineCrossing crossing =
            first ? cross_lines(at[0], at[1], at[2], at[3]) : cross_lines(at[1], at[0], at[2], at[3]);
        if (!first) {
            crossing.s = 1 - crossing.s;
            crossing.across *= -1;
        }
        if (!(crossing.sine > least_sine) || !begins_here(j, crossing.s, tracking)) return {};
        const SharpEdge own = slave_edge(j, edge,
                                         [&](Index number) -> const Vec3& {
                                             return positions.slaves[static_cast<std::size_t>(number)];
                                         }),
                        other = sharp_edge(surface_, edge.half_edge, positions.vertices);
        const auto leaves = [&](double side) { return out_of_cones(side * crossing.across, own, other); };
        const double side = leaves(1) < leaves(-1) ? 1 : -1;
        if (leaves(side) > (edge.watched ? watched_tolerance : cone_tolerance)) return {};
        const double length = std::min((at[1] - at[0]).norm(), (at[3] - at[2]).norm());
        const bool known = edge.watched || std::max(tracking.facet[static_cast<std::size_t>(j)],
                                                    tracking.facet[static_cast<std::size_t>(edge.reverse)]) >= 0;
        if (side * crossing.across.dot(crossing.offset) < -(known ? deepest_known : deepest_new) * length) return {};
        const Vec3 n = side * crossing.across;
        // the normal of a face is normal to its wing
        const bool flat = std::max(n.dot(other.wings[0]), n.dot(other.wings[1])) > -of_face ||
                          std::max(-n.dot(own.wings[0]), -n.dot(own.wings[1])) > -of_face;
        const bool on_it = crossing.s >= -slack && crossing.t >= -slack && crossing.t <= 1 + slack;
        return {side, on_it ? beyond_end : slack, flat};
    }

    void evaluate(Index j, const PairPositions& positions, FacetHit& hit, ContactPoint& point) const {
        const EdgesThatMeet& edge = edges_[static_cast<std::size_t>(j)];
        const Start& start = start_[static_cast<std::size_t>(j)];
        hit = {};
        hit.distance = std::numeric_limits<double>::max();
        point.found = point.behind = false;
        point.gap = std::numeric_limits<double>::infinity();
        if (start.side == 0) return;
        const std::array<Vec3, 4> at = ends(j, positions);
        const LineCrossing crossing = cross_lines(at[0], at[1], at[2], at[3]);
        const double s = crossing.s, t = crossing.t;
        if (!(crossing.sine > 0.5 * least_sine)) return;
        point.normal = start.side * crossing.across;
        point.gap = point.normal.dot(crossing.offset);
        if (s < -start.overshoot || s > farthest || t < -start.overshoot || t > 1 + start.overshoot) return;
        if (start.flat && std::abs(s) < at_end) return;
        const auto [b0, b1] = master_ends(edge);
        hit.facet = surface_.half_edges()[static_cast<std::size_t>(edge.half_edge)].facet;
        hit.distance = crossing.offset.norm();
        point.found = true;
        point.facet = hit.facet;
        point.side = -1;
        point.foot = at[2] + t * (at[3] - at[2]);
        point.nodes = {surface_.vertex_count() + edge.end, b0, b1};
        point.weights.resize(3);
        point.weights << -s, 1 - t, t;
        point.weights /= 1 - s;
        point.pressing = -point.weights * point.normal.transpose();
        point.trace.reset();
    }

    const mesh::HalfEdgeSurface& surface_;
    std::vector<EdgesThatMeet> edges_;
    std::vector<Start> start_;
};

} // namespace

std::unique_ptr<Discretisation> make_edge_discretisation(const mesh::HalfEdgeSurface& surface,
                                                         std::vector<EdgesThatMeet> edges) {
    return std::make_unique<EdgeDiscretisation>(surface, std::move(edges));
}

} // namespace osculate::contact
