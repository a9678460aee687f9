#include "contact/blend_variation.hpp"

#include "contact/rpim_kernels.hpp"

#include <algorithm>

namespace osculate::contact {

namespace {

using Rows2 = Eigen::Matrix<double, 2, Eigen::Dynamic>;
using Row = Eigen::Matrix<double, 1, Eigen::Dynamic>;
using Rows8 = Eigen::Matrix<double, 8, Eigen::Dynamic>;
/// Rows over the moments z of PatchVariation, filled up with zeros as the kernels want them.
constexpr int all_moments = kernels::padded(PatchVariation::size);
template <int rows> using Moments = Eigen::Matrix<double, rows, all_moments, Eigen::RowMajor>;

/// First variations of the foot, of psi, and of the gap of one patch over the moments z of PatchVariation.
struct FirstMoments {
    Moments<2> du;
    Moments<1> dg, dpsi;
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
    first.dpsi = a.by_foot.x() * first.du.row(0) + a.by_foot.y() * first.du.row(1);
    return first;
}

/// Second variations of psi_v g_v / P, but for the terms that couple it with the blended gap:
///   psi dDg_v + dpsi Dg_v + Dpsi dg_v + (g_v - g) dDpsi
/// with n.dX,a of the moving nodes alone (N), B = N + b du, and dDu from differentiating (s - X).X,a = 0 twice. Given over
/// the moments z as half + half^T with half = left^T right.
/// @param p, third  the patch at its foot
/// @param e         s - X
void second_variation(const ActivePatch& a, const PatchPoint& p, const PatchThird& third, const FirstMoments& first,
                      const Vec3& e, double g, Moments<8>& left, Moments<8>& right) {
    constexpr int phi = 3, phi_a = 6, phi_ab = 12; // where their moments begin
    const VertexPatch& patch = *a.patch;
    const Moments<2>& U = first.du;
    const Mat2 b = p.curvature(a.normal), metric = p.X_a.transpose() * p.X_a;
    const Vec2 Mu = patch.metric * (a.foot.u - patch.origin);
    const Vec2 q = (metric - a.gap * b).inverse() * Mu; // (M u) . dDu = q . dDF
    const Vec3 X_q = p.X_a * q;
    Matrix32 X_qc; // q_a X,ac
    X_qc.col(0) = q.x() * p.X_11 + q.y() * p.X_12;
    X_qc.col(1) = q.x() * p.X_12 + q.y() * p.X_22;
    Mat2 third_q; // e . q_a X,acd
    third_q(0, 0) = e.dot(q.x() * third.X_111 + q.y() * third.X_112);
    third_q(0, 1) = third_q(1, 0) = e.dot(q.x() * third.X_112 + q.y() * third.X_122);
    third_q(1, 1) = e.dot(q.x() * third.X_122 + q.y() * third.X_222);

    Moments<2> N = Moments<2>::Zero(),
               R = Moments<2>::Zero(); // n.Phi_i,a dx_i;  e.(q_a Phi_i,ac) dx_i - X_q.Phi_i,c dx_i
    Moments<3> A = X_qc.lazyProduct(U), E = -p.X_a.lazyProduct(U); // q_a dX,a and d(s - X), totals
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
    const Moments<2> B = N + b.lazyProduct(U);
    const Mat2 by_U = by_u * (third_q - p.curvature(X_q) + patch.metric) - a.psi * b;
    left << U, A, B, first.dpsi;
    right << by_u * R - a.psi * N + 0.5 * by_U.lazyProduct(U), by_u * E,
        (0.5 * a.psi * a.gap * metric.inverse()).eval().lazyProduct(B), first.dg;
    if (rest > 0) right.row(7) += ((a.gap - g) * 3 * rest / (by_tau * by_tau)) * first.dpsi;
}

/// Moments' rows over the patch's own y: into += rows times moments.
template <class Rows, class Into> void expand(const Rows& moments, const PatchVariation& patch, Into&& into) {
    into.template leftCols<3>() += moments.template leftCols<3>();
    for (Index i = 0; i < patch.phi.cols(); ++i)
        for (int k = 0; k < PatchVariation::derivatives; ++k)
            into.template middleCols<3>(3 + 3 * i) += patch.phi(k, i) * moments.template middleCols<3>(3 + 3 * k);
}

/// left^T right of the first `count` moments of left.
template <int count> Moments<count> product(const Moments<8>& left, const Moments<8>& right) {
    const Eigen::Matrix<double, count, 8, Eigen::RowMajor> transposed = left.leftCols<count>().transpose();
    Moments<count> result;
    kernels::times(transposed.data(), 8, count, right.data(), 8, all_moments, result.data());
    return result;
}

/// Rows of the blend's variations, three numbers each: of gap, of the bump, and of dg/ds.
constexpr int of_gap = 0, of_bump = 3, of_slope = 6, all_rows = 15;
using PerNode = Eigen::Matrix<double, all_rows, 1>;

/// Adds rows of moments times the moments' weights to those of s and of the nodes.
/// @param rows  (5 x size) of gap, of the bump, and three of dg/ds
/// @param phi   (derivatives x stride) as in PatchVariation, row by row
void scatter(const Moments<5>& rows, const std::vector<Index>& place, const double* phi, Index stride, PerNode& of_s,
             std::vector<PerNode>& of_node) {
    constexpr int derivatives = PatchVariation::derivatives;
    double by_moment[all_rows * derivatives];
    for (int r = 0; r < 5; ++r)
        for (int c = 0; c < 3; ++c) {
            of_s(3 * r + c) += rows(r, c);
            for (int k = 0; k < derivatives; ++k) by_moment[(3 * r + c) * derivatives + k] = rows(r, 3 + 3 * k + c);
        }
    static thread_local std::vector<double> products;
    products.resize(std::max(products.size(), static_cast<std::size_t>(all_rows * stride)));
    kernels::times(by_moment, derivatives, all_rows, phi, derivatives, stride, products.data());
    for (std::size_t i = 0; i < place.size(); ++i)
        for (int r = 0; r < all_rows; ++r) of_node[place[i]](r) += products[static_cast<std::size_t>(r * stride) + i];
}

} // namespace

void vary_blend(const std::vector<ActivePatch>& active, const Vec3& s, const ContactPoint& point,
                ContactVariation& variation) {
    const auto n = static_cast<Index>(point.nodes.size());
    const Index m = 3 + 3 * n;
    const double g = point.gap;
    const bool gap_alone = variation.form == VariationForm::gap;
    double P = 0;
    for (const ActivePatch& a : active) P += a.psi;

    static thread_local std::vector<Moments<8>> left, right;
    static thread_local std::vector<PerNode> of_node;
    static thread_local std::vector<double> phi;
    static thread_local BasisTable table;
    static thread_local std::vector<Index> number, place; // of a vertex among the point's nodes
    left.resize(active.size());
    right.resize(active.size());
    of_node.assign(static_cast<std::size_t>(n), PerNode::Zero());
    PerNode of_s = PerNode::Zero();
    number.resize(std::max(number.size(), static_cast<std::size_t>(point.nodes.back()) + 1));
    for (Index i = 0; i < n; ++i) number[point.nodes[i]] = i;
    if (!gap_alone) variation.patches.resize(active.size());
    for (std::size_t v = 0; v < active.size(); ++v) {
        const ActivePatch& a = active[v];
        const RpimPatch& shape = a.patch->shape;
        const Index stride = shape.padded_size();
        phi.resize(std::max(phi.size(), static_cast<std::size_t>(PatchVariation::derivatives * stride)));
        shape.tabulate(a.foot.u, BasisTable::third, table);
        shape.weights(table, PatchVariation::derivatives, BasisTable::first, phi.data());
        const PatchPoint p = shape.point(table, a.placed->coefficients);
        const PatchThird third = shape.third(table, a.placed->coefficients);
        const FirstMoments first = first_moments(a);
        second_variation(a, p, third, first, s - a.foot.point.X, g, left[v], right[v]);

        place.clear();
        for (const Index vertex : a.patch->vertices) place.push_back(number[vertex]);
        Moments<5> rows;
        rows.row(0) = (a.psi * first.dg + (a.gap - g) * first.dpsi) / P;
        rows.row(1) = first.dpsi;
        rows.bottomRows<3>() = product<3>(left[v], right[v]) + product<3>(right[v], left[v]);
        scatter(rows, place, phi.data(), stride, of_s, of_node);
        if (gap_alone) continue;

        PatchVariation& patch = variation.patches[v];
        patch.place = place;
        patch.phi =
            Eigen::Map<const Eigen::Matrix<double, PatchVariation::derivatives, Eigen::Dynamic, Eigen::RowMajor>>(
                phi.data(), PatchVariation::derivatives, stride)
                .leftCols(shape.size());
        patch.second = product<PatchVariation::size>(left[v], right[v]).leftCols<PatchVariation::size>();
        patch.second += patch.second.transpose().eval();
        patch.first = rows.row(0).head<PatchVariation::size>();
        patch.dpsi = first.dpsi.head<PatchVariation::size>();
        patch.du = a.psi * first.du.leftCols<PatchVariation::size>();
    }
    variation.bumps = P;
    variation.slope = of_s.segment<3>(of_gap).norm();
    const double slope = variation.slope;
    const Vec3& normal = point.normal;
    const bool matrices = variation.form == VariationForm::matrices;
    static thread_local Row dpsi, dslope;
    variation.dg.resize(m);
    variation.dn.resize(3, m);
    if (matrices) {
        dpsi.resize(m);
        dslope.resize(m);
    }
    // d(dg/ds) = 1/P (top - dpsi/ds dg - dg/ds dpsi),  dn = (I - n n^T) d(dg/ds) / |dg/ds|
    const auto finish = [&](Index column, const PerNode& all) {
        const Eigen::RowVector3d dg = all.segment<3>(of_gap), bump = all.segment<3>(of_bump);
        Mat3 top = all.segment<9>(of_slope).reshaped<Eigen::RowMajor>(3, 3);
        top -= of_s.segment<3>(of_bump) * dg + of_s.segment<3>(of_gap) * bump;
        top /= P;
        const Eigen::RowVector3d turn = normal.transpose() * top;
        variation.dg.segment<3>(column) = dg;
        variation.dn.middleCols<3>(column) = (top - normal * turn) / slope;
        if (!matrices) return;
        dpsi.segment<3>(column) = bump;
        dslope.segment<3>(column) = turn;
    };
    finish(0, of_s);
    for (Index i = 0; i < n; ++i) finish(3 + 3 * i, of_node[i]);
    const Row& dg = variation.dg;
    if (!matrices) return;

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
