#include "contact/blend_variation.hpp"

#include <algorithm>

namespace osculate::contact {

namespace {

using Rows8 = Eigen::Matrix<double, 8, Eigen::Dynamic>;

/// First of the three columns of s (k = 0) or of node k - 1 of the patch, in the variations of the blend.
Index column(const ActivePatch& a, Index k) {
    return k == 0 ? Index{0} : 3 + 3 * a.place[static_cast<std::size_t>(k - 1)];
}

/// Second variations of psi_v g_v / P in the patch's own y, but for the terms that couple it with the blended gap:
///   psi dDg_v + dpsi Dg_v + Dpsi dg_v + (g_v - g) dDpsi
/// with n.dX,a of the moving nodes alone (N), B = N + b du, and dDu from differentiating (s - X).X,a = 0 twice. Given
/// as half + half^T with half = left^T right.
void second_variation(const ActivePatch& a, const Vec3& s, double g, Rows8& left, Rows8& right) {
    const PatchPoint& p = a.foot.point;
    const VertexPatch& patch = *a.patch;
    const auto n = static_cast<Index>(patch.vertices.size());
    const Index m = 3 + 3 * n;
    const Rows2& U = a.du;
    const Mat2 b = p.curvature(a.normal), metric = p.X_a.transpose() * p.X_a;
    const Vec2 Mu = patch.metric * (a.foot.u - patch.origin);
    const Vec2 q = (metric - a.gap * b).inverse() * Mu; // (M u) . dDu = q . dDF
    const Vec3 e = s - p.X;
    const MatrixX3 phi_ab = patch.shape.second_derivatives(a.foot.u);
    const PatchThird third = patch.shape.third(a.foot.u, a.placed->coefficients);
    const Vec3 X_q = p.X_a * q;
    Matrix32 X_qc; // q_a X,ac
    X_qc.col(0) = q.x() * p.X_11 + q.y() * p.X_12;
    X_qc.col(1) = q.x() * p.X_12 + q.y() * p.X_22;
    Mat2 third_q; // e . q_a X,acd
    third_q(0, 0) = e.dot(q.x() * third.X_111 + q.y() * third.X_112);
    third_q(0, 1) = third_q(1, 0) = e.dot(q.x() * third.X_112 + q.y() * third.X_122);
    third_q(1, 1) = e.dot(q.x() * third.X_122 + q.y() * third.X_222);

    Rows2 N = Rows2::Zero(2, m), R = Rows2::Zero(2, m); // n.Phi_i,a dx_i;  e.(q_a Phi_i,ac) dx_i - X_q.Phi_i,c dx_i
    Rows3 A = X_qc * U, E = -p.X_a * U;                 // q_a dX,a and d(s - X), totals
    E.leftCols<3>() += Mat3::Identity();
    for (Index i = 0; i < n; ++i) {
        const Vec2 phi_i = a.phi_a.row(i).transpose();
        const Vec2 phi_q(q.x() * phi_ab(i, 0) + q.y() * phi_ab(i, 1), q.x() * phi_ab(i, 1) + q.y() * phi_ab(i, 2));
        N.middleCols<3>(3 + 3 * i) = phi_i * a.normal.transpose();
        R.middleCols<3>(3 + 3 * i) = phi_q * e.transpose() - phi_i * X_q.transpose();
        A.middleCols<3>(3 + 3 * i) += q.dot(phi_i) * Mat3::Identity();
        E.middleCols<3>(3 + 3 * i) -= a.phi(i) * Mat3::Identity();
    }
    const double rest = 1 - a.tau, by_tau = -3 * rest * rest; // dpsi/dtau
    const double by_u = (a.gap - g) * by_tau * 2 * patch.kappa;
    const Rows2 B = N + b * U;
    left.resize(8, m);
    right.resize(8, m);
    left << U, A, B, a.dpsi;
    right << a.psi * (-N - 0.5 * b * U) + by_u * (R + 0.5 * (third_q - p.curvature(X_q) + patch.metric) * U), by_u * E,
        (0.5 * a.psi * a.gap) * (metric.inverse() * B), a.dg;
    if (rest > 0) right.row(7) += ((a.gap - g) * 3 * rest / (by_tau * by_tau)) * a.dpsi;
}

/// The rows of s alone of the second variation, which the normal takes.
void vary_gap_and_normal(const std::vector<ActivePatch>& active, const Vec3& s, const ContactPoint& point, double P,
                         ContactVariation& variation) {
    const Index m = 3 + 3 * static_cast<Index>(point.nodes.size());
    static thread_local Rows8 left, right;
    Row dg = Row::Zero(m), dpsi = Row::Zero(m);
    Rows3 top = Rows3::Zero(3, m);
    for (const ActivePatch& a : active) {
        second_variation(a, s, point.gap, left, right);
        const Rows3 own = left.leftCols<3>().transpose() * right + right.leftCols<3>().transpose() * left;
        for (Index k = 0; k <= static_cast<Index>(a.place.size()); ++k) {
            const Index to = column(a, k);
            dg.middleCols<3>(to) +=
                a.psi * a.dg.middleCols<3>(3 * k) + (a.gap - point.gap) * a.dpsi.middleCols<3>(3 * k);
            dpsi.middleCols<3>(to) += a.dpsi.middleCols<3>(3 * k);
            top.middleCols<3>(to) += own.middleCols<3>(3 * k);
        }
    }
    dg /= P;
    top -= dpsi.leftCols<3>().transpose() * dg + dg.leftCols<3>().transpose() * dpsi;
    top /= P;
    variation.dg = dg;
    const Vec3& normal = point.normal;
    variation.dn = (top - normal * (normal.transpose() * top)) / dg.leftCols<3>().norm();
}

} // namespace

void vary_blend(const std::vector<ActivePatch>& active, const Vec3& s, const ContactPoint& point,
                ContactVariation& variation) {
    const auto n = static_cast<Index>(point.nodes.size());
    const Index m = 3 + 3 * n;
    const double g = point.gap;
    double P = 0;
    for (const ActivePatch& a : active) P += a.psi;
    if (!variation.of_forces) return vary_gap_and_normal(active, s, point, P, variation);
    Row dg = Row::Zero(m), dpsi = Row::Zero(m);
    static thread_local Matrix half, own_half, own_weights; // the second variation is half + half^T
    static thread_local Rows8 left, right;
    half.setZero(m, m);
    variation.dweights.setZero(n, m);
    for (const ActivePatch& a : active) {
        const auto own = static_cast<Index>(a.place.size());
        second_variation(a, s, g, left, right);
        own_half.noalias() = left.transpose() * right;
        own_weights.noalias() = a.psi * (a.phi_a * a.du);
        own_weights.noalias() += a.phi * a.dpsi; // d(psi Phi_i) = psi Phi_i,a du_a + dpsi Phi_i
        const auto at = [&](Index k) { return column(a, k); };
        for (Index k = 0; k <= own; ++k) {
            dg.middleCols<3>(at(k)) += a.psi * a.dg.middleCols<3>(3 * k) + (a.gap - g) * a.dpsi.middleCols<3>(3 * k);
            dpsi.middleCols<3>(at(k)) += a.dpsi.middleCols<3>(3 * k);
            for (int c = 0; c < 3; ++c) {
                const double *from = &own_half(0, 3 * k + c), *weight = &own_weights(0, 3 * k + c);
                double *to = &half(0, at(k) + c), *into = &variation.dweights(0, at(k) + c);
                for (Index i = 0; i <= own; ++i)
                    for (int r = 0; r < 3; ++r) to[at(i) + r] += from[3 * i + r];
                for (Index i = 0; i < own; ++i) into[a.place[static_cast<std::size_t>(i)]] += weight[i];
            }
        }
    }
    dg /= P;
    half.noalias() -= dpsi.transpose() * dg;
    half /= P;
    variation.dweights.noalias() -= point.weights * dpsi;
    variation.dweights /= P;
    variation.dg = dg;
    const double slope = dg.leftCols<3>().norm();
    const Vec3& normal = point.normal;
    const Eigen::Matrix<double, 3, Eigen::Dynamic> top = half.topRows<3>() + half.leftCols<3>().transpose();
    const Row dslope = normal.transpose() * top;
    variation.dn = (top - normal * dslope) / slope;
    variation.dpressing.resize(3 * n, m);
    const Vector pressing = point.pressing.transpose().reshaped() / slope;
    variation.dpressing.leftCols<3>() =
        (half.bottomLeftCorner(3 * n, 3) + half.topRightCorner(3, 3 * n).transpose()) / slope -
        pressing * dslope.leftCols<3>();
    constexpr Index tile = 24; // transposing by tiles stays in the cache
    for (Index i = 3; i < m; i += tile)
        for (Index k = 3; k < m; k += tile) {
            const Index rows = std::min(tile, m - i), columns = std::min(tile, m - k);
            variation.dpressing.block(i - 3, k, rows, columns) =
                (half.block(i, k, rows, columns) + half.block(k, i, columns, rows).transpose()) / slope -
                pressing.segment(i - 3, rows) * dslope.segment(k, columns);
        }
}

} // namespace osculate::contact
