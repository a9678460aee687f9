/// The books of a dynamic run, where there is friction to be told from contact.

#include "osculate/time/ledger.hpp"

#include "osculate/app/compile.hpp"
#include "osculate/scene/reader.hpp"
#include "osculate/time/stepper.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::time {
namespace {

/// A block of 50 kg, under a pressure that follows it and grows, slides on a plate that is fixed.
const char* const sliding = R"(
bodies:
  plate:
    mesh: {block: {origin: [0 m, 0 m, -0.2 m], size: [2 m, 1 m, 0.2 m], divisions: [4, 2, 1]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3, density: 1000 kg/m^3}}
  block:
    mesh: {block: {origin: [0.3 m, 0.2 m, 0 m], size: [0.5 m, 0.5 m, 0.2 m], divisions: [2, 2, 1]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0, density: 1000 kg/m^3}}
    initial_velocity: [1 m/s, 0 m/s, 0 m/s]
sets:
  fixed: {body: plate, box: {min: [-1 m, -1 m, -1 m], max: [3 m, 3 m, 3 m]}}
  ground: {body: plate, surface: z_max}
  sole: {body: block, surface: z_min}
  top: {body: block, surface: z_max}
supports: {fixed: {fix: [x, y, z]}}
contact:
  joint: {slave: sole, master: {set: ground, surface: facets}, friction: 0.3}
gravity: [0 m/s^2, 0 m/s^2, -10 m/s^2]
stages:
  slide:
    analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 0.5}}, mass_damping: 2 Hz, stiffness_damping: 1 ms}}
    duration: 0.1 s
    steps: 20
    control: {step_size: fixed}
    follower_pressure: {top: 500 Pa}
)";

struct Books final : StepObserver {
    std::vector<Ledger> ledgers;
    void attempted(const Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
    void accepted(const AcceptedStep& step) override { ledgers.push_back(*step.ledger); }
};

TEST(Ledger, AddsUpUnderFriction) {
    const scene::Scene scene = scene::parse_scene(sliding, "sliding.yaml");
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    const double mass = 50, kinetic = 0.5 * mass; // kg, J
    Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
    Books books;
    stepper.run(books);
    ASSERT_GE(books.ledgers.size(), 20U);
    constexpr double round_off = 1e-12; // relative, of sums over some ten steps
    for (const Ledger& now : books.ledgers)
        EXPECT_NEAR(now.kinetic + now.strain - kinetic,
                    now.external + now.contact - now.friction - now.damping - now.algorithmic + now.balance,
                    round_off * kinetic);
    const Ledger& end = books.ledgers.back();
    EXPECT_GT(end.friction, 0.3 * kinetic);
    EXPECT_GT(end.damping, 0.1 * kinetic);
    // nothing lifts off: normal forces act along no way, but for gaps within the solver's tolerance
    EXPECT_LT(std::abs(end.contact), 1e-9 * end.friction);
    EXPECT_LT(std::abs(end.balance), 1e-9 * end.friction);
}

} // namespace
} // namespace osculate::time
