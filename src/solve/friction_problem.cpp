#include "osculate/solve/friction_problem.hpp"

#include "solve/friction_cones.hpp"
#include "solve/friction_newton.hpp"

#include <cmath>

namespace osculate::solve {

namespace {

/// 1/max diag W_jj of each point, N/m.
Vector scales(const FrictionProblem& problem) {
    Vector rho(problem.points());
    for (Index j = 0; j < problem.points(); ++j) {
        const double d = problem.W.diagonal().segment<3>(3 * j).maxCoeff();
        rho(j) = d > 0 ? 1 / d : 1;
    }
    return rho;
}

/// Projection on |x_T| <= mu x_N.
Vec3 projected(const Vec3& x, double mu) {
    const double t = x.tail<2>().norm(), n = x(0);
    if (t <= mu * n) return x;
    if (mu * t <= -n) return Vec3::Zero();
    const double along = (n + mu * t) / (1 + mu * mu); // r_N of the foot
    Vec3 foot;
    foot << along, x.tail<2>() * (mu * along / t);
    return foot;
}

} // namespace

double friction_error(const FrictionProblem& problem, const Vector& r) {
    const Vector u = problem.W * r + problem.q, rho = scales(problem);
    double error = 0, size = 0;
    for (Index j = 0; j < problem.points(); ++j) {
        Vec3 shifted = u.segment<3>(3 * j);
        shifted(0) += problem.mu(j) * shifted.tail<2>().norm();
        const Vec3 own = r.segment<3>(3 * j);
        error += (own - projected(own - rho(j) * shifted, problem.mu(j))).squaredNorm();
        size += (rho(j) * problem.q.segment<3>(3 * j)).squaredNorm();
    }
    return size > 0 ? std::sqrt(error / size) : 0;
}

FrictionSolution solve_friction(const FrictionProblem& problem, double tolerance) {
    constexpr int newton_iterations = 50, cone_iterations = 1000;
    FrictionSolution solution = newton_friction(problem, Vector::Zero(problem.q.size()), tolerance, newton_iterations);
    if (solution.converged) return solution;
    FrictionSolution better = cone_friction(problem, tolerance, cone_iterations);
    better.iterations += solution.iterations;
    return better;
}

} // namespace osculate::solve
