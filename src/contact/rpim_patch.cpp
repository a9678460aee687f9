#include "osculate/contact/rpim_patch.hpp"

#include "contact/rpim_kernels.hpp"
#include "osculate/core/dense_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <limits>
#include <numbers>

namespace osculate::contact {

ReferencePlane ReferencePlane::through(const Vec3& origin, const Vec3& n) {
    // eq (20) with (1 - n3)/(n1^2 + n2^2) = 1/(1 + n3), which has no 0/0 at n = e3; mirrored for n3 < 0.
    const double sign = n.z() < 0 ? -1 : 1;
    const double k = 1 / (1 + sign * n.z());
    ReferencePlane plane;
    plane.origin = origin;
    plane.axes.col(0) = Vec3(1 - n.x() * n.x() * k, -n.x() * n.y() * k, -sign * n.x());
    plane.axes.col(1) = n.cross(plane.axes.col(0));
    return plane;
}

Vec2 ReferencePlane::equal_length(const Vec3& x) const {
    const Vec2 projected = tangential(x);
    const double length = projected.norm();
    if (length == 0) return projected;
    return projected * ((x - origin).norm() / length);
}

namespace {

/// Smallest ratio of singular values of the column-scaled polynomial matrix that still counts as full rank.
constexpr double rank_tolerance = 1e-6;
/// Smallest standard deviation of a quadratic polynomial over the nodes, after the best linear one is taken off, that is no
/// accident: nodes in two rows determine no quadratic across them, but rows that are bent a little seem to. The polynomial is
/// one of unit length in coordinates in which the nodes have unit variance in all directions.
constexpr double determined = 0.2;
/// Nodes closer than this fraction of dc count as one: their two rows of G are the same but for round-off.
constexpr double same_node = 0.01;

/// p(t) = [1 x y | xx xy yy]                                                              [Qian 2014, eqs (11)-(12)]
Matrix polynomial_matrix(const MatrixX2& t, int m) {
    Matrix D(t.rows(), m);
    D.col(0).setOnes();
    D.col(1) = t.col(0);
    D.col(2) = t.col(1);
    if (m == 6) {
        D.col(3) = t.col(0).cwiseAbs2();
        D.col(4) = t.col(0).cwiseProduct(t.col(1));
        D.col(5) = t.col(1).cwiseAbs2();
    }
    return D;
}

bool full_rank(Matrix D) {
    if (D.rows() < D.cols()) return false;
    for (Index j = 0; j < D.cols(); ++j) {
        const double norm = D.col(j).norm();
        if (norm == 0) return false;
        D.col(j) /= norm;
    }
    const Vector s = singular_values(D);
    return s(s.size() - 1) > rank_tolerance * s(0);
}

/// Distance of every node to the nearest other one.
Vector nearest_distances(const MatrixX2& u) {
    Vector distance(u.rows());
    for (Index i = 0; i < u.rows(); ++i) {
        double nearest = std::numeric_limits<double>::max();
        for (Index j = 0; j < u.rows(); ++j)
            if (j != i) nearest = std::min(nearest, (u.row(i) - u.row(j)).squaredNorm());
        distance(i) = std::sqrt(nearest);
    }
    return distance;
}

} // namespace

Matrix determined_polynomials(const MatrixX2& u) {
    const double n = static_cast<double>(u.rows());
    const MatrixX2 centred = u.rowwise() - u.colwise().mean();
    const Mat2 covariance = centred.transpose() * centred / n;
    const Eigen::SelfAdjointEigenSolver<Mat2> axes(covariance);
    if (!(axes.eigenvalues()(0) > 0)) return Matrix::Identity(6, 3);
    const Mat2 A = axes.operatorInverseSqrt();
    const Matrix D = polynomial_matrix(centred * A, 6);
    Matrix quadratic = D.rightCols<3>();
    quadratic.col(1) *= std::numbers::sqrt2; // turns of the axes turn the three then
    quadratic -= D.leftCols<3>() * fit_columns(D.leftCols<3>(), quadratic);
    const Mat3 variances = quadratic.transpose() * quadratic / n;
    const auto [sizes, modes] = principal_axes(variances); // ascending
    int k = 0;
    while (k < 3 && sizes(2 - k) > determined * determined) ++k;
    constexpr Index linear = 3;
    if (k == 3) return Matrix::Identity(6, u.rows() > 6 ? 6 : linear);
    if (u.rows() < linear + k + 1) k = 0; // as many terms as nodes only follow them
    Mat3 in_u;                            // w1 w1, sqrt2 w1 w2 and w2 w2, w = A u, in xx, xy and yy
    in_u.row(0) << A(0, 0) * A(0, 0), 2 * A(0, 0) * A(0, 1), A(0, 1) * A(0, 1);
    in_u.row(1) << A(0, 0) * A(1, 0), A(0, 0) * A(1, 1) + A(0, 1) * A(1, 0), A(0, 1) * A(1, 1);
    in_u.row(1) *= std::numbers::sqrt2;
    in_u.row(2) << A(1, 0) * A(1, 0), 2 * A(1, 0) * A(1, 1), A(1, 1) * A(1, 1);
    Matrix Z = Matrix::Zero(6, linear + k);
    Z.topLeftCorner<3, 3>().setIdentity();
    for (int j = 0; j < k; ++j) Z.col(linear + j).tail<3>() = (in_u.transpose() * modes.col(2 - j)).normalized();
    return Z;
}

std::optional<RpimPatch> RpimPatch::fit(const MatrixX2& u, const Multiquadric& basis, int m) {
    const bool quadratic = m == 6 && determined_polynomials(u).cols() == 6;
    return fit(u, basis, quadratic ? Matrix::Identity(6, 6) : Matrix::Identity(3, 3));
}

std::optional<RpimPatch> RpimPatch::fit(const MatrixX2& u, const MatrixX2& flat,
                                        const std::optional<Multiquadric>& basis, const Multiquadric& suited, int m) {
    if (m == 6)
        if (const Matrix Z = determined_polynomials(flat); Z.cols() < 6) return fit(u, basis ? *basis : r3, Z);
    auto patch = fit(u, basis ? *basis : suited, m);
    if (!basis && (!patch || patch->polynomial_terms() < m)) patch = fit(u, r3, m); // r^5 needs quadratics
    return patch;
}

std::optional<RpimPatch> RpimPatch::fit(const MatrixX2& u, const Multiquadric& basis, const Matrix& polynomials) {
    const Index n = static_cast<Index>(u.rows());
    if (n < 3) return std::nullopt;
    RpimPatch patch;
    patch.n_ = n;
    patch.basis_ = basis;
    patch.c_ = u.colwise().mean().transpose();
    const Vector nearest = nearest_distances(u);
    patch.dc_ = nearest.mean();
    if (!(nearest.minCoeff() > same_node * patch.dc_)) return std::nullopt;
    const MatrixX2 t = (u.rowwise() - patch.c_.transpose()) / patch.dc_;

    const Matrix& Z = polynomials;
    patch.m_ = static_cast<int>(Z.rows());
    patch.terms_ = static_cast<int>(Z.cols());
    const Matrix all = polynomial_matrix(t, patch.m_), D = all * Z;
    if (!full_rank(D)) return std::nullopt;

    // G = [[C, D], [D^T, 0]]                                                            [Qian 2014, eqs (13)-(14)]
    const Index terms = Z.cols();
    Matrix G = Matrix::Zero(n + terms, n + terms);
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) G(i, j) = basis((t.row(i) - t.row(j)).squaredNorm()).f;
    G.topRightCorner(n, terms) = D;
    G.bottomLeftCorner(terms, n) = D.transpose();
    const Matrix H = solve_square(G, Matrix::Identity(n + terms, n));
    if (!H.allFinite()) return std::nullopt;
    patch.size_ = kernels::padded(n);
    patch.width_ = kernels::padded(n + patch.m_);
    const auto numbers = std::make_shared<double[]>(patch.numbers()); // zeros
    patch.numbers_ = numbers;
    const auto rows = [&](const double* first, Index count, Index width) {
        return Eigen::Map<Rows>(numbers.get() + (first - patch.t()), count, width);
    };
    rows(patch.t(), 2, patch.width_).leftCols(n) = t.transpose();
    Eigen::Map<Rows> all_H = rows(patch.H(), n + patch.m_, patch.size_);
    all_H.topLeftCorner(n, n) = H.topRows(n);
    all_H.bottomLeftCorner(patch.m_, n) = Z * H.bottomRows(terms);
    rows(patch.D(), patch.m_, patch.size_).leftCols(n) = all.transpose();
    rows(patch.fit(), patch.m_, patch.size_).leftCols(n) = Z * fit_columns(D, Matrix::Identity(n, n));
    return patch;
}

std::shared_ptr<const std::vector<double>> RpimPatch::put_together(std::span<RpimPatch* const> patches) {
    std::size_t count = 0;
    for (const RpimPatch* patch : patches) count += patch->numbers();
    const auto all = std::make_shared<std::vector<double>>();
    all->reserve(count);
    for (RpimPatch* patch : patches) {
        const double* const first = all->data() + all->size();
        all->insert(all->end(), patch->t(), patch->t() + patch->numbers());
        patch->numbers_ = {all, first};
    }
    return all;
}

} // namespace osculate::contact
