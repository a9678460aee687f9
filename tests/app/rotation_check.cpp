/// What rotations add to small strains, in runs whose rotations are known.

#include "osculate/app/compile.hpp"
#include "osculate/app/run_checks.hpp"
#include "osculate/scene/reader.hpp"

#include <cmath>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Checked {
    double rotation_strain = -1; ///< -1: no body is at small strain
    std::vector<std::string> warnings;
};

Checked run(const std::string& text) {
    struct Observer final : time::StepObserver {
        explicit Observer(RunChecks& c) : checks(c) {}
        void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
        void accepted(const time::AcceptedStep& step) override { checks.accepted(step); }
        RunChecks& checks;
    };
    const scene::Scene scene = scene::parse_scene(text, "scene.yaml");
    Timings timings;
    Plan plan = compile(scene, build_meshes(scene), 1, timings);
    time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
    RunChecks checks(plan.model, std::nullopt);
    Observer observer(checks);
    stepper.run(observer);
    RunChecks resumed(plan.model, std::nullopt);
    resumed.recall(checks.memory());
    EXPECT_EQ(resumed.warnings(), checks.warnings());
    return {resumed.checks().rotation_strain.value_or(-1), resumed.warnings()};
}

/// A steel block, one face of which is turned about the normal of another.
std::string turned(const std::string& material, double degrees) {
    return fmt::format(R"(
bodies:
  gear:
    mesh: {{block: {{origin: [3 m, 0, 0], size: [0.2 m, 0.1 m, 0.1 m], divisions: [4, 2, 2]}}}}
    material: {{{}: {{E: 210 GPa, nu: 0.3}}}}
sets:
  hub: {{body: gear, surface: x_min}}
couplings:
  axle: {{set: hub, fix: [x, y, z, rx, ry]}}
stages:
  turn: {{steps: 3, motion: {{axle: {{rz: {} deg}}}}}}
)",
                       material, degrees);
}

TEST(RotationCheck, WarnsOfALinearBodyThatIsTurned) {
    const Checked found = run(turned("linear_elastic", 27));
    // lines of the hub across the axis seem shorter by this; elements turn less, as they are strained by it
    const double added = 1 - std::cos(27 * std::numbers::pi / 180);
    EXPECT_NEAR(found.rotation_strain, added, added * added);
    EXPECT_THAT(found.warnings,
                ElementsAre(AllOf(HasSubstr("body 'gear' turns"), HasSubstr("strained by 0.1 of its length"),
                                  HasSubstr("at 1 s"), HasSubstr("forces and stresses are wrong"),
                                  HasSubstr("bodies.gear.material to saint_venant_kirchhoff"))));
}

/// What is led counts far below what bends a beam: 60 MPa of steel for nothing.
TEST(RotationCheck, WarnsOfALinearBodyThatIsTurnedByLittle) {
    const Checked found = run(turned("linear_elastic", 1.4));
    EXPECT_NEAR(found.rotation_strain, 3e-4, 2e-5);
    EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("turned by 1.4 degrees")));
}

TEST(RotationCheck, LeavesFiniteStrainAlone) {
    for (const char* material : {"neo_hookean", "saint_venant_kirchhoff"}) {
        const Checked found = run(turned(material, 27));
        EXPECT_EQ(found.rotation_strain, -1);
        EXPECT_THAT(found.warnings, IsEmpty());
    }
}

/// A cantilever, its length twenty times its height; a force turns its end by this angle, rad.
std::string bent(double angle) {
    return fmt::format(R"(
bodies:
  beam:
    mesh: {{block: {{size: [2 m, 0.1 m, 0.1 m], divisions: [20, 1, 1]}}}}
    material: {{linear_elastic: {{E: 1 GPa, nu: 0}}}}
    hex_formulation: incompatible_modes
sets:
  root: {{body: beam, surface: x_min}}
  tip: {{body: beam, surface: x_max}}
supports:
  root: {{fix: [x, y, z]}}
stages:
  bend: {{displacement: {{tip: {{z: {} m}}}}}}
)",
                       angle * 2 / 1.5);
}

/// Linear theory errs by the square of the angle, however slender the beam; the strain that the rotation adds where
/// nothing leads it is no force.
TEST(RotationCheck, LeavesABeamAloneThatBendsALittle) {
    const double angle = 0.02;
    const Checked found = run(bent(angle));
    EXPECT_NEAR(found.rotation_strain, angle * angle / 2, 0.05 * angle * angle / 2);
    EXPECT_THAT(found.warnings, IsEmpty());
}

TEST(RotationCheck, WarnsOfABeamThatBendsMuch) {
    EXPECT_THAT(run(bent(0.2)).warnings, ElementsAre(HasSubstr("body 'beam'")));
}

std::string spinning(const std::string& material) {
    return R"(
bodies:
  bar:
    mesh: {block: {size: [1 m, 0.2 m, 0.1 m], divisions: [4, 1, 1]}}
    material: {)" +
           material + R"(: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}
    initial_spin: [0, 0, 1]
stages:
  spin: {analysis: dynamic, duration: 0.2 s, steps: 10}
)";
}

TEST(RotationCheck, WarnsOfALinearBodyThatSpins) {
    const Checked found = run(spinning("linear_elastic"));
    // no force acts: it flies on in straight lines, which turn by atan(0.2)
    const double added = 1 - 1 / std::sqrt(1 + 0.2 * 0.2);
    EXPECT_NEAR(found.rotation_strain, added, 1e-3 * added);
    EXPECT_THAT(found.warnings, ElementsAre(AllOf(HasSubstr("body 'bar' turns"), HasSubstr("size is wrong"))));
    EXPECT_THAT(run(spinning("neo_hookean")).warnings, IsEmpty());
}

/// Strains of a tenth and no rotation: nothing is added, and nothing at all in a scene at rest.
TEST(RotationCheck, SeesNoRotationInAStretch) {
    const std::string text = R"(
bodies:
  block:
    mesh: {block: {origin: [1 km, 0, 0], size: [1 m, 1 m, 1 m], divisions: [2, 2, 2]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0}}
sets:
  bottom: {body: block, surface: z_min}
  top: {body: block, surface: z_max}
supports:
  bottom: {fix: [x, y, z]}
  top: {fix: [x, y]}
stages:
  stretch: {displacement: {top: {z: )";
    for (const char* far : {"10 cm", "0 m"}) {
        const Checked found = run(text + far + "}}}\n");
        EXPECT_LT(found.rotation_strain, 1e-12);
        EXPECT_THAT(found.warnings, IsEmpty());
    }
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
