/// Two equal bars that meet head on, against the exact solution by their waves: they run from the meeting and come back from
/// the far ends.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double area = 0.01, stress = 0.05, p0 = 0.1 * area, E0 = 0.5 * 0.1 * 0.1 * area;
constexpr double meeting = 0.1, parting = 2.1; // s

struct Impact {
    double touch = 0, release = 0; ///< s
    double mean = 0, worst = 0;    ///< stress in the middle nine tenths of the contact: mean, Pa, and relative error
    double stress_error = 0;       ///< mean error over the contact, of the exact stress
    double impulse = 0;            ///< N s
    double left = 0;               ///< velocity left in the left bar, m/s
    double energy_change = 0;      ///< largest, of the energy at the start
};

Impact meet(int elements, const std::string& integrator) {
    support::SceneRun run;
    const std::string divisions = "[" + std::to_string(elements) + ", 1, 1]";
    const auto steps = std::lround(3 * elements * std::sqrt(2));
    support::run_scene(run, support::shipped("validation/two_bars.yaml"),
                       {{"bodies.left.mesh.block.divisions", divisions},
                        {"bodies.right.mesh.block.divisions", divisions},
                        {"stages.impact.analysis.dynamic.integrator", integrator},
                        {"stages.impact.steps", std::to_string(steps)}});
    Impact impact;
    double before = 0, plateau = 0;
    for (const support::RunStep& step : run.steps) {
        const double t = step.time, dt = t - before, s = step.pairs[0].normal / area;
        before = t;
        impact.impulse += dt * s * area;
        if (s > 0 && impact.touch == 0) impact.touch = t;
        if (s > 0) impact.release = t;
        const double exact = t > meeting && t < parting ? stress : 0, edge = 0.1;
        impact.stress_error += dt * std::abs(s - exact) / (stress * (parting - meeting));
        if (t > meeting + edge && t < parting - edge) {
            impact.mean += dt * s;
            plateau += dt;
            impact.worst = std::max(impact.worst, std::abs(s / stress - 1));
        }
        EXPECT_NEAR(step.ledger.linear.x(), p0, 1e-10 * p0); // round-off, eps u/dt a step
        const double energy = step.ledger.kinetic + step.ledger.strain;
        impact.energy_change = std::max(impact.energy_change, std::abs(energy / E0 - 1));
        EXPECT_LT(energy, E0 * (1 + 1e-3));
    }
    impact.mean /= plateau;
    const model::Body& body = run.plan.model.bodies[0];
    for (Index i = 0; i < body.nodes(); ++i)
        impact.left += run.steps.back().state.v[body.first_node + i].x() / body.nodes();
    std::printf("%4d elements: touch %.4f, release %.4f, stress %.6f within %.2e, its mean error %.2e, energy %.1e\n",
                elements, impact.touch, impact.release, impact.mean, impact.worst, impact.stress_error,
                impact.energy_change);
    return impact;
}

/// Fronts, which the mesh draws h^(2/3) wide or better, are all that is wrong: mean errors of the stress shrink as they do.
TEST(TwoBars, TouchForTheTimeOfTheirWavesAndExchangeVelocities) {
    std::vector<int> meshes{25, 50, 100};
    if (std::getenv("OSCULATE_FULL") != nullptr) meshes.push_back(200);
    double coarser = 0;
    for (const int elements : meshes) {
        const Impact impact = meet(elements, "{generalised_alpha: {rho_inf: 0.5}}");
        const double h = 1. / elements;
        EXPECT_NEAR(impact.touch, meeting, 2 * h);
        EXPECT_NEAR(impact.release - impact.touch, parting - meeting, h); // measured: h/4 to h/2, a step is 0.7 h
        EXPECT_NEAR(impact.impulse, p0, 0.15 * std::pow(h, 2. / 3) * p0); // what the last front's tail lacks
        EXPECT_NEAR(impact.left, 0, h * 0.1) << "the left bar has given its velocity away";
        if (coarser > 0) {
            const double slack = 0.1; // of a slope measured between two meshes
            EXPECT_GT(std::log2(coarser / impact.stress_error), 2. / 3 - slack);
        }
        coarser = impact.stress_error;
        if (elements < 100) continue; // the mesh given
        EXPECT_NEAR(impact.release - impact.touch, 2, 0.02 * 2);
        EXPECT_LT(impact.worst, 0.02);
        EXPECT_NEAR(impact.mean, stress, 1e-3 * stress);
        EXPECT_LT(impact.energy_change, 0.01);
    }
}

/// Without dissipation the fronts ring on, but about the right stress.
TEST(TwoBars, KeepTheirEnergyWithNewmark) {
    const Impact impact = meet(100, "{newmark: {}}");
    EXPECT_NEAR(impact.mean, stress, 1e-3 * stress);
    EXPECT_NEAR(impact.release - impact.touch, 2, 0.02);
    EXPECT_LT(impact.energy_change, 1e-3); // measured: 4e-4, what closing and opening within a step changes
}

TEST(TwoBars, DoNotFlyThroughEachOtherInOneStep) {
    support::SceneRun run; // one step of 3 s: the left bar would come out behind the right one
    support::run_scene(run, support::shipped("validation/two_bars.yaml"),
                       {{"stages.impact.steps", "1"}, {"bodies.left.initial_velocity", "[0.5, 0, 0]"}});
    EXPECT_GT(run.attempts, static_cast<int>(run.steps.size())) << "nothing was cut";
    double largest = 0;
    for (const support::RunStep& step : run.steps) largest = std::max(largest, step.pairs[0].normal);
    EXPECT_GT(largest, 0) << "they have not met";
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
