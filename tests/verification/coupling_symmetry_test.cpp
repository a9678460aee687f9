/// Couplings of bodies that planes of symmetry cut in half: half of the whole's loads, the whole's motion.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

support::SceneRun run(const std::string& text) {
    support::SceneRun result;
    support::run_scene(result, support::scene_file("coupling.yaml", text));
    return result;
}

/// A beam along x, whole or cut off at y = 0, of any material; a coupling turns its end about y and lifts it.
support::SceneRun bent(bool half, const std::string& material, const std::string& stage, const std::string& more = "") {
    return run(R"(
bodies:
  beam:
    mesh: {block: {origin: [0, )" +
               std::string(half ? "0" : "-0.2") + R"(, 0], size: [2, )" + (half ? "0.2" : "0.4") +
               R"(, 0.3], divisions: [8, )" + (half ? "2" : "4") + R"(, 3]}}
    material: {)" +
               material + R"(: {E: 1 MPa, nu: 0.3, density: 1000}}
sets:
  root: {body: beam, surface: x_min}
  tip: {body: beam, surface: x_max}
)" + (half ? "  middle: {body: beam, surface: y_min}\n" : "") +
               R"(supports:
  root: {fix: [x, y, z]}
)" + (half ? "  middle: {symmetry: [0, 1, 0]}\n" : "") +
               R"(couplings:
  head: {set: tip, reference_point: [2.1, 0, 0.2], fix: [y, rx, rz]}
stages:
  bend: )" + stage +
               more);
}

/// Where every node of the half is in the whole.
void expect_half(const support::SceneRun& half, const support::SceneRun& whole, double tolerance) {
    ASSERT_EQ(half.steps.size(), whole.steps.size());
    const auto nodes = static_cast<std::size_t>(half.plan.model.bodies[0].nodes());
    const Vec3 shift = half.plan.model.origin - whole.plan.model.origin;
    std::size_t found = 0;
    for (std::size_t i = 0; i < nodes; ++i)
        for (std::size_t j = 0; j < static_cast<std::size_t>(whole.plan.model.bodies[0].nodes()); ++j)
            if ((half.plan.model.X[i] + shift - whole.plan.model.X[j]).norm() < 1e-9) {
                ++found;
                EXPECT_LT((half.steps.back().state.u[i] - whole.steps.back().state.u[j]).norm(), tolerance) << i;
            }
    EXPECT_EQ(found, nodes);
}

TEST(Coupling, OfHalfABeamTakesHalfTheMomentOfTheWhole) {
    for (const char* material : {"linear_elastic", "neo_hookean"}) {
        SCOPED_TRACE(material);
        const auto loads = [](double share) {
            return "{steps: 4, force: {head: [0, 0, " + std::to_string(60 * share) + "]}, moment: {head: [0, " +
                   std::to_string(-200 * share) + ", 0]}}\n";
        };
        const support::SceneRun half = bent(true, material, loads(0.5)), whole = bent(false, material, loads(1));
        EXPECT_GT(std::abs(whole.steps.back().state.rigid[0].rotation.y()), 0.2);
        expect_half(half, whole, 1e-8);
        // what the plane presses with on nodes of the coupling is the coupling's
        const Vec3 held = half.steps.back().held_force[0], root = half.steps.back().reactions[0];
        EXPECT_LT(std::hypot(root.x(), root.z() + 30), 1e-6 * 30);
        EXPECT_LT(std::hypot(held.x(), held.z()), 1e-9 * 30);
        EXPECT_GT(std::abs(held.y()), 1e-3 * 30) << "the whole would bulge across";
        EXPECT_LT(whole.steps.back().held_force[0].norm(), 1e-7 * 60);
    }
}

TEST(Coupling, OfHalfABeamAsksForHalfTheMomentOfAMotion) {
    const std::string turn = "{steps: 4, motion: {head: {z: 20 cm, ry: -0.8 rad}}}\n";
    const support::SceneRun half = bent(true, "neo_hookean", turn), whole = bent(false, "neo_hookean", turn);
    expect_half(half, whole, 1e-8);
    const support::RunStep &a = half.steps.back(), &b = whole.steps.back();
    EXPECT_NEAR(2 * a.held_moment[0].y(), b.held_moment[0].y(), 1e-7 * std::abs(b.held_moment[0].y()));
    EXPECT_NEAR(2 * a.held_force[0].z(), b.held_force[0].z(), 1e-7 * std::abs(b.held_force[0].z()));
}

TEST(Coupling, OfHalfABeamSwingsAsTheWhole) {
    const std::string swing =
        "{analysis: dynamic, duration: 0.3 s, steps: 30, ramp: step, control: {step_size: fixed}, "
        "moment: {head: [0, ";
    const support::SceneRun half = bent(true, "neo_hookean", swing + "-60, 0]}}\n"),
                            whole = bent(false, "neo_hookean", swing + "-120, 0]}}\n");
    EXPECT_GT(std::abs(whole.steps.back().state.rigid[0].rotation.y()), 0.1);
    expect_half(half, whole, 1e-7);
    const time::Ledger &a = half.steps.back().ledger, &b = whole.steps.back().ledger;
    EXPECT_NEAR(2 * (a.kinetic + a.strain), b.kinetic + b.strain, 1e-6 * (b.kinetic + b.strain));
}

/// The end of a strip between two planes turns in them, pressed on a slab with friction: as wide as one likes.
TEST(Coupling, OfAStripBetweenPlanesDoesNotKnowItsWidth) {
    const auto strip = [](const std::string& width) {
        return run(R"(
bodies:
  strip:
    mesh: {block: {origin: [0, 0, 0], size: [1, )" +
                   width + R"(, 0.2], divisions: [8, 1, 2]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
  slab:
    mesh: {block: {origin: [-0.5, 0, -0.3], size: [1, )" +
                   width + R"(, 0.3], divisions: [6, 1, 2]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
sets:
  end: {body: strip, surface: x_max}
  sole: {body: strip, surface: z_min}
  strip_front: {body: strip, surface: y_min}
  strip_back: {body: strip, surface: y_max}
  road: {body: slab, surface: z_max}
  bed: {body: slab, surface: z_min}
  slab_front: {body: slab, surface: y_min}
  slab_back: {body: slab, surface: y_max}
supports:
  strip_front: {symmetry: [0, 1, 0]}
  strip_back: {symmetry: [0, 1, 0]}
  slab_front: {symmetry: [0, 1, 0]}
  slab_back: {symmetry: [0, 1, 0]}
  bed: {fix: [x, y, z]}
couplings:
  head: {set: end, fix: [y, rx, rz]}
contact:
  rub: {slave: sole, master: {set: road}, friction: 0.3}
stages:
  press: {steps: 4, motion: {head: {x: 1 cm, z: -2 cm, ry: -0.01 rad}}}
)");
    };
    const support::SceneRun narrow = strip("0.1"), wide = strip("0.2");
    const support::RunStep &a = narrow.steps.back(), &b = wide.steps.back();
    EXPECT_GT(b.held_force[0].norm(), 50);
    EXPECT_LT((2 * a.held_force[0] - b.held_force[0]).norm(), 1e-6 * b.held_force[0].norm());
    EXPECT_NEAR(2 * a.held_moment[0].y(), b.held_moment[0].y(), 1e-6 * std::abs(b.held_moment[0].y()));
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
