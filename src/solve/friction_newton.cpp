#include "solve/friction_newton.hpp"

#include "osculate/solve/dense_lu.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace osculate::solve {

namespace {

/// Phi(r) = r - P(r - rho u) in the form of Alart and Curnier, with derivatives by r and u, of one point.
struct PointEquation {
    Vec3 value = Vec3::Zero();
    Mat3 by_r = Mat3::Identity(), by_u = Mat3::Zero();
};

PointEquation equation(const Vec3& r, const Vec3& u, double mu, double rho) {
    PointEquation e;
    const double L = r(0) - rho * u(0);
    if (!(L > 0)) {
        e.value = r;
        return e;
    }
    e.value(0) = rho * u(0);
    e.by_r.row(0).setZero();
    e.by_u(0, 0) = rho;
    const Vec2 t = r.tail<2>() - rho * u.tail<2>();
    const double length = t.norm();
    if (length <= mu * L) {
        e.value.tail<2>() = rho * u.tail<2>();
        e.by_r.bottomRightCorner<2, 2>().setZero();
        e.by_u.bottomRightCorner<2, 2>() = rho * Mat2::Identity();
        return e;
    }
    if (!(length > 0)) { // mu = 0 and nothing tangential
        e.value.tail<2>() = r.tail<2>();
        return e;
    }
    const Vec2 d = t / length;
    const Mat2 turn = mu * L / length * (Mat2::Identity() - d * d.transpose());
    e.value.tail<2>() = r.tail<2>() - mu * L * d;
    e.by_r.bottomRightCorner<2, 2>() = Mat2::Identity() - turn;
    e.by_r.bottomLeftCorner<2, 1>() = -mu * d;
    e.by_u.bottomRightCorner<2, 2>() = rho * turn;
    e.by_u.bottomLeftCorner<2, 1>() = mu * rho * d;
    return e;
}

} // namespace

FrictionSolution newton_friction(const FrictionProblem& problem, Vector r, double tolerance, int most_iterations) {
    constexpr double descent = 1e-4; // share of the expected one that a step has to give
    constexpr int most_halvings = 30;
    const Index n = problem.points();
    Vector rho(n);
    for (Index j = 0; j < n; ++j) {
        const double largest = problem.W.diagonal().segment<3>(3 * j).maxCoeff();
        rho(j) = largest > 0 ? 1 / largest : 1;
    }
    const auto equation_of = [&](const Vector& at, const Vector& u, Index j) {
        return equation(at.segment<3>(3 * j), u.segment<3>(3 * j), problem.mu(j), rho(j));
    };
    const auto norm = [&](const Vector& at) {
        const Vector u = problem.W * at + problem.q;
        double squares = 0;
        for (Index j = 0; j < n; ++j) squares += equation_of(at, u, j).value.squaredNorm();
        return std::sqrt(squares);
    };
    FrictionSolution solution;
    DenseLu lu;
    std::vector<Index> closed; // points whose equations are not r = 0
    for (; solution.iterations < most_iterations; ++solution.iterations) {
        if (friction_error(problem, r) <= tolerance) break;
        const Vector u = problem.W * r + problem.q;
        Vector step(3 * n);
        closed.clear();
        for (Index j = 0; j < n; ++j) {
            step.segment<3>(3 * j) = equation_of(r, u, j).value;
            if (r(3 * j) - rho(j) * u(3 * j) > 0) closed.push_back(j);
        }
        const double before = step.norm();
        // the others' steps are known
        Vector opening = step;
        for (const Index j : closed) opening.segment<3>(3 * j).setZero();
        const Vector by_opening = problem.W * opening;
        const auto m = static_cast<Index>(closed.size());
        Matrix J(3 * m, 3 * m);
        Vector of_closed(3 * m);
        for (Index a = 0; a < m; ++a) {
            const Index j = closed[static_cast<std::size_t>(a)];
            const PointEquation e = equation_of(r, u, j);
            of_closed.segment<3>(3 * a) = e.value - e.by_u * by_opening.segment<3>(3 * j);
            for (Index b = 0; b < m; ++b)
                J.block<3, 3>(3 * a, 3 * b).noalias() =
                    e.by_u * problem.W.block<3, 3>(3 * j, 3 * closed[static_cast<std::size_t>(b)]);
            J.block<3, 3>(3 * a, 3 * a) += e.by_r;
        }
        if (m > 0) {
            if (!lu.factorise(std::move(J))) break;
            lu.solve(of_closed.data());
        }
        for (Index a = 0; a < m; ++a)
            step.segment<3>(3 * closed[static_cast<std::size_t>(a)]) = of_closed.segment<3>(3 * a);
        double length = 1;
        Vector next = r - step;
        for (int k = 0; k < most_halvings && !(norm(next) <= (1 - descent * length) * before); ++k) {
            length *= 0.5;
            next = r - length * step;
        }
        r = std::move(next);
    }
    solution.error = friction_error(problem, r);
    solution.converged = solution.error <= tolerance;
    solution.r = std::move(r);
    return solution;
}

} // namespace osculate::solve
