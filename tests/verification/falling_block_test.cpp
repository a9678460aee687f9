/// Steps are cut exactly where a trial goes too deep: a block falls on a fixed plate.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double facet = 0.1, height = 0.5, gravity = 10; // m, m, m/s^2
const double touch = std::sqrt(2 * height / gravity), speed = gravity * touch;

struct Fall final : time::StepObserver {
    app::Plan plan;
    Timings timings;
    std::vector<model::State> states; ///< accepted
    std::vector<double> dt;           ///< of their steps
    std::vector<time::Attempt> attempts;

    /// @param allowed  g_p in facet sizes
    explicit Fall(double allowed, const std::vector<scene::Override>& changes = {}) {
        std::vector<scene::Override> all{{"stages.fall.control.allowed_interpenetration", std::to_string(allowed)},
                                         {"stages.fall.control.step_size", "fixed"}}; // (27) and (28) alone
        all.insert(all.end(), changes.begin(), changes.end());
        const scene::Scene scene = scene::read_scene(support::shipped("validation/falling_block.yaml"), all);
        plan = app::compile(scene, app::build_meshes(scene), 1, timings);
        time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
        stepper.run(*this);
    }
    void attempted(const time::Attempt& attempt, const std::vector<equilibrium::IterationRecord>&) override {
        attempts.push_back(attempt);
    }
    void accepted(const time::AcceptedStep& step) override {
        states.push_back(step.state);
        dt.push_back(step.dt);
    }
    [[nodiscard]] int cuts() const {
        return static_cast<int>(std::ranges::count(attempts, time::Verdict::retry, &time::Attempt::verdict));
    }
    [[nodiscard]] double first_contact() const {
        for (const model::State& state : states)
            if (std::ranges::any_of(state.contact[0].status, contact::is_closed)) return state.time;
        return 0;
    }
};

/// Height of a point above the plate, whose top is divided into upright squares: bilinear in the deformed corners.
double height_above(const model::Model& model, const std::vector<Vec3>& u, const Vec3& x) {
    const model::Set& top = *std::ranges::find(model.sets, "top", &model::Set::name);
    for (const mesh::Facet& f : top.facets) {
        Vec3 low = Vec3::Constant(1e300), high = -low;
        for (const Index node : f) {
            low = low.cwiseMin(model.X[node] + u[node]);
            high = high.cwiseMax(model.X[node] + u[node]);
        }
        if (x.x() < low.x() || x.x() > high.x() || x.y() < low.y() || x.y() > high.y()) continue;
        double z = 0;
        for (const Index node : f) {
            const Vec3 corner = model.X[node] + u[node];
            const double a = (x.x() - (low.x() + high.x() - corner.x())) / (2 * corner.x() - low.x() - high.x());
            const double b = (x.y() - (low.y() + high.y() - corner.y())) / (2 * corner.y() - low.y() - high.y());
            z += a * b * corner.z();
        }
        return x.z() - z;
    }
    ADD_FAILURE() << "the block has left the plate";
    return 0;
}

struct Depths {
    double in_trial = 0; ///< deepest that a point open at the start of its step was in the step's trial, m
    double accepted = 0; ///< deepest of all slave points at the ends of steps, m
    int mixed = 0;       ///< steps that began with some points open and some closed
};

/// Repeats the trial of every accepted step from the state before it, and looks where the points are.
Depths depths(Fall& fall) {
    const model::Model& model = fall.plan.model;
    const time::Stage& stage = fall.plan.stages[0];
    const linear::Constraints constraints(model.nodes(), stage.constraints);
    equilibrium::Equilibrium equilibrium(fall.plan.model, fall.plan.model.pairs, constraints, &*stage.dynamics,
                                         stage.tangent, fall.timings, 1);
    solve::KinsolSolver solver(equilibrium.size(), fall.timings);
    const std::vector<Index>& slaves = model.pairs[0]->slaves().node;
    const auto depth = [&](const std::vector<Vec3>& u, Index node) {
        return -height_above(model, u, model.X[node] + u[node]);
    };
    Depths result;
    for (std::size_t k = 1; k < fall.states.size(); ++k) {
        const model::State& start = fall.states[k - 1];
        equilibrium.begin_attempt(
            start, {stage.force(model.X.size(), 1), std::vector<Vec3>(model.X.size(), Vec3::Zero())}, fall.dt[k]);
        Vector z = equilibrium.unknowns(start.u, start.contact);
        const double weight = 80; // N
        const auto solved =
            time::solve_trial(equilibrium, solver, z, {start.contact[0].status},
                              {.tolerance = 1e-6, .reference_force = std::max(weight, 1e-3 * weight / fall.dt[k])});
        EXPECT_TRUE(solved.converged()) << "step " << k;
        const std::vector<Vec3> trial = equilibrium.state(z).u;
        int open = 0;
        for (std::size_t j = 0; j < slaves.size(); ++j) {
            result.accepted = std::max(result.accepted, depth(fall.states[k].u, slaves[j]));
            if (contact::is_closed(start.contact[0].status[j])) continue;
            ++open;
            result.in_trial = std::max(result.in_trial, depth(trial, slaves[j]));
        }
        result.mixed += open > 0 && open < static_cast<int>(slaves.size());
    }
    return result;
}

TEST(FallingBlock, GoesNoDeeperInAnyTrialThanAllowed) {
    for (const double allowed : {1e-2, 1e-3, 1e-4, 1e-5}) {
        Fall fall(allowed);
        const double g_p = allowed * facet;
        const Depths deepest = depths(fall);
        EXPECT_LT(deepest.in_trial, g_p * (1 + 1e-6));
        EXPECT_GT(deepest.in_trial, 0) << "no step was ended by contact";
        EXPECT_LT(deepest.accepted, 1e-9 * height) << "interpenetration is left after the solve with contact";
        EXPECT_GT(fall.cuts(), 0) << "nothing was cut";
        for (const time::Attempt& attempt : fall.attempts) {
            if (attempt.verdict != time::Verdict::retry) continue;
            EXPECT_EQ(attempt.reason, time::Reason::interpenetration);
            EXPECT_LT(attempt.value, -g_p) << "cut without need";
        }
    }
}

/// One corner after the other.
TEST(FallingBlock, GoesNoDeeperWhenItLandsTilted) {
    for (const double allowed : {1e-2, 1e-4}) {
        Fall fall(allowed, {{"bodies.block.mesh.rotate", "{axis: [1, 2, 0], angle: 0.02}"}});
        const Depths deepest = depths(fall);
        EXPECT_GT(deepest.mixed, 5);
        EXPECT_LT(deepest.in_trial, allowed * facet * (1 + 1e-6));
    }
}

/// A step that ends g_p deep is g_p over the speed late; every cut takes the step to the surface, or to a tenth.
TEST(FallingBlock, TouchesAtTheExactTimeAfterFewCuts) {
    std::vector<double> decades, cuts;
    for (const double allowed : {1e-2, 1e-3, 1e-4, 1e-5}) {
        const Fall fall(allowed);
        const double late = fall.first_contact() - touch;
        EXPECT_LT(late, allowed * facet / speed);
        EXPECT_GT(late, -1e-12);
        decades.push_back(-std::log10(allowed));
        cuts.push_back(fall.cuts());
        std::printf("g_p %g of a facet: %d cuts, touch %.2e s late of %.2e\n", allowed, fall.cuts(), late,
                    allowed * facet / speed);
    }
    // like log(1/g_p): by as many a decade at its end as at its start; like 1/g_p it would be 1000 times as many
    for (std::size_t k = 1; k < cuts.size(); ++k) {
        EXPECT_LE(cuts[k] - cuts[k - 1], 2);
        EXPECT_GE(cuts[k], cuts[k - 1]);
    }
    EXPECT_LE(cuts.back(), 2 * decades.back());
    EXPECT_GT(cuts.back(), cuts.front());
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
