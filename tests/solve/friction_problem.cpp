/// Contact and friction for a linear relation of motions and forces: single points in closed form, bodies against block
/// Gauss-Seidel, which shares no code, and heaps that overdetermine their contact forces.

#include "osculate/solve/friction_problem.hpp"

#include <Eigen/LU>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

constexpr double tolerance = 1e-10;
/// What the tolerance leaves in forces of well-conditioned problems.
constexpr double same = 1e-8;

FrictionProblem one_point(const Vec3& q, double mu) {
    FrictionProblem problem{Matrix::Identity(3, 3), q, Vector::Constant(1, mu)};
    problem.W.diagonal() << 2, 4, 4; // m/N
    return problem;
}

Vec3 force_on(const FrictionProblem& problem) {
    const FrictionSolution solution = solve_friction(problem, tolerance);
    EXPECT_TRUE(solution.converged) << solution.error;
    return solution.r;
}

TEST(FrictionProblem, OnePointOpensSticksOrSlips) {
    EXPECT_TRUE(force_on(one_point({0.1, 1, 0}, 0.5)).isZero(same));                                   // open
    EXPECT_TRUE(force_on(one_point({-1, 0.5, -0.25}, 0.5)).isApprox(Vec3(0.5, -0.125, 0.0625), same)); // sticks
    const Vec3 slips = force_on(one_point({-1, 3, 4}, 0.5)); // 0.5 N, against (3, 4)/5
    EXPECT_TRUE(slips.isApprox(Vec3(0.5, -0.25 * 0.6, -0.25 * 0.8), same)) << slips.transpose();
    EXPECT_TRUE(force_on(one_point({-1, 3, 4}, 0)).isApprox(Vec3(0.5, 0, 0), same)); // glides
}

TEST(FrictionProblem, ErrorIsZeroAtSolutionsAlone) {
    const FrictionProblem problem = one_point({-1, 3, 4}, 0.5);
    EXPECT_LT(friction_error(problem, Vec3(0.5, -0.15, -0.2)), 1e-15);
    EXPECT_GT(friction_error(problem, Vec3(0.5, -0.15, -0.1)), 1e-2);  // on the cone, in another direction
    EXPECT_GT(friction_error(problem, Vec3(0.5, 0, 0)), 1e-2);         // without friction
    EXPECT_GT(friction_error(problem, Vec3(0.6, -0.18, -0.24)), 1e-2); // apart
    EXPECT_GT(friction_error(problem, Vec3(0.4, -0.12, -0.16)), 1e-2); // inside one another
}

/// Points between rigid bodies of unlike mass, at random; the last body is the ground.
/// @param soft  compliance of every point beside that of the bodies, of their mean
FrictionProblem heap(std::mt19937& random, int bodies, int points, double soft) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const auto vector = [&]() -> Vec3 { return {normal(random), normal(random), normal(random)}; };
    Matrix H = Matrix::Zero(3 * points, 6 * bodies);
    FrictionProblem problem;
    problem.mu.resize(points);
    for (int j = 0; j < points; ++j) {
        const Vec3 n = vector().normalized(), t = n.unitOrthogonal();
        Mat3 axes;
        axes << n.transpose(), t.transpose(), n.cross(t).transpose();
        const int one = static_cast<int>(uniform(random) * bodies);
        const int other = (one + 1 + static_cast<int>(uniform(random) * bodies)) % (bodies + 1);
        for (const auto& [body, sign] : {std::pair{one, 1.0}, std::pair{other, -1.0}}) {
            if (body == bodies) continue;
            const Vec3 r = vector();
            H.block<3, 3>(3 * j, 6 * body) += sign * axes;
            for (int k = 0; k < 3; ++k) // (r x a) . w = a . (w x r)
                H.block<1, 3>(3 * j + k, 6 * body + 3) += sign * r.cross(Vec3(axes.row(k))).transpose();
        }
        problem.mu(j) = uniform(random) < 0.2 ? 0 : uniform(random);
    }
    Vector compliance(6 * bodies), load(6 * bodies);
    for (int b = 0; b < bodies; ++b) compliance.segment<6>(6 * b).setConstant(std::pow(10, 4 * uniform(random) - 2));
    for (Index i = 0; i < load.size(); ++i) load(i) = normal(random) / compliance(i);
    problem.W = H * compliance.asDiagonal() * H.transpose();
    problem.W.diagonal().array() += soft * problem.W.diagonal().mean();
    problem.q = H * compliance.cwiseProduct(load);
    return problem;
}

/// One point after another by bisection of the sliding stiffness, until nothing changes.
Vector gauss_seidel(const FrictionProblem& problem, int sweeps) {
    Vector r = Vector::Zero(problem.q.size());
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (Index j = 0; j < problem.points(); ++j) {
            const Mat3 W = problem.W.block<3, 3>(3 * j, 3 * j);
            const Vec3 b = problem.W.middleRows<3>(3 * j) * r + problem.q.segment<3>(3 * j) - W * r.segment<3>(3 * j);
            const double mu = problem.mu(j);
            const auto held = [&](double k) -> Vec3 { // u_N = 0, u_T = -k r_T
                Mat3 A = W;
                A.diagonal().tail<2>().array() += k;
                return A.partialPivLu().solve(-b);
            };
            const auto slips = [&](const Vec3& x) { return !(x.tail<2>().norm() <= mu * x(0)); };
            Vec3 x = Vec3::Zero();
            if (b(0) < 0 && mu == 0) {
                x(0) = -b(0) / W(0, 0);
            } else if (b(0) < 0 && slips(x = held(0))) {
                double low = 1e-12 * W.trace(), high = 1e12 * W.trace();
                for (int k = 0; k < 100; ++k) (slips(held(std::sqrt(low * high))) ? low : high) = std::sqrt(low * high);
                x = held(high);
            }
            r.segment<3>(3 * j) = x;
        }
    return r;
}

TEST(FrictionProblem, ForcesAreThoseOfGaussSeidelWhereItConverges) {
    std::mt19937 random(3);
    constexpr int trials = 40, sweeps = 3000;
    constexpr double converged = 1e-9, close = 1e-5; // of the error; of forces, at a condition of some 1e3
    int compared = 0;
    for (int k = 0; k < trials; ++k) {
        const FrictionProblem problem = heap(random, 4, 5, 0.1);
        const Vector oracle = gauss_seidel(problem, sweeps);
        if (friction_error(problem, oracle) > converged) continue;
        ++compared;
        const FrictionSolution solution = solve_friction(problem, tolerance);
        ASSERT_TRUE(solution.converged) << k;
        EXPECT_LE((solution.r - oracle).norm(), close * oracle.norm()) << k;
    }
    EXPECT_GT(compared, trials / 2);
}

TEST(FrictionProblem, HeapsWithMoreForcesThanMotionsAreSolved) {
    // Newton's method alone solves two thirds of them
    std::mt19937 random(7);
    constexpr int trials = 100, most_unsolved = 1;
    constexpr double soft = 1e-4, within = 1e-9;
    int unsolved = 0;
    for (int k = 0; k < trials; ++k) {
        const FrictionProblem problem = heap(random, 2 + k % 6, 4 + 7 * k % 40, soft);
        unsolved += solve_friction(problem, within).converged ? 0 : 1;
    }
    EXPECT_LE(unsolved, most_unsolved);
}

TEST(FrictionProblem, UnitsAndNumberingMakeNoDifference) {
    std::mt19937 random(11);
    const FrictionProblem problem = heap(random, 3, 8, 1e-2);
    const FrictionSolution solution = solve_friction(problem, tolerance);
    ASSERT_TRUE(solution.converged);
    FrictionProblem scaled = problem; // nanometres, meganewtons
    scaled.W *= 1e15;
    scaled.q *= 1e9;
    const FrictionSolution in_units = solve_friction(scaled, tolerance);
    EXPECT_LT((1e6 * in_units.r - solution.r).norm(), same * solution.r.norm());

    FrictionProblem backwards = problem;
    const Index n = problem.points();
    for (Index i = 0; i < n; ++i) {
        backwards.mu(i) = problem.mu(n - 1 - i);
        backwards.q.segment<3>(3 * i) = problem.q.segment<3>(3 * (n - 1 - i));
        for (Index j = 0; j < n; ++j)
            backwards.W.block<3, 3>(3 * i, 3 * j) = problem.W.block<3, 3>(3 * (n - 1 - i), 3 * (n - 1 - j));
    }
    const FrictionSolution other = solve_friction(backwards, tolerance);
    for (Index i = 0; i < n; ++i)
        EXPECT_LT((other.r.segment<3>(3 * i) - solution.r.segment<3>(3 * (n - 1 - i))).norm(),
                  same * solution.r.norm());
}

TEST(FrictionProblem, AProblemWithoutSolutionIsNotSaidToBeSolved) {
    // two walls that press nearer than they can be apart
    FrictionProblem problem{Matrix::Zero(6, 6), Vector::Zero(6), Vector::Constant(2, 0.3)};
    problem.W(0, 0) = problem.W(3, 3) = 1;
    problem.W(0, 3) = problem.W(3, 0) = -1; // one body between them
    problem.W.diagonal().segment<2>(1).setConstant(1);
    problem.W.diagonal().tail<2>().setConstant(1);
    problem.q(0) = problem.q(3) = -0.5;
    EXPECT_FALSE(solve_friction(problem, tolerance).converged);
}

TEST(FrictionProblem, EndsWhereRoundOffIsAboveTheTolerance) {
    // a mechanism: one motion of all points has no resistance but round-off, and the loads go along it
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    constexpr double loose = 1e13, unreachable = 1e-14, nearly = 1e-9;
    constexpr int trials = 10, enough = 300; // factorisations; it is given up after a thousand in any case
    for (int k = 0; k < trials; ++k) {
        FrictionProblem problem = heap(random, 3, 20, 1e-2);
        Vector motion(problem.q.size());
        for (Index i = 0; i < motion.size(); ++i) motion(i) = normal(random);
        problem.W += loose * motion * motion.transpose();
        problem.q += loose * motion;
        const FrictionSolution solution = solve_friction(problem, unreachable);
        EXPECT_FALSE(solution.converged) << k;
        EXPECT_LT(solution.error, nearly) << k;
        EXPECT_LT(solution.iterations, enough) << k;
    }
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
