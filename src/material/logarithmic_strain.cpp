#include "logarithmic_strain.hpp"

#include "osculate/material/voigt.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace osculate::material {
namespace {
constexpr std::array<std::array<int, 2>, 6> pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};

/// The symmetric tensor of which a component of a strain vector is the factor.
Mat3 unit_strain(std::size_t component) {
    const auto [i, j] = pairs[component];
    Mat3 A = Mat3::Zero();
    A(i, j) += 0.5;
    A(j, i) += 0.5;
    return A;
}
} // namespace

LogarithmicStrain::LogarithmicStrain(const Mat3& E) {
    const Eigen::SelfAdjointEigenSolver<Mat3> solver((E + E.transpose()) / 2); // QR: to the last digits of each
    x_ = solver.eigenvalues();
    axes_ = solver.eigenvectors();
    const Vec3 logarithms = (2 * x_.array()).log1p() / 2;
    value_ = axes_ * logarithms.asDiagonal() * axes_.transpose();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) slopes_(i, j) = first(i, j);
}

double LogarithmicStrain::first(int i, int j) const {
    const double y = 1 + 2 * x_[std::min(i, j)], z = 2 * std::abs(x_[i] - x_[j]) / y; // ascending
    return (z == 0 ? 1 : std::log1p(z) / z) / y;
}

double LogarithmicStrain::second(int i, int j, int k) const {
    std::array<int, 3> order{i, j, k};
    std::ranges::sort(order);
    const double gap = x_[order[2]] - x_[order[0]], mean = (x_[i] + x_[j] + x_[k]) / 3, y = 1 + 2 * mean;
    constexpr double close = 1e-4;
    if (2 * gap > close * y) return (slopes_(order[1], order[2]) - slopes_(order[0], order[1])) / gap;
    // Taylor's series about the mean: g''/2 + g'''' (sum of squares)/48
    const double squares = (x_.array() - mean)
                               .square()
                               .matrix()
                               .dot(Vec3(1.0 * (i == 0) + (j == 0) + (k == 0), 1.0 * (i == 1) + (j == 1) + (k == 1),
                                         1.0 * (i == 2) + (j == 2) + (k == 2)));
    return -1 / (y * y) - squares / (y * y * y * y);
}

Mat3 LogarithmicStrain::conjugate(const Mat3& T) const {
    return axes_ * (axes_.transpose() * T * axes_).cwiseProduct(slopes_) * axes_.transpose();
}

Mat6 LogarithmicStrain::tangent(const Mat6& D, const Mat3& T) const {
    Mat6 P; // strain vectors: de = P dE
    std::array<Mat3, 6> local;
    for (std::size_t s = 0; s < 6; ++s) {
        local[s] = axes_.transpose() * unit_strain(s) * axes_;
        P.col(static_cast<Eigen::Index>(s)) = strain_vector(axes_ * local[s].cwiseProduct(slopes_) * axes_.transpose());
    }
    Mat6 result = P.transpose() * D * P;
    const Mat3 t = axes_.transpose() * T * axes_;
    // d2e[A, B]_ij = sum_k g[i, k, j] (A_ik B_kj + B_ik A_kj); symmetric T takes both alike
    std::array<Mat3, 3> weights; // by k: T_ij g[i, k, j]
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) weights[static_cast<std::size_t>(k)](i, j) = 2 * t(i, j) * second(i, k, j);
    for (std::size_t r = 0; r < 6; ++r)
        for (std::size_t s = r; s < 6; ++s) {
            double sum = 0;
            for (int k = 0; k < 3; ++k)
                sum += local[r].col(k).dot(weights[static_cast<std::size_t>(k)] * local[s].col(k));
            result(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(s)) += sum;
            if (r != s) result(static_cast<Eigen::Index>(s), static_cast<Eigen::Index>(r)) += sum;
        }
    return (result + result.transpose()) / 2;
}

} // namespace osculate::material
