#include "osculate/model/moment_factors.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace osculate::model {

namespace {

constexpr double largest_exponent = 10; ///< of a factor: what is further from 1 is no redistribution
constexpr int most_iterations = 100, most_halvings = 40;
constexpr double tolerance = 1e-13; ///< of the mass, for every moment

/// The convex function sum_p m_p a_p(l) - l . target and its derivatives.
struct Dual {
    Vector factors;
    double value = 0;
    Moments gradient = Moments::Zero();
    Eigen::Matrix<double, 10, 10> hessian = Eigen::Matrix<double, 10, 10>::Zero();
    bool within = true; ///< no exponent is too large
};

Dual dual(const Eigen::Matrix<double, 10, Eigen::Dynamic>& parts, const Moments& target, const Moments& l) {
    Dual d;
    d.factors.resize(parts.cols());
    for (Index p = 0; p < parts.cols(); ++p) {
        const double mass = parts(0, p), exponent = l.dot(parts.col(p)) / mass;
        if (!(std::abs(exponent) <= largest_exponent)) {
            d.within = false;
            return d;
        }
        const double a = std::exp(exponent);
        d.factors(p) = a;
        d.value += mass * a;
        d.gradient += a * parts.col(p);
        d.hessian.noalias() += (a / mass) * parts.col(p) * parts.col(p).transpose();
    }
    d.value -= l.dot(target);
    d.gradient -= target;
    return d;
}

/// -H^+ g: directions in which parts cannot differ, as across a bar of one element, are left alone.
Moments newton_step(const Dual& d) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 10, 10>> eigen(d.hessian);
    const double least = 1e-11 * eigen.eigenvalues()(9);
    Moments step = Moments::Zero();
    for (Index k = 0; k < 10; ++k) {
        const Moments v = eigen.eigenvectors().col(k);
        if (eigen.eigenvalues()(k) > least) step -= v * (v.dot(d.gradient) / eigen.eigenvalues()(k));
    }
    return step;
}

} // namespace

Moments moments(const Matrix& mass, const Eigen::Matrix3Xd& x) {
    const Vector rows = mass.rowwise().sum();
    const Vec3 first = x * rows;
    const Mat3 second = x * mass * x.transpose();
    Moments m;
    m << rows.sum(), first, second(0, 0), second(1, 1), second(2, 2), second(0, 1), second(1, 2), second(2, 0);
    return m;
}

std::optional<Vector> moment_factors(const Eigen::Matrix<double, 10, Eigen::Dynamic>& parts, const Moments& target) {
    if (parts.cols() == 0) return std::nullopt;
    Moments l = Moments::Zero();
    Dual now = dual(parts, target, l);
    const auto error = [&](const Dual& d) { return d.gradient.cwiseAbs().maxCoeff() / target(0); };
    for (int k = 0; k < most_iterations; ++k) {
        const Moments step = newton_step(now);
        bool better = false;
        double length = 1;
        for (int h = 0; h < most_halvings && !better; ++h, length /= 2) {
            Dual next = dual(parts, target, l + length * step);
            // near the solution the function's value is round-off and its gradient is not
            if (!next.within || !(next.value < now.value || error(next) < error(now))) continue;
            better = true;
            l += length * step;
            now = std::move(next);
        }
        if (!better) break;
    }
    if (!(error(now) <= tolerance)) return std::nullopt;
    return now.factors;
}

} // namespace osculate::model
