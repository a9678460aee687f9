#include "contact/blend_variation.hpp"

#include <algorithm>

namespace osculate::contact {

namespace {

using Moments8 = Eigen::Matrix<double, 8, PatchVariation::size>;
using Rows8 = Eigen::Matrix<double, 8, Eigen::Dynamic>;

/// First variations of the foot, of psi, and of the gap of one patch over the moments z of PatchVariation.
struct FirstMoments {
    Eigen::Matrix<double, 2, PatchVariation::size> du;
    PatchVariation::Row dg, dpsi;
};
FirstMoments first_moments(const ActivePatch& a) {
    FirstMoments first;
    first.dg.setZero();
    first.dg.head<3>() = a.normal.transpose();
    first.dg.segment<3>(3) = -a.normal.transpose();
    first.du.setZero();
    first.du.leftCols<3>() = a.K_inverse * a.foot.point.X_a.transpose();
    first.du.middleCols<3>(3) = -first.du.leftCols<3>();
    for (int c = 0; c < 2; ++c) first.du.middleCols<3>(6 + 3 * c) = a.gap * a.K_inverse.col(c) * a.normal.transpose();
    first.dpsi = a.by_foot.transpose() * first.du;
    return first;
}

/// Second variations of psi_v g_v / P, but for the terms that couple it with the blended gap:
///   psi dDg_v + dpsi Dg_v + Dpsi dg_v + (g_v - g) dDpsi
/// with n.dX,a of the moving nodes alone (N), B = N + b du, and dDu from differentiating (s - X).X,a = 0 twice. Given over
/// the moments z as half + half^T with half = left^T right.
void second_variation(const ActivePatch& a, const FirstMoments& first, const Vec3& s, double g, Moments8& left,
                      Moments8& right) {
    using Rows2 = Eigen::Matrix<double, 2, PatchVariation::size>;
    using Rows3 = Eigen::Matrix<double, 3, PatchVariation::size>;
    constexpr int phi = 3, phi_a = 6, phi_ab = 12; // where their moments begin
    const PatchPoint& p = a.foot.point;
    const VertexPatch& patch = *a.patch;
    const Rows2& U = first.du;
    const Mat2 b = p.curvature(a.normal), metric = p.X_a.transpose() * p.X_a;
    const Vec2 Mu = patch.metric * (a.foot.u - patch.origin);
    const Vec2 q = (metric - a.gap * b).inverse() * Mu; // (M u) . dDu = q . dDF
    const Vec3 e = s - p.X;
    const PatchThird third = patch.shape.third(a.foot.u, a.placed->coefficients);
    const Vec3 X_q = p.X_a * q;
    Matrix32 X_qc; // q_a X,ac
    X_qc.col(0) = q.x() * p.X_11 + q.y() * p.X_12;
    X_qc.col(1) = q.x() * p.X_12 + q.y() * p.X_22;
    Mat2 third_q; // e . q_a X,acd
    third_q(0, 0) = e.dot(q.x() * third.X_111 + q.y() * third.X_112);
    third_q(0, 1) = third_q(1, 0) = e.dot(q.x() * third.X_112 + q.y() * third.X_122);
    third_q(1, 1) = e.dot(q.x() * third.X_122 + q.y() * third.X_222);

    Rows2 N = Rows2::Zero(), R = Rows2::Zero(); // n.Phi_i,a dx_i;  e.(q_a Phi_i,ac) dx_i - X_q.Phi_i,c dx_i
    Rows3 A = X_qc * U, E = -p.X_a * U;         // q_a dX,a and d(s - X), totals
    E.leftCols<3>() += Mat3::Identity();
    E.middleCols<3>(phi) -= Mat3::Identity();
    for (int c = 0; c < 2; ++c) {
        N.block<1, 3>(c, phi_a + 3 * c) = a.normal.transpose();
        A.middleCols<3>(phi_a + 3 * c) += q(c) * Mat3::Identity();
        R.block<1, 3>(c, phi_a + 3 * c) = -X_q.transpose();
        for (int d = 0; d < 2; ++d) R.block<1, 3>(c, phi_ab + 3 * (c + d)) += q(d) * e.transpose();
    }
    const double rest = 1 - a.tau, by_tau = -3 * rest * rest; // dpsi/dtau
    const double by_u = (a.gap - g) * by_tau * 2 * patch.kappa;
    const Rows2 B = N + b * U;
    left << U, A, B, first.dpsi;
    right << a.psi * (-N - 0.5 * b * U) + by_u * (R + 0.5 * (third_q - p.curvature(X_q) + patch.metric) * U), by_u * E,
        (0.5 * a.psi * a.gap) * (metric.inverse() * B), first.dg;
    if (rest > 0) right.row(7) += ((a.gap - g) * 3 * rest / (by_tau * by_tau)) * first.dpsi;
}

/// Moments' rows over the patch's own y: into += rows times moments.
template <int rows, class Into>
void expand(const Eigen::Matrix<double, rows, PatchVariation::size>& moments, const PatchVariation& patch,
            Into&& into) {
    into.template leftCols<3>() += moments.template leftCols<3>();
    for (Index i = 0; i < patch.phi.cols(); ++i)
        for (int k = 0; k < PatchVariation::derivatives; ++k)
            into.template middleCols<3>(3 + 3 * i) += patch.phi(k, i) * moments.template middleCols<3>(3 + 3 * k);
}

/// The same over the y of the blend.
template <int rows, class Into>
void scatter(const Eigen::Matrix<double, rows, PatchVariation::size>& moments, const PatchVariation& patch,
             Into& into) {
    into.template leftCols<3>() += moments.template leftCols<3>();
    for (std::size_t i = 0; i < patch.place.size(); ++i)
        for (int k = 0; k < PatchVariation::derivatives; ++k)
            into.template middleCols<3>(3 + 3 * patch.place[i]) +=
                patch.phi(k, static_cast<Index>(i)) * moments.template middleCols<3>(3 + 3 * k);
}

} // namespace

void vary_blend(const std::vector<ActivePatch>& active, const Vec3& s, const ContactPoint& point,
                ContactVariation& variation) {
    const auto n = static_cast<Index>(point.nodes.size());
    const Index m = 3 + 3 * n;
    const double g = point.gap;
    double P = 0;
    for (const ActivePatch& a : active) P += a.psi;

    static thread_local std::vector<Moments8> left, right;
    left.resize(active.size());
    right.resize(active.size());
    variation.patches.resize(active.size());
    Row dg = Row::Zero(m), dpsi = Row::Zero(m);
    Rows3 top = Rows3::Zero(3, m); // the rows of s of the second variation, which the normal takes
    for (std::size_t v = 0; v < active.size(); ++v) {
        const ActivePatch& a = active[v];
        PatchVariation& patch = variation.patches[v];
        const FirstMoments first = first_moments(a);
        second_variation(a, first, s, g, left[v], right[v]);
        patch.place = a.place;
        patch.phi.resize(PatchVariation::derivatives, a.phi.size());
        patch.phi.row(0) = a.phi.transpose();
        patch.phi.middleRows<2>(1) = a.phi_a.transpose();
        patch.phi.bottomRows<3>() = a.patch->shape.second_derivatives(a.foot.u).transpose();
        patch.second.noalias() = left[v].transpose() * right[v];
        patch.second += patch.second.transpose().eval();
        patch.first = (a.psi * first.dg + (a.gap - g) * first.dpsi) / P;
        patch.dpsi = first.dpsi;
        patch.du = a.psi * first.du;
        scatter<1>(patch.first, patch, dg);
        scatter<1>(patch.dpsi, patch, dpsi);
        scatter<3>(patch.second.topRows<3>(), patch, top);
    }
    top -= dpsi.leftCols<3>().transpose() * dg + dg.leftCols<3>().transpose() * dpsi;
    top /= P;
    const double slope = dg.leftCols<3>().norm();
    const Vec3& normal = point.normal;
    const Row dslope = normal.transpose() * top;
    variation.dg = dg;
    variation.dn = (top - normal * dslope) / slope;
    variation.bumps = P;
    variation.slope = slope;
    if (variation.form != VariationForm::matrices) return;

    static thread_local Matrix half, own_half, own_weights; // the second variation is half + half^T
    static thread_local Rows8 own_left, own_right;
    static thread_local Rows2 own_du;
    static thread_local Row own_dpsi;
    half.setZero(m, m);
    variation.dweights.setZero(n, m);
    for (std::size_t v = 0; v < active.size(); ++v) {
        const PatchVariation& patch = variation.patches[v];
        const auto own = static_cast<Index>(patch.place.size());
        const auto expanded = [&](const auto& moments, auto& into) {
            into.setZero(moments.rows(), 3 + 3 * own);
            expand(moments, patch, into);
        };
        expanded(left[v], own_left);
        expanded(right[v], own_right);
        expanded(patch.du, own_du);
        expanded(patch.dpsi, own_dpsi);
        own_half.noalias() = own_left.transpose() * own_right;
        own_weights.noalias() = patch.phi.middleRows<2>(1).transpose() * own_du;
        own_weights.noalias() +=
            patch.phi.row(0).transpose() * own_dpsi; // d(psi Phi_i) = psi Phi_i,a du_a + dpsi Phi_i
        const auto at = [&](Index k) {
            return k == 0 ? Index{0} : 3 + 3 * patch.place[static_cast<std::size_t>(k - 1)];
        };
        for (Index k = 0; k <= own; ++k)
            for (int c = 0; c < 3; ++c) {
                const double *from = &own_half(0, 3 * k + c), *weight = &own_weights(0, 3 * k + c);
                double *to = &half(0, at(k) + c), *into = &variation.dweights(0, at(k) + c);
                for (Index i = 0; i <= own; ++i)
                    for (int r = 0; r < 3; ++r) to[at(i) + r] += from[3 * i + r];
                for (Index i = 0; i < own; ++i) into[patch.place[static_cast<std::size_t>(i)]] += weight[i];
            }
    }
    variation.patches.clear();
    half.noalias() -= dpsi.transpose() * dg;
    half /= P;
    variation.dweights.noalias() -= point.weights * dpsi;
    variation.dweights /= P;
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
