/// KinsolSolver on slices of several processes.

#include "every_nth.hpp"
#include "kinsol_problems.hpp"
#include "support/floating_point_traps.hpp"
#include "support/thread_ranks.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;

/// One that processes share.
struct InSlices : Preconditioned {
    InSlices(Preconditioned problem, Ranks& ranks)
        : Preconditioned(std::move(problem)), parts(std::make_unique<EveryNth>(ranks, size())) {}
    Slices* slices() override { return parts.get(); }

    std::unique_ptr<EveryNth> parts;
};

TEST(SharedNewton, TakesTheIteratesOfOneProcess) {
    constexpr int n = 3; // 27 unknowns: with 30 processes three have none
    const Vector load = Vector::Constant(n * n * n, 10);
    KinsolOptions options;
    options.unknown_scale = Vector::LinSpaced(n * n * n, 1, 2);
    options.tolerance = 1e-10;
    for (const bool line_search : {false, true})
        for (const double of_preconditioner : {1.0, 0.0}) { // that of none: the tangent is factorised
            options.line_search = line_search;
            const auto problem = [&] {
                Preconditioned p(cubic(n, load), laplacian(n, 3));
                for (double& v : p.P.value) v *= of_preconditioner;
                return p;
            };
            Timings timings;
            Preconditioned alone = problem();
            Vector expected = Vector::Zero(alone.size());
            const KinsolResult by_one = KinsolSolver(alone.size(), timings).solve(alone, expected, options);
            ASSERT_EQ(by_one.outcome, KinsolOutcome::converged);
            for (const int count : {1, 3, 30}) {
                std::vector<Vector> found(static_cast<std::size_t>(count), Vector::Zero(expected.size()));
                osculate::support::on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
                    Timings own_timings;
                    InSlices shared(problem(), *ranks);
                    Vector& u = found[static_cast<std::size_t>(ranks->rank())];
                    KinsolSolver solver(shared.size(), own_timings, ranks.get());
                    const KinsolResult result = solver.solve(shared, u, options);
                    EXPECT_EQ(result.outcome, KinsolOutcome::converged);
                    EXPECT_EQ(result.iterations, by_one.iterations);
                    EXPECT_EQ(result.factorisations, by_one.factorisations);
                    Vector x;
                    EXPECT_TRUE(solver.linearise(shared));
                    EXPECT_TRUE(solver.solve_linear(load, x));
                    Vector product(x.size());
                    shared.jacobian().multiply(x.data(), product.data());
                    EXPECT_LT((product - load).norm(), 2e-10 * load.norm());
                });
                for (const Vector& u : found) {
                    EXPECT_EQ(u, found.front());
                    EXPECT_LT((u - expected).cwiseAbs().maxCoeff(), 4 * options.tolerance);
                }
            }
        }
}

TEST(SharedNewton, SaysOnAllProcessesThatAStepIsNotFinite) {
    constexpr int n = 3;
    osculate::support::on_ranks(3, [&](const std::shared_ptr<Ranks>& ranks) {
        const osculate::support::FloatingPointTraps suspended(false);
        struct Nowhere : InSlices {
            using InSlices::InSlices;
            void precondition(const ConstVectorRef& r, VectorRef z) override {
                z = r;
                z(7) = std::numeric_limits<double>::infinity(); // of one process
            }
            [[nodiscard]] bool factorisable() const override { return false; }
        } shared(Preconditioned(cubic(n, Vector::Constant(n * n * n, 10)), laplacian(n)), *ranks);
        Timings timings;
        KinsolOptions options;
        options.unknown_scale = Vector::Ones(n * n * n);
        Vector u = Vector::Zero(shared.size());
        KinsolSolver solver(shared.size(), timings, ranks.get());
        EXPECT_TRUE(is_singular(solver.solve(shared, u, options).outcome));
    });
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
