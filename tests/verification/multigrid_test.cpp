/// Multigrid of bodies: a symmetric linear map whose iterations do not grow with the mesh, grids that join no two bodies.

#include "osculate/app/compile.hpp"
#include "osculate/app/load.hpp"
#include "osculate/linear/penalty_stiffness.hpp"
#include "osculate/model/nodal_unknowns.hpp"
#include "osculate/solve/gmres.hpp"
#include "support/floating_point_traps.hpp"
#include "support/random.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using linear::Constraints;

/// Two blocks one above the other, n and 4 elements a side; the lower stands on its bed, one side sliding on a wall; the upper is
/// held by springs alone.
std::string two_blocks(int n) {
    const std::string side = std::to_string(n);
    return "name: two_blocks\n"
           "bodies:\n"
           "  lower:\n"
           "    mesh: {block: {origin: [0 m, 0 m, -1 m], size: [1 m, 1 m, 1 m], divisions: [" +
           side + ", " + side + ", " + side +
           "]}}\n"
           "    material: {linear_elastic: {E: 100 MPa, nu: 0.3}}\n"
           "  upper:\n"
           "    mesh: {block: {origin: [0.1 m, 0.1 m, 0 m], size: [0.8 m, 0.8 m, 0.8 m], divisions: [4, 4, 4]}}\n"
           "    material: {linear_elastic: {E: 1 GPa, nu: 0.3}}\n"
           "sets:\n"
           "  bed: {body: lower, surface: z_min}\n"
           "  side: {body: lower, surface: x_min}\n"
           "  top: {body: upper, surface: z_max}\n"
           "supports:\n"
           "  top: {fix: [x, y, z]}\n"
           "  bed: {fix: [x, y, z]}\n"
           "  side: {fix: [x]}\n"
           "stages: {rest: {steps: 1}}\n";
}

/// The stiffness with springs of k E h between the nodes of the upper block's lowest layer and the lower block's nearest.
struct Blocks {
    Blocks(int n, double springs, int threads = 1) {
        Timings timings;
        const scene::Scene scene = scene::read_scene(support::scene_file("two_blocks.yaml", two_blocks(n)),
                                                     {{"solver.stabilisation", "true"}});
        plan = app::compile(scene, app::build_meshes(scene), 1, timings);
        std::vector<linear::NodeConstraint> held = plan.stages.front().constraints;
        std::erase_if(held,
                      [&](const linear::NodeConstraint& c) { return c.node >= plan.model.bodies.back().first_node; });
        constraints = std::make_unique<Constraints>(plan.model.nodes(), held);
        stiffness = std::make_unique<linear::PenaltyStiffness>(*constraints, plan.model.K);
        const model::Body &lower = plan.model.bodies.front(), &upper = plan.model.bodies.back();
        for (Index node = upper.first_node; node < upper.first_node + upper.nodes(); ++node) {
            if (plan.model.X[node].z() > 1e-9) continue;
            Index nearest = lower.first_node;
            for (Index other = lower.first_node; other < lower.first_node + lower.nodes(); ++other)
                if ((plan.model.X[other] - plan.model.X[node]).norm() <
                    (plan.model.X[nearest] - plan.model.X[node]).norm())
                    nearest = other;
            linear::Spring& spring = springs_.emplace_back();
            spring.slave = node;
            spring.masters = {nearest};
            spring.follow = {Mat3::Identity()};
            spring.stiffness = springs * 1e8 / n * Mat3::Identity();
        }
        stiffness->set_springs(springs_);
        multigrid = solve::make_multigrid(model::nodal_unknowns(plan.model, *constraints), threads);
        multigrid->coarsen(plan.model.K.view());
    }
    [[nodiscard]] Index size() const { return constraints->equations(); }
    /// Couples the blocks by the first `count` of their springs, each `times` as stiff.
    [[nodiscard]] solve::FactorStatus couple(double times = 1, std::size_t count = all) const {
        std::vector<solve::NodalBlock> blocks;
        for (std::size_t i = 0; i < std::min(count, springs_.size()); ++i)
            linear::for_each_block(springs_[i], [&](Index row, Index column, const Mat3& block) {
                blocks.push_back({row, column, Mat3(times * block)});
            });
        return multigrid->couple(blocks);
    }
    [[nodiscard]] Vector cycle(const Vector& b) const {
        Vector x(b.size());
        multigrid->cycle(b.data(), x.data());
        return x;
    }
    /// GMRES iterations to 1e-8 of a load on every free component.
    [[nodiscard]] int iterations() const {
        const Vector b = Vector::Ones(size());
        Vector x(size());
        solve::Gmres gmres(size());
        const auto result = gmres.solve([&](const double* v, double* y) { stiffness->matrix().multiply(v, y); },
                                        [&](const double* r, double* z) { multigrid->cycle(r, z); }, b.data(), x.data(),
                                        1e-8 * b.norm());
        EXPECT_TRUE(result.converged);
        return result.iterations;
    }

    app::Plan plan;
    std::unique_ptr<Constraints> constraints;
    std::unique_ptr<linear::PenaltyStiffness> stiffness;
    std::unique_ptr<solve::Multigrid> multigrid;

private:
    static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
    std::vector<linear::Spring> springs_;
};

struct Multigrid : ::testing::Test {
    support::FloatingPointTraps suspended{false}; // PETSc estimates eigenvalues with divisions that may overflow
};

TEST_F(Multigrid, IsASymmetricPositiveLinearMap) {
    Blocks blocks(6, 1);
    ASSERT_EQ(blocks.couple(), solve::FactorStatus::ok);
    support::Random random(5);
    Vector a(blocks.size()), b(blocks.size());
    for (Index i = 0; i < a.size(); ++i) {
        a(i) = random.uniform();
        b(i) = random.uniform();
    }
    const Vector Pa = blocks.cycle(a), Pb = blocks.cycle(b);
    // a component goes through some hundred operations, each off by 1e-16 of what it works on
    const double round_off = 1e-13 * Pa.norm() * b.norm();
    EXPECT_NEAR(b.dot(Pa), a.dot(Pb), round_off);
    EXPECT_GT(a.dot(Pa), 0);
    EXPECT_LT((blocks.cycle(2 * a - b) - (2 * Pa - Pb)).norm(), 1e-13 * Pa.norm());
}

/// The finer mesh has aggregates of a single node.
TEST_F(Multigrid, TakesHardlyMoreIterationsOnFinerMeshes) {
    int coarse = 0, fine = 0;
    for (const auto& [n, iterations] : {std::pair{6, &coarse}, {24, &fine}}) {
        Blocks blocks(n, 1);
        ASSERT_EQ(blocks.couple(), solve::FactorStatus::ok);
        *iterations = blocks.iterations();
    }
    EXPECT_LT(fine, 1.5 * coarse);
    // 8 digits at a factor of 0.6 an iteration, a poor one for V-cycles as a preconditioner, are 36
    EXPECT_LT(fine, 40);
}

TEST_F(Multigrid, TakesMoreSpringsThanBefore) {
    const Blocks one_by_one(24, 1), at_once(24, 1);
    const Vector b = Vector::Ones(one_by_one.size());
    ASSERT_EQ(one_by_one.couple(1, 12), solve::FactorStatus::ok); // of 25, in rows of five
    ASSERT_TRUE(one_by_one.cycle(b).allFinite());
    ASSERT_EQ(one_by_one.couple(), solve::FactorStatus::ok);
    ASSERT_EQ(at_once.couple(), solve::FactorStatus::ok);
    EXPECT_EQ(one_by_one.cycle(b), at_once.cycle(b));
}

/// As a run that goes on from a checkpoint does, or one that has taken a step back.
TEST_F(Multigrid, ForgetsSpringsThatAreGone) {
    const Blocks before(24, 1), afresh(24, 1);
    const Vector b = Vector::Ones(before.size());
    for (const std::size_t left : {12, 9, 6}) {
        ASSERT_EQ(before.couple(), solve::FactorStatus::ok);
        ASSERT_EQ(before.couple(1, left), solve::FactorStatus::ok);
        ASSERT_EQ(afresh.couple(1, left), solve::FactorStatus::ok);
        EXPECT_EQ(before.cycle(b), afresh.cycle(b)) << left;
    }
}

/// Where contact was lost, and springs that hold nothing yet are where the next ones will be.
TEST_F(Multigrid, TakesOtherSpringsAfterTooFew) {
    for (const auto& [first, then] : {std::pair{25, 12}, {6, 12}, {6, 25}, {25, 6}}) {
        const Blocks before(24, 1), afresh(24, 1);
        const Vector b = Vector::Ones(before.size());
        ASSERT_EQ(before.couple(1, static_cast<std::size_t>(first)), solve::FactorStatus::ok);
        ASSERT_EQ(before.couple(0, static_cast<std::size_t>(then)), solve::FactorStatus::singular);
        ASSERT_EQ(before.couple(1, static_cast<std::size_t>(then)), solve::FactorStatus::ok);
        ASSERT_EQ(afresh.couple(1, static_cast<std::size_t>(then)), solve::FactorStatus::ok);
        EXPECT_EQ(before.cycle(b), afresh.cycle(b)) << first << ' ' << then;
    }
}

/// Factorisations choose the kernels of BLAS, whose sums have other last digits, on processors that OpenBLAS does not know.
TEST_F(Multigrid, HasTheSameBitsAfterAFactorisation) {
    const Blocks blocks(24, 1);
    const Vector b = Vector::Ones(blocks.size());
    ASSERT_EQ(blocks.couple(), solve::FactorStatus::ok);
    const Vector before = blocks.cycle(b);
    ASSERT_EQ(solve::make_cholesky()->factorise(blocks.stiffness->matrix()), solve::FactorStatus::ok);
    ASSERT_EQ(blocks.couple(), solve::FactorStatus::ok);
    EXPECT_EQ(blocks.cycle(b), before);
}

TEST_F(Multigrid, HasTheSameBitsForAnyNumberOfThreads) {
    const Blocks alone(12, 1);
    ASSERT_EQ(alone.couple(), solve::FactorStatus::ok);
    const Vector b = Vector::Ones(alone.size()), expected = alone.cycle(b);
    for (const int threads : {2, 3, 8}) {
        const Blocks shared(12, 1, threads);
        ASSERT_EQ(shared.couple(), solve::FactorStatus::ok);
        EXPECT_EQ(shared.cycle(b), expected) << threads << " threads";
    }
}

/// A row of springs leaves the upper block a turn about it.
TEST_F(Multigrid, SaysThatABodyIsHeldByTooLittle) {
    const Blocks blocks(6, 1);
    EXPECT_EQ(blocks.couple(1, 0), solve::FactorStatus::singular);
    EXPECT_EQ(blocks.couple(1, 5), solve::FactorStatus::singular);
    EXPECT_EQ(blocks.couple(1, 6), solve::FactorStatus::ok);
    EXPECT_EQ(blocks.couple(1e-6), solve::FactorStatus::ok);
}

TEST_F(Multigrid, FollowsNewValuesOnTheSameGrids) {
    Blocks blocks(6, 1);
    ASSERT_EQ(blocks.couple(), solve::FactorStatus::ok);
    const Vector b = Vector::Ones(blocks.size()), before = blocks.cycle(b);
    linear::BlockMatrix twice = blocks.plan.model.K;
    twice.set_combination(2, blocks.plan.model.K, 0, {});
    blocks.multigrid->take(twice.view());
    ASSERT_EQ(blocks.couple(2), solve::FactorStatus::ok);
    EXPECT_EQ(2 * blocks.cycle(b), before); // a power of two loses no digit
    blocks.multigrid->take(blocks.plan.model.K.view());
    ASSERT_EQ(blocks.couple(), solve::FactorStatus::ok);
    EXPECT_EQ(blocks.cycle(b), before);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
