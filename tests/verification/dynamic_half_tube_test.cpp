/// The half-tube with inertia: slowly it is the static one, fast it keeps its books.

#include "support/scene_runner.hpp"

#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// Full size where OSCULATE_FULL is set; else a coarse mesh, on which the static run is made anew to compare with.
std::vector<scene::Override> size() {
    if (std::getenv("OSCULATE_FULL") != nullptr) return {};
    return {{"bodies.tube.mesh.half_tube.divisions", "[9, 8, 2]"},
            {"bodies.contactor.mesh.contactor.divisions", "[7, 8, 4]"}};
}

/// Largest step's part of the energies that the ledger does not account for.
double imbalance(const support::SceneRun& run) {
    double worst = 0;
    for (const auto& step : run.steps) worst = std::max(worst, std::abs(step.ledger.balance));
    const auto& last = run.steps.back().ledger;
    return worst / (last.friction + last.kinetic + last.strain);
}

TEST(DynamicHalfTube, HasTheFrictionOfTheStaticOneWhenItIsSlow) {
    support::SceneRun fixed, moving;
    support::run_scene(fixed, support::shipped("paper/half_tube.yaml"), size());
    support::run_scene(moving, support::shipped("paper/half_tube_dynamic.yaml"), size());
    const auto mean = [](const support::SceneRun& run, double from, double to) {
        double sum = 0;
        int count = 0;
        for (const auto& step : run.steps) {
            const double y = step.state.u[run.plan.model.sets[4].nodes.front()].y(); // rear
            if (y < from || y > to) continue;
            sum += step.pairs[0].friction;
            ++count;
        }
        return sum / count;
    };
    ASSERT_EQ(fixed.plan.model.sets[4].name, "rear");
    // the ripple of facets under the nodes, sampled at other places: a few tenths of its peak-to-peak of some percent
    constexpr double sampling = 0.005;
    const double still = mean(fixed, 0.5, 2.5);
    EXPECT_NEAR(mean(moving, 0.5, 2.5), still, sampling * still);
    // 2 m^3 of 2000 kg/m^3 at 0.2 m/s: hundreds of J beside a megajoule
    for (const auto& step : moving.steps) EXPECT_LT(step.ledger.kinetic, 2000);
    EXPECT_LT(imbalance(moving), 1e-6);
    EXPECT_NEAR(moving.steps.back().state.u[moving.plan.model.sets[4].nodes.front()].y(), 3, 1e-12);
}

TEST(DynamicHalfTube, KeepsItsBooksAtTenMetresASecond) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("paper/half_tube_fast.yaml"), size());
    EXPECT_LT(imbalance(run), 1e-6);
    double friction = 0;
    for (const auto& step : run.steps) {
        EXPECT_GE(step.ledger.friction, friction) << "friction only dissipates";
        friction = step.ledger.friction;
        // Coulomb's limit on the sum over nodes, each to the solver's tolerance of the step's reference force
        const double solver = 1e-9 * static_cast<double>(step.state.contact[0].lambda.size());
        EXPECT_LE(step.pairs[0].friction, (0.1 + solver) * step.pairs[0].normal);
    }
    EXPECT_GT(friction, 0.9 * 0.1 * 15e6 * 2) << "some 2 to 3 m of sliding under 17 MN";
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
