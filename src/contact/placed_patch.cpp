#include "contact/placed_patch.hpp"

#include <Eigen/LU>
#include <cmath>

namespace osculate::contact {

namespace {

/// tau of natural coordinates u from the vertex.
double tau_at(const VertexPatch& patch, const Vec2& u) {
    return patch.kappa * u.dot(patch.metric * u);
}

/// X,a s_a and X,ab s_b, in columns a, and X,ab s_a s_b.
struct Along {
    Vec3 tangent;
    Matrix32 second;
    Vec3 both;

    Along(const PatchPoint& p, const Vec2& s) : tangent(s.x() * p.X_a.col(0) + s.y() * p.X_a.col(1)) {
        second.col(0) = s.x() * p.X_11 + s.y() * p.X_12;
        second.col(1) = s.x() * p.X_12 + s.y() * p.X_22;
        both = s.x() * second.col(0) + s.y() * second.col(1);
    }
};

/// A symmetric matrix.
struct Symmetric {
    double a_11, a_12, a_22;

    [[nodiscard]] double determinant() const { return a_11 * a_22 - a_12 * a_12; }
    /// A^-1 v, given the determinant.
    [[nodiscard]] Vec2 solve(const Vec2& v, double det) const {
        return {(a_22 * v.x() - a_12 * v.y()) / det, (a_11 * v.y() - a_12 * v.x()) / det};
    }
};

/// One step to the foot of s, d = s - X: Newton's, H_a = d . X,a, K_ab = X,a . X,b - d . X,ab, with a correction of second
/// order: the change of H beyond -K s is  -(X,b s_b) . X,ac s_c - 1/2 X,bc s_b s_c . X,a,  and the part of d that it leaves
/// out is small next to the radius of curvature. The metric replaces K where that is not positive definite.
struct Step {
    Vec2 u = Vec2::Zero();
    bool convex = false; ///< K is positive definite
    bool possible = false;

    Step(const PatchPoint& p, const Vec3& d) {
        constexpr double small = 0.5; // the correction, to the step
        const Vec3 X_1 = p.X_a.col(0), X_2 = p.X_a.col(1);
        const Symmetric metric{X_1.dot(X_1), X_1.dot(X_2), X_2.dot(X_2)};
        Symmetric K{metric.a_11 - d.dot(p.X_11), metric.a_12 - d.dot(p.X_12), metric.a_22 - d.dot(p.X_22)};
        convex = K.determinant() > 0 && K.a_11 + K.a_22 > 0;
        if (!convex) K = metric;
        const double det = K.determinant();
        possible = det != 0;
        if (!possible) return;
        u = K.solve({X_1.dot(d), X_2.dot(d)}, det);
        if (!convex) return;
        const Along along(p, u);
        const Vec2 beyond(-along.second.col(0).dot(along.tangent) - 0.5 * X_1.dot(along.both),
                          -along.second.col(1).dot(along.tangent) - 0.5 * X_2.dot(along.both));
        const Vec2 correction = K.solve(beyond, det);
        if (correction.squaredNorm() < small * small * u.squaredNorm()) u += correction;
    }
};

/// Foot of s on the Taylor series at the vertex, from the vertex, or nothing where the bump surely does not reach: the
/// starting point of the projection.
/// @param most  greatest distance of the foot, m
std::optional<Vec2> start(const VertexPatch& patch, const PlacedPatch& placed, const Vec3& s, double most) {
    constexpr double surely_outside = 2; // root of tau on the tangent plane: twice as far as the bump reaches
    constexpr double margin = 1.1;       // of the bump's radius
    if (!placed.regular) return std::nullopt;
    const Vec3 d = s - placed.at_vertex.X;
    const Vec2 flat = placed.onto_plane * d;
    const double farthest = std::min(surely_outside, placed.flat_reach + placed.flat_reach_by_distance * most);
    if (!(tau_at(patch, flat) < farthest * farthest)) return std::nullopt;
    constexpr double little = 0.01; // tau of a first step whose error is below that of the series
    Vec2 u = flat;
    for (int step = 0; step < 2; ++step) {
        const PatchPoint p = placed.near_vertex(u);
        const Step next(p, d - p.X);
        if (!next.convex) return flat;
        u += next.u;
        if (tau_at(patch, next.u) < little) break;
    }
    // what the series leaves out is smaller than what it changed
    const double bend = tau_at(patch, u - flat);
    if (!(bend < 1)) return flat;
    if (std::sqrt(tau_at(patch, u)) - 2 * std::sqrt(bend) > margin) return std::nullopt;
    return u;
}

/// As project() for patches in general, but with the steps above. It ends with a step shorter than 1e-8 node distances, whose
/// cube is far below round-off, as are the terms left out here: the last step is taken without another look at the patch.
/// @param u  start, natural coordinates; s from the patch's origin
/// @returns  false without convergence: `foot` is then undefined
bool find_foot(const Vec3& s, const VertexPatch& patch, const PlacedPatch& placed, Vec2 u, Foot& foot) {
    constexpr int most_iterations = 30;
    constexpr double nearly = 1e-8, tolerance = 1e-11; // of the node distance; the second where steps are not Newton's
    const double distance = patch.shape.node_distance();
    static thread_local BasisTable table;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        patch.shape.tabulate(u, BasisTable::second, table);
        PatchPoint& p = foot.point;
        p = patch.shape.point(table, placed.coefficients);
        Step step(p, s - p.X);
        const double length = step.u.norm();
        if (!step.possible || !std::isfinite(length)) return false;
        if (length <= (step.convex ? nearly : tolerance) * distance) {
            const Along along(p, step.u);
            p.X += along.tangent + 0.5 * along.both;
            p.X_a += along.second;
            foot.u = u + step.u;
            return true;
        }
        const bool shortened = length > distance;
        if (shortened) step.u *= distance / length;
        u += step.u;
        // what is left is less than twice the last step
        if (!shortened && std::sqrt(tau_at(patch, u - patch.origin)) - 3 * std::sqrt(tau_at(patch, step.u)) > 1)
            return false;
    }
    return false;
}

} // namespace

void PlacedPatch::place(const VertexPatch& patch, const std::vector<Vec3>& vertices) {
    const auto n = static_cast<Index>(patch.vertices.size());
    origin = vertices[patch.vertices[0]];
    static thread_local MatrixX3 nodes;
    nodes.setZero(patch.shape.padded_size(), 3);
    for (Index i = 0; i < n; ++i) nodes.row(i) = (vertices[patch.vertices[i]] - origin).transpose();
    patch.shape.coefficients(nodes, coefficients);
    static thread_local BasisTable table;
    patch.shape.tabulate(patch.origin, BasisTable::third, table);
    at_vertex = patch.shape.point(table, coefficients);
    third = patch.shape.third(table, coefficients);
    const Mat2 a = at_vertex.X_a.transpose() * at_vertex.X_a;
    regular = a.determinant() > 0;
    if (regular) onto_plane = a.inverse() * at_vertex.X_a.transpose();
    ball = {origin + at_vertex.X, 0};
    if (regular) find_reach(patch);
}

PatchPoint PlacedPatch::near_vertex(const Vec2& u) const {
    const double u_1 = u.x(), u_2 = u.y();
    const Vec3 T_11 = u_1 * third.X_111 + u_2 * third.X_112, T_12 = u_1 * third.X_112 + u_2 * third.X_122,
               T_22 = u_1 * third.X_122 + u_2 * third.X_222;
    const PatchPoint& v = at_vertex;
    const Along bent(v, u);
    PatchPoint p;
    Matrix32 twisted; // X,abc u_b u_c
    twisted.col(0) = u_1 * T_11 + u_2 * T_12;
    twisted.col(1) = u_1 * T_12 + u_2 * T_22;
    p.X = bent.tangent + 0.5 * bent.both + (twisted * u) / 6;
    p.X_a = v.X_a + bent.second + 0.5 * twisted;
    p.X_11 = v.X_11 + T_11;
    p.X_12 = v.X_12 + T_12;
    p.X_22 = v.X_22 + T_22;
    return p;
}

void PlacedPatch::find_reach(const VertexPatch& patch) {
    // the terms of X(u) - X at the vertex = X,a u_a + 1/2 X,ab u_a u_b + 1/6 X,abc u_a u_b u_c + .. where tau = 1: the first
    // exactly, the others by norms. What the series leaves out is smaller than its last term.
    constexpr double margin = 1.1;
    const auto largest = [](const Mat2& A) { // eigenvalue of one with real ones
        const double mean = 0.5 * A.trace();
        return mean + std::sqrt(std::max(0.0, mean * mean - A.determinant()));
    };
    const PatchPoint& v = at_vertex;
    const Mat2 M = patch.kappa * patch.metric, by_tau = M.inverse(); // u u^T is at most this
    const double r = std::sqrt(largest(by_tau));
    const auto square = [](const auto& a) { return a.squaredNorm(); };
    const auto second_norm = [](const auto& size, const auto& a, const auto& b, const auto& c) {
        return std::sqrt(size(a) + 2 * size(b) + size(c));
    };
    const auto third_norm = [](const auto& size, const auto& a, const auto& b, const auto& c, const auto& d) {
        return std::sqrt(size(a) + 3 * size(b) + 3 * size(c) + size(d));
    };
    const double second = second_norm(square, v.X_11, v.X_12, v.X_22),
                 last = third_norm(square, third.X_111, third.X_112, third.X_122, third.X_222);
    const double first = std::sqrt(largest(by_tau * (v.X_a.transpose() * v.X_a)));
    ball.radius = margin * (first + r * r * second / 2 + 2 * r * r * r * last / 6);

    // on the tangent plane the first term is u, and of a point at distance g above the bump there is g n more, where
    // X,a . n = -(X,a(u) - X,a) . n
    const auto in_plane = [&](const Vec3& x) {
        const Vec2 flat = onto_plane * x;
        return flat.dot(M * flat);
    };
    const double second_in_plane = second_norm(in_plane, v.X_11, v.X_12, v.X_22),
                 last_in_plane = third_norm(in_plane, third.X_111, third.X_112, third.X_122, third.X_222);
    flat_reach = margin * (1 + r * r * second_in_plane / 2 + 2 * r * r * r * last_in_plane / 6);
    const Mat2 a_inverse = (v.X_a.transpose() * v.X_a).inverse();
    flat_reach_by_distance =
        margin * std::sqrt(largest(a_inverse * M * a_inverse)) * (r * second + 2 * r * r * last / 2);
}

bool see(const Vec3& s, const VertexPatch& patch, const PlacedPatch& placed, double most, ActivePatch& a) {
    const Vec3 from_origin = s - placed.origin;
    const auto begin = start(patch, placed, from_origin, most);
    if (!begin || !find_foot(from_origin, patch, placed, patch.origin + *begin, a.foot)) return false;
    a.patch = &patch;
    a.placed = &placed;
    PatchPoint& p = a.foot.point;
    const Vec2 u = a.foot.u - patch.origin, Mu = patch.metric * u;
    a.tau = patch.kappa * u.dot(Mu);
    if (!(a.tau < 1)) return false;
    a.normal = p.normal();
    a.gap = a.normal.dot(from_origin - p.X);
    if (std::abs(a.gap) > most || !unique(p, a.normal, a.gap)) return false;
    const double rest = 1 - a.tau;
    a.psi = rest * rest * rest;
    a.K_inverse = (p.X_a.transpose() * p.X_a - a.gap * p.curvature(a.normal)).inverse();
    a.by_foot = -6 * patch.kappa * rest * rest * Mu;
    p.X += placed.origin;
    return true;
}

} // namespace osculate::contact
