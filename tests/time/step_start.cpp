/// What a step starts from.

#include "osculate/app/compile.hpp"
#include "osculate/scene/reader.hpp"
#include "osculate/time/stepper.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace osculate::time {
namespace {

/// A block is pressed on another, and the load stays as dynamics begin.
const char* const pressed = R"(
bodies:
  lower:
    mesh: {block: {origin: [0 m, 0 m, -1 m], size: [1 m, 1 m, 1 m], divisions: [2, 2, 2]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}
  upper:
    mesh: {block: {origin: [0.2 m, 0.2 m, 0 m], size: [0.6 m, 0.6 m, 0.5 m], divisions: [2, 2, 1]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}
sets:
  bed: {body: lower, surface: z_min}
  ground: {body: lower, surface: z_max}
  sole: {body: upper, surface: z_min}
  side: {body: upper, surface: x_min}
  top: {body: upper, surface: z_max}
supports: {bed: {fix: [x, y, z]}, side: {fix: [x, y]}}
contact: {joint: {slave: sole, master: {set: ground, surface: facets}, friction: 0.2}}
stages:
  press: {pressure: {top: 10 kPa}}
  wait:
    analysis: dynamic
    duration: 0.01 s
    steps: 2
)";

struct States final : StepObserver {
    std::vector<model::State> states;
    std::vector<Ledger> ledgers;
    void attempted(const Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
    void accepted(const AcceptedStep& step) override {
        states.push_back(step.state);
        if (step.ledger != nullptr) ledgers.push_back(*step.ledger);
    }
};

TEST(FirstAcceleration, IsNoneWhereContactAndLoadsBalance) {
    const scene::Scene scene = scene::parse_scene(pressed, "pressed.yaml");
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
    States found;
    stepper.run(found);
    ASSERT_GE(found.ledgers.size(), 2U);
    ASSERT_GT(std::ranges::count_if(found.states[0].contact[0].status, contact::is_closed), 0);
    constexpr double solved = 1e-9; // tolerance of forces, of the load: energies come out with its square
    for (const Ledger& now : found.ledgers) EXPECT_LT(now.kinetic, solved * now.strain);
    double largest = 0, change = 0;
    const model::State &still = found.states.front(), &later = found.states.back();
    for (std::size_t i = 0; i < still.u.size(); ++i) {
        largest = std::max(largest, still.u[i].norm());
        change = std::max(change, (later.u[i] - still.u[i]).norm());
    }
    EXPECT_LT(change, 1e3 * solved * largest); // and the condition of the blocks
}

} // namespace
} // namespace osculate::time
