#include "solve/friction_cones.hpp"

#include "osculate/solve/dense_lu.hpp"
#include "solve/friction_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace osculate::solve {

namespace {

// Points of Lorentz's cone L: x_0 >= |x_1, x_2|.
double determinant(const Vec3& x) {
    return (x(0) - x.tail<2>().norm()) * (x(0) + x.tail<2>().norm());
}

/// Jordan product.
Vec3 times(const Vec3& x, const Vec3& y) {
    Vec3 z;
    z << x.dot(y), x(0) * y.tail<2>() + y(0) * x.tail<2>();
    return z;
}

/// y with times(x, y) = z.
Vec3 divided(const Vec3& z, const Vec3& x) {
    const double det = determinant(x), xz = x.tail<2>().dot(z.tail<2>());
    Vec3 y;
    y(0) = (x(0) * z(0) - xz) / det;
    y.tail<2>() = (z.tail<2>() - y(0) * x.tail<2>()) / x(0);
    return y;
}

/// How far x may go along d within L; infinite if it never leaves.
double longest(const Vec3& x, const Vec3& d) {
    // on the boundary (x + a d) * (x + a d) = c + 2 b a + e a^2 = 0, with p * q = p_0 q_0 - p_1 q_1 - p_2 q_2
    const auto product = [](const Vec3& p, const Vec3& q) { return p(0) * q(0) - p.tail<2>().dot(q.tail<2>()); };
    const double c = product(x, x), b = product(x, d), e = product(d, d), discriminant = b * b - e * c;
    double a = std::numeric_limits<double>::infinity();
    if (e == 0) {
        if (b < 0) a = -c / (2 * b);
    } else if (discriminant >= 0) {
        const double sum = b >= 0 ? -(b + std::sqrt(discriminant)) : std::sqrt(discriminant) - b;
        for (const double root : {sum / e, c / sum})
            if (root > 0) a = std::min(a, root);
    }
    return d(0) < 0 ? std::min(a, -x(0) / d(0)) : a;
}

/// The same for the half line.
double longest(double x, double d) {
    return d < 0 ? -x / d : std::numeric_limits<double>::infinity();
}

/// Nesterov and Todd's scaling of a pair of points in L: G symmetric, G r = G^-1 u = lambda.
struct Scaling {
    Mat3 G = Mat3::Identity(), inverse = Mat3::Identity();
    Vec3 lambda = Vec3::Zero();
};

/// v v_0 ... : the matrix whose square maps by the quadratic representation of v, with determinant(v) = 1.
Mat3 root_of(const Vec3& v) {
    Mat3 m;
    m(0, 0) = v(0);
    m.topRightCorner<1, 2>() = v.tail<2>().transpose();
    m.bottomLeftCorner<2, 1>() = v.tail<2>();
    m.bottomRightCorner<2, 2>() = Mat2::Identity() + v.tail<2>() * v.tail<2>().transpose() / (1 + v(0));
    return m;
}

Vec3 conjugate(Vec3 v) {
    v.tail<2>() = -v.tail<2>();
    return v;
}

Scaling scaling(const Vec3& r, const Vec3& u) {
    const double size_r = std::sqrt(determinant(r)), size_u = std::sqrt(determinant(u));
    const Vec3 unit_r = r / size_r, unit_u = u / size_u;
    const Vec3 w = (unit_u + conjugate(unit_r)) / (2 * std::sqrt(0.5 * (1 + unit_r.dot(unit_u))));
    const double eta = std::sqrt(size_u / size_r);
    Scaling s;
    s.G = eta * root_of(w);
    s.inverse = root_of(conjugate(w)) / eta;
    s.lambda = s.G * r;
    return s;
}

/// The same on the half line, which is what the cone of a point without friction is.
Scaling scaling(double r, double u) {
    Scaling s;
    s.G(0, 0) = std::sqrt(u / r);
    s.inverse(0, 0) = std::sqrt(r / u);
    s.lambda(0) = std::sqrt(r * u);
    return s;
}

/// R in L, U = W R + q + (s, 0, 0) in L, R . U = 0 for given sliding distances s. Points without friction count with their
/// first component alone.
class ConvexProblem {
public:
    /// @param line  (n) points without friction; W and q are zero in their tangential components
    ConvexProblem(Matrix W, Vector q, std::vector<char> line)
        : W_(std::move(W)), q_(std::move(q)), line_(std::move(line)), scale_(line_.size()), dR_(q_.size()),
          dU_(q_.size()) {}

    /// Mehrotra's predictor and corrector, started from R and U in the interior. False if it comes to no end.
    [[nodiscard]] bool solve(const Vector& slid, Vector& R, Vector& U, int& iterations);
    /// Tangential displacements of a point.
    [[nodiscard]] double slide(const Vector& R, Index j) const {
        return (W_.middleRows<2>(3 * j + 1) * R + q_.segment<2>(3 * j + 1)).norm();
    }

private:
    [[nodiscard]] Index points() const { return static_cast<Index>(line_.size()); }
    /// Solves  dU = W dR + residual,  lambda o (G dR + G^-1 dU) = centre e - lambda o lambda - second order.
    void find_direction(const Vector& residual, double centre, bool second_order);
    /// Longest step along it within the cones.
    [[nodiscard]] double reach(const Vector& R, const Vector& U) const;

    Matrix W_;
    Vector q_;
    std::vector<char> line_;
    std::vector<Scaling> scale_;
    DenseLu lu_; ///< of 1 + G^-1 W G^-1
    Vector dR_, dU_;
};

void ConvexProblem::find_direction(const Vector& residual, double centre, bool second_order) {
    Vector right(q_.size());
    for (Index j = 0; j < points(); ++j) {
        const Scaling& s = scale_[static_cast<std::size_t>(j)];
        Vec3 goal = -times(s.lambda, s.lambda);
        goal(0) += centre;
        if (second_order) goal -= times(s.G * dR_.segment<3>(3 * j), s.inverse * dU_.segment<3>(3 * j));
        Vec3 v = divided(goal, s.lambda);
        if (line_[static_cast<std::size_t>(j)] != 0) v.tail<2>().setZero();
        right.segment<3>(3 * j) = v - s.inverse * residual.segment<3>(3 * j);
    }
    lu_.solve(right.data());
    for (Index j = 0; j < points(); ++j)
        dR_.segment<3>(3 * j) = scale_[static_cast<std::size_t>(j)].inverse * right.segment<3>(3 * j);
    dU_ = W_ * dR_ + residual;
    for (Index j = 0; j < points(); ++j)
        if (line_[static_cast<std::size_t>(j)] != 0) {
            dR_.segment<2>(3 * j + 1).setZero();
            dU_.segment<2>(3 * j + 1).setZero();
        }
}

double ConvexProblem::reach(const Vector& R, const Vector& U) const {
    double a = std::numeric_limits<double>::infinity();
    for (Index j = 0; j < points(); ++j)
        for (const auto& [at, along] : {std::pair{&R, &dR_}, std::pair{&U, &dU_}})
            a = std::min(a, line_[static_cast<std::size_t>(j)] != 0
                                ? longest((*at)(3 * j), (*along)(3 * j))
                                : longest(Vec3(at->segment<3>(3 * j)), Vec3(along->segment<3>(3 * j))));
    return a;
}

bool ConvexProblem::solve(const Vector& slid, Vector& R, Vector& U, int& iterations) {
    constexpr double enough = 1e-9; // Newton's method takes over from there
    constexpr int most = 60;
    constexpr double shortest = 1e-10, inside = 0.99;
    const Index n = points();
    Vector q = q_;
    for (Index j = 0; j < n; ++j) q(3 * j) += slid(j);
    const double size = 1 + q.norm() / std::sqrt(3.0 * n);
    for (int k = 0; k < most; ++k, ++iterations) {
        const Vector residual = W_ * R + q - U;
        const double complementarity = R.dot(U) / n;
        if (complementarity <= enough * size && residual.norm() <= enough * size * std::sqrt(3.0 * n)) return true;
        Matrix K = W_;
        for (Index j = 0; j < n; ++j) {
            Scaling& s = scale_[static_cast<std::size_t>(j)];
            s = line_[static_cast<std::size_t>(j)] != 0 ? scaling(R(3 * j), U(3 * j))
                                                        : scaling(Vec3(R.segment<3>(3 * j)), Vec3(U.segment<3>(3 * j)));
            K.middleRows<3>(3 * j) = (s.inverse * K.middleRows<3>(3 * j)).eval();
            K.middleCols<3>(3 * j) = (K.middleCols<3>(3 * j) * s.inverse).eval();
        }
        K.diagonal().array() += 1;
        constexpr bool ill_conditioned = true; // the more, the nearer the solution
        if (!lu_.factorise(std::move(K), ill_conditioned)) return false;
        find_direction(residual, 0, false);
        const double a = std::min(1.0, reach(R, U)), after = (R + a * dR_).dot(U + a * dU_) / n;
        const double sigma = std::pow(std::clamp(after / complementarity, 0.0, 1.0), 3);
        find_direction(residual, sigma * complementarity, true);
        const double step = std::min(1.0, inside * reach(R, U));
        if (!(step > shortest) || !dR_.allFinite() || !dU_.allFinite()) return false;
        R += step * dR_;
        U += step * dU_;
    }
    return false;
}

} // namespace

FrictionSolution cone_friction(const FrictionProblem& problem, double tolerance, int most_iterations) {
    constexpr int newton_iterations = 30;
    constexpr double settled = 1e-6; // of sliding distances, whose unit is the mean of q
    constexpr double gain = 0.9;     // of the error, and of changes of these distances
    constexpr int patience = 5;      // convex problems without either, once distances are settled: taken for round-off
    const Index n = problem.points();
    FrictionSolution solution;
    solution.r = Vector::Zero(3 * n);
    solution.error = friction_error(problem, solution.r);
    solution.converged = solution.error <= tolerance;
    if (solution.converged) return solution;
    // R = (mu r_N, r_T) and U = (u_N/mu + |u_T|, u_T) lie in L; every cone has its own unit, so that no diagonal entry of W
    // is larger than 1
    std::vector<char> line(static_cast<std::size_t>(n));
    Vector unit(3 * n); // r = unit R
    for (Index j = 0; j < n; ++j) {
        const double mu = problem.mu(j);
        line[static_cast<std::size_t>(j)] = mu == 0;
        Vec3 own(mu == 0 ? 1 : 1 / mu, mu == 0 ? 0 : 1, mu == 0 ? 0 : 1);
        const double largest = problem.W.diagonal().segment<3>(3 * j).cwiseProduct(own.cwiseAbs2()).maxCoeff();
        if (largest > 0) own /= std::sqrt(largest);
        unit.segment<3>(3 * j) = own;
    }
    Vector q = unit.cwiseProduct(problem.q);
    const double size = q.norm() / std::sqrt(3.0 * n);
    if (!(size > 0)) return solution;
    ConvexProblem convex(unit.asDiagonal() * problem.W * unit.asDiagonal(), q / size, line);
    unit *= size;

    Vector slid = Vector::Zero(n), R = Vector::Zero(3 * n), U = R;
    for (Index j = 0; j < n; ++j) R(3 * j) = U(3 * j) = 1;
    const auto keep_better = [&](const Vector& r) {
        if (!r.allFinite()) return;
        const double error = friction_error(problem, r);
        if (!(error < solution.error)) return;
        solution.r = r;
        solution.error = error;
    };
    int idle = 0;
    double least_change = std::numeric_limits<double>::infinity(), tried = least_change;
    while (solution.iterations < most_iterations && idle < patience) {
        const double before = solution.error;
        const bool solved = convex.solve(slid, R, U, solution.iterations);
        keep_better(unit.cwiseProduct(R));
        if (solution.error < tried) { // Newton has not begun there yet
            tried = solution.error;
            const FrictionSolution newton = newton_friction(problem, solution.r, tolerance, newton_iterations);
            solution.iterations += newton.iterations;
            keep_better(newton.r);
        }
        solution.converged = solution.error <= tolerance;
        if (solution.converged || !solved) break;
        double change = 0;
        for (Index j = 0; j < n; ++j) {
            const double now = line[static_cast<std::size_t>(j)] != 0 ? 0 : convex.slide(R, j);
            change = std::max(change, std::abs(now - slid(j)));
            slid(j) = now;
        }
        const bool gains = solution.error <= gain * before || change <= gain * least_change;
        idle = change <= settled && !gains ? idle + 1 : 0;
        least_change = std::min(least_change, change);
        // back into the interior, as far as the problem has changed
        const double inside = std::clamp(0.1 * change, 1e-6, 1e-2);
        for (Index j = 0; j < n; ++j) {
            R(3 * j) += inside;
            U(3 * j) = std::max(U(3 * j), U.segment<2>(3 * j + 1).norm()) + inside;
        }
    }
    return solution;
}

} // namespace osculate::solve
