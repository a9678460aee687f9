#include "contact/rpim_kernels.hpp"
#include "osculate/contact/rpim_patch.hpp"

namespace osculate::contact {

MatrixX3 RpimPatch::coefficients(const MatrixX3& x) const {
    MatrixX3 padded = MatrixX3::Zero(padded_size(), 3), result;
    padded.topRows(n_) = x;
    coefficients(padded, result);
    return result;
}

void RpimPatch::coefficients(MatrixX3& x, MatrixX3& result) const {
    // H D = [0; 1]: what a polynomial fits passes through H unchanged but for round-off, which for the rest is smaller
    result.resize(width_, 3);
    kernels::coefficients(H(), n_ + m_, D(), fit(), m_, padded_size(), x.data(), width_, result.data());
}

void RpimPatch::tabulate(const Vec2& u, int rows, BasisTable& table) const {
    const Vec2 t = (u - c_) / dc_;
    table.width = width_;
    table.rows = rows;
    if (const auto needed = static_cast<std::size_t>(width_) * static_cast<std::size_t>(rows);
        table.entries.size() < needed)
        table.entries.resize(needed);
    kernels::radial_rows(basis_, this->t(), this->t() + width_, width_, t, dc_, rows, table.entries.data());
    const double a = 1 / dc_, b = a * a; // chain rule of t(u)
    const double x = t.x(), y = t.y();
    const auto put = [&](int r, double one, double by_x, double by_y, double xx, double xy, double yy) {
        double* const behind = table.row(r) + n_;
        behind[0] = one;
        behind[1] = by_x;
        behind[2] = by_y;
        if (m_ < 6) return;
        behind[3] = xx;
        behind[4] = xy;
        behind[5] = yy;
    };
    put(0, 1, x, y, x * x, x * y, y * y);
    put(1, 0, a, 0, 2 * a * x, a * y, 0);
    put(2, 0, 0, a, 0, a * x, 2 * a * y);
    if (rows == BasisTable::first) return;
    put(3, 0, 0, 0, 2 * b, 0, 0);
    put(4, 0, 0, 0, 0, b, 0);
    put(5, 0, 0, 0, 0, 0, 2 * b);
    for (int r = BasisTable::second; r < rows; ++r) put(r, 0, 0, 0, 0, 0, 0);
}

namespace {
thread_local BasisTable scratch;

using Sums = Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>>;
} // namespace

PatchPoint RpimPatch::point(const Vec2& u, const MatrixX3& coefficients) const {
    tabulate(u, BasisTable::second, scratch);
    return point(scratch, coefficients);
}

PatchPoint RpimPatch::point(const BasisTable& table, const MatrixX3& coefficients) const {
    double sums[3 * BasisTable::second];
    kernels::sums(table.row(0), table.width, BasisTable::second, coefficients.data(), sums);
    const Sums X(sums, 3, BasisTable::second);
    PatchPoint p;
    p.X = X.col(0);
    p.X_a = X.middleCols<2>(1);
    p.X_11 = X.col(3);
    p.X_12 = X.col(4);
    p.X_22 = X.col(5);
    return p;
}

void RpimPatch::weights(const Vec2& u, Eigen::Ref<Vector> phi, Eigen::Ref<MatrixX2> phi_a) const {
    tabulate(u, BasisTable::first, scratch);
    static thread_local Rows all;
    all.resize(BasisTable::first, padded_size());
    weights(scratch, BasisTable::first, BasisTable::first, all.data());
    phi = all.row(0).head(n_).transpose();
    phi_a = all.bottomLeftCorner(2, n_).transpose();
}

void RpimPatch::weights(const BasisTable& table, int rows, int exact, double* phi) const {
    kernels::times(table.row(0), table.width, rows, H(), n_ + m_, padded_size(), phi);
    // D^T Phi = p to the last digit, as in coefficients(): forces and moments then balance
    kernels::reproduce(table.row(0) + n_, table.width, exact, D(), fit(), m_, padded_size(), phi);
}

MatrixX3 RpimPatch::second_derivatives(const Vec2& u) const {
    tabulate(u, BasisTable::second, scratch);
    Rows phi_ab(3, padded_size());
    kernels::times(scratch.row(3), scratch.width, 3, H(), n_ + m_, padded_size(), phi_ab.data());
    return phi_ab.leftCols(n_).transpose();
}

PatchThird RpimPatch::third(const Vec2& u, const MatrixX3& coefficients) const {
    tabulate(u, BasisTable::third, scratch);
    return third(scratch, coefficients);
}

PatchThird RpimPatch::third(const BasisTable& table, const MatrixX3& coefficients) const {
    constexpr int count = BasisTable::third - BasisTable::second;
    double sums[3 * count];
    kernels::sums(table.row(BasisTable::second), table.width, count, coefficients.data(), sums);
    const Sums X(sums, 3, count);
    return {X.col(0), X.col(1), X.col(2), X.col(3)};
}

} // namespace osculate::contact
