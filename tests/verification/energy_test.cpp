/// Integrators without dissipation keep the energy of linear vibrations for as long as one cares to look.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr int steps = 10000;

/// A cantilever, stretched, bent and twisted a little, then let go. Wave speed about 1: an element is 5 steps long.
std::string cantilever(const std::string& integrator, const std::string& mass) {
    return R"(
bodies:
  bar:
    mesh: {block: {size: [1 m, 0.2 m, 0.1 m], divisions: [4, 1, 1]}}
    material: {linear_elastic: {E: 1 Pa, nu: 0.3, density: 1 kg/m^3}}
sets:
  clamped: {body: bar, surface: x_max}
  tip: {body: bar, surface: x_min}
  edge: {body: bar, box: {min: [-1 m, -1 m, 0.09 m], max: [0.3 m, 1 m, 1 m]}}
supports:
  clamped: {fix: [x, y, z]}
stages:
  bend:
    pressure: {tip: 0.01 Pa, edge: 0.001 Pa}
    body_force: {bar: [0, 0.0005, 0]}
  swing:
    analysis: {dynamic: {integrator: )" +
           integrator + ", mass: " + mass + R"(}}
    duration: 500 s
    steps: )" +
           std::to_string(steps) + R"(
    ramp: step
    pressure: {tip: 0 Pa, edge: 0 Pa}
    body_force: {bar: [0, 0, 0]}
)";
}

/// Energies without their records of the steps in between, which would fill the memory.
struct Energies final : time::StepObserver {
    std::vector<double> energy, algorithmic;
    void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
    void accepted(const time::AcceptedStep& step) override {
        if (step.ledger == nullptr) return;
        energy.push_back(step.ledger->kinetic + step.ledger->strain);
        algorithmic.push_back(step.ledger->algorithmic);
    }
};

Energies swing(const std::string& integrator, const std::string& mass) {
    const scene::Scene scene =
        scene::read_scene(support::scene_file("cantilever.yaml", cantilever(integrator, mass)), {});
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
    Energies energies;
    stepper.run(energies);
    return energies;
}

TEST(FreeVibration, KeepsItsEnergyOverTenThousandStepsOfConservingIntegrators) {
    for (const char* integrator :
         {"{generalised_alpha: {rho_inf: 1}}", "{newmark: {beta: 0.25, gamma: 0.5}}", "{hht: {alpha: 0}}"})
        for (const char* mass : {"consistent", "lumped"}) {
            const Energies run = swing(integrator, mass);
            ASSERT_EQ(run.energy.size(), static_cast<std::size_t>(steps));
            const double E0 = run.energy.front(), drift = 1e-10; // measured: 5e-12, round-off of 1e4 steps
            double worst = 0;
            for (const double E : run.energy) worst = std::max(worst, std::abs(E / E0 - 1));
            EXPECT_LT(worst, drift) << integrator << ", " << mass;
            EXPECT_LT(std::abs(run.algorithmic.back()), drift * E0);
        }
}

/// The measure sees dissipation.
TEST(FreeVibration, LosesEnergyWithADissipatingIntegrator) {
    const Energies run = swing("{generalised_alpha: {rho_inf: 0.5}}", "consistent");
    const double lost = run.energy.front() - run.energy.back();
    EXPECT_GT(lost, 0.01 * run.energy.front());
    EXPECT_NEAR(run.algorithmic.back() - run.algorithmic.front(), lost, 1e-10 * lost);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
