/// Exact rigid surfaces as masters: Hertz, an inclined plane, a bore that a ball rolls in, tools on paths, turned scenes.

#include "support/scene_file.hpp"
#include "support/slave_nodes.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

support::SceneRun run(const std::string& text) {
    support::SceneRun result;
    support::run_scene(result, support::scene_file("exact.yaml", text));
    return result;
}

std::string text_of(const Vec3& v) {
    char digits[120];
    std::snprintf(digits, sizeof digits, "[%.17g, %.17g, %.17g]", v.x(), v.y(), v.z());
    return digits;
}

// ---- Hertz -----------------------------------------------------------------------------------------------------------

/// A rigid sphere of 50 mm on a quarter of a block, held at its planes of symmetry, by the force for a contact of a = 1 mm.
TEST(ExactSphere, PressesLikeHertz) {
    constexpr double E = 210e9, nu = 0.3, R = 50e-3, a = 1e-3;
    const double Es = E / (1 - nu * nu), F = 4 * Es * a * a * a / (3 * R), p0 = 2 * a * Es / (std::numbers::pi * R);
    const support::SceneRun pressed = run(R"(
bodies:
  block:
    mesh:
      block:
        origin: [0, 0, -10 mm]
        size: [10 mm, 10 mm, 10 mm]
        focus: {point: [0, 0, 0], size: 0.22 mm, extent: 1.25 mm, growth: 1.4}
    material: {linear_elastic: {E: 210 GPa, nu: 0.3}}
  ball:
    rigid_surface: {sphere: {centre: [0, 0, 50 mm], radius: 50 mm}}
    rigid: {fix: [x, y, rx, ry, rz]}
sets:
  block_x: {body: block, surface: x_min}
  block_y: {body: block, surface: y_min}
  bed: {body: block, surface: z_min}
  pole: {body: block, box: {min: [0, 0, -0.01 mm], max: [2.5 mm, 2.5 mm, 0.01 mm]}}
supports:
  bed: {fix: [x, y, z]}
  block_x: {symmetry: [1, 0, 0]}
  block_y: {symmetry: [0, 1, 0]}
contact:
  touch: {slave: pole, master: {rigid_surface: ball}}
stages:
  press: {force: {ball: [0, 0, )" + std::to_string(-F / 4) +
                                          "]}}\n");
    const std::vector<support::SlaveNode> nodes = support::slave_nodes(pressed);
    const auto r = [](const support::SlaveNode& node) { return std::hypot(node.X.x(), node.X.y()); };
    double total = 0, peak = 0;
    for (const support::SlaveNode& node : nodes) {
        total += node.normal;
        peak = std::max(peak, node.pressure());
    }
    EXPECT_NEAR(total, F / 4, 1e-3 * F); // their directions differ by a/R
    constexpr double close = 0.02;       // as two elastic bodies in hertz_test
    EXPECT_NEAR(peak, p0, close * p0);
    const double gyration =
        support::radius_of_gyration(nodes, r, [](const support::SlaveNode& node) { return node.normal; });
    EXPECT_NEAR(std::sqrt(5 / 2.) * gyration, a, close * a);
    const double profile = support::rms(
        nodes,
        [&](const support::SlaveNode& node) { return node.pressure() / p0 - std::sqrt(1 - std::pow(r(node) / a, 2)); },
        [&](const support::SlaveNode& node) { return r(node) < 0.8 * a; });
    EXPECT_LT(profile, close);
    // the approach a^2/R, but for what is left out of the half-space: its stiffness beyond 10 a
    const double approach =
        -pressed.steps.back().state.u[static_cast<std::size_t>(pressed.plan.model.rigid[0].reference)].z();
    EXPECT_NEAR(approach, a * a / R, 0.1 * a * a / R);
    for (Index j = 0; j < pressed.contact[0].pair().size(); ++j)
        EXPECT_GT(pressed.contact[0].point(j).gap, -1e-12) << "no node is inside";
}

// ---- a plane ---------------------------------------------------------------------------------------------------------

/// A stiff block lands on a slope and slides: its acceleration is g (sin A - mu cos A).
std::string slope(double angle, double mu) {
    const Vec3 n(-std::sin(angle), 0, std::cos(angle)), g(0, 0, -10);
    char turn[80];
    std::snprintf(turn, sizeof turn, "rotate: {axis: [0, 1, 0], angle: %.17g}", -angle);
    return R"(
gravity: )" +
           text_of(g) + R"(
bodies:
  block:
    mesh: {block: {origin: [-0.2, -0.1, 0], size: [0.4, 0.2, 0.1], divisions: [4, 2, 1]}, )" +
           std::string(turn) + R"(}
    material: {saint_venant_kirchhoff: {E: 1 GPa, nu: 0.3, density: 1000}}
  slope:
    rigid_surface: {plane: {point: [0, 0, 0], normal: )" +
           text_of(n) + R"(}}
    rigid: {fix: [x, y, z, rx, ry, rz]}
sets:
  sole: {body: block, normal: {direction: )" +
           text_of(-n) + R"(, angle: 1 deg}}
contact:
  rub: {slave: sole, master: {rigid_surface: slope}, friction: )" +
           std::to_string(mu) + R"(}
stages:
  slide:
    analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 0.5}}, stiffness_damping: 1e-4}}
    duration: 0.5
    steps: 100
)";
}

TEST(ExactPlane, LetsABlockSlideAsCoulombSays) {
    const double angle = std::atan(0.5), mu = 0.3;
    const support::SceneRun slid = run(slope(angle, mu));
    const auto along = [&](const support::RunStep& step) {
        const Vec3 down(-std::cos(angle), 0, -std::sin(angle));
        return down.dot(step.ledger.linear) / 8; // 8 kg
    };
    const support::RunStep *start = nullptr, *end = &slid.steps.back();
    for (const support::RunStep& step : slid.steps)
        if (start == nullptr && step.time > 0.2) start = &step;
    const double acceleration = (along(*end) - along(*start)) / (end->time - start->time);
    const double exact = 10 * (std::sin(angle) - mu * std::cos(angle));
    EXPECT_NEAR(acceleration, exact, 1e-3 * exact);
    // the plane takes the whole weight across it
    const double across = 80 * std::cos(angle);
    EXPECT_NEAR(end->pairs[0].normal, across, 0.01 * across);
    EXPECT_LT((end->pairs[0].on_slave + end->pairs[0].on_master).norm(), 1e-9 * across);
    EXPECT_LT((end->pairs[0].moment_on_slave + end->pairs[0].moment_on_master).norm(), 1e-9 * across);
}

TEST(ExactPlane, HoldsABlockThatSticks) {
    const support::SceneRun stuck = run(slope(std::atan(0.5), 0.6));
    EXPECT_LT(stuck.steps.back().ledger.linear.norm(), 1e-3 * 8);
}

// ---- a bore ----------------------------------------------------------------------------------------------------------

/// A small elastic cylinder swings in a bore about the y axis: rolling, its period is that of a pendulum of
/// length 3/2 (R - r) for small amplitudes.
TEST(ExactCylinder, LetsARollerSwingInABore) {
    const double R = 0.5, r = 0.1, angle = 0.1;
    const Vec3 centre = (R - r) * Vec3(std::sin(angle), 0, -std::cos(angle));
    const support::SceneRun swung = run(R"(
gravity: [0, 0, -9.81]
bodies:
  roller:
    mesh: {cylinder: {radius: 0.1, length: 0.1, divisions: [16, 3, 1]}, rotate: {axis: [1, 0, 0], angle: 90 deg}, translate: )" +
                                        text_of(centre) + R"(}
    material: {saint_venant_kirchhoff: {E: 500 kPa, nu: 0.3, density: 1000}}
  bore:
    rigid_surface: {cylinder: {axis_point: [0, 0, 0], axis_direction: [0, 1, 0], radius: 0.5, inside: true}}
    rigid: {fix: [x, y, z, rx, ry, rz]}
sets:
  skin: {body: roller, surface: outer}
contact:
  roll: {slave: skin, master: {rigid_surface: bore}, friction: 0.8}
stages:
  swing:
    analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 0.5}}}}
    control: {step_size: fixed}
    duration: 0.4
    steps: 100
)");
    const model::Model& model = swung.plan.model;
    const auto x = [&](const support::RunStep& step) {
        double sum = 0;
        for (Index i = 0; i < model.bodies[0].nodes(); ++i)
            sum +=
                (model.X[static_cast<std::size_t>(i)] + model.origin + step.state.u[static_cast<std::size_t>(i)]).x() /
                model.bodies[0].nodes();
        return sum;
    };
    double quarter = 0; // when it passes the lowest place first
    for (std::size_t k = 1; k < swung.steps.size() && quarter == 0; ++k)
        if (x(swung.steps[k]) < 0) {
            const double a = x(swung.steps[k - 1]), b = x(swung.steps[k]);
            quarter = swung.steps[k - 1].time + a / (a - b) * (swung.steps[k].time - swung.steps[k - 1].time);
        }
    const double period = 2 * std::numbers::pi * std::sqrt(1.5 * (R - r) / 9.81);
    EXPECT_NEAR(4 * quarter, period, 2e-3 * period); // measured: 2e-4
}

// ---- tools -------------------------------------------------------------------------------------------------------------

/// A layer with a surface pressed into it and led along a path, all of it turned by Q.
support::SceneRun tooled(const Mat3& Q, const std::string& shape, const std::string& motion) {
    const Eigen::AngleAxisd turn(Q);
    char placed[200];
    std::snprintf(placed, sizeof placed, "rotate: {axis: %s, angle: %.17g}", text_of(turn.axis()).c_str(),
                  turn.angle());
    const std::string up = text_of(Q * Vec3::UnitZ()), down = text_of(-(Q * Vec3::UnitZ()));
    return run(R"(
bodies:
  layer:
    mesh: {block: {origin: [-0.5, -0.2, -0.2], size: [1, 0.4, 0.2], divisions: [16, 6, 2]}, )" +
               std::string(placed) + R"(}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
  tool:
    rigid_surface: {)" +
               shape + R"(}
    rigid: {reference_point: )" +
               text_of(Q * Vec3(0, 0, 0.3)) + R"(}
sets:
  bed: {body: layer, normal: {direction: )" +
               down + R"(, angle: 1 deg}}
  top: {body: layer, normal: {direction: )" +
               up + R"(, angle: 1 deg}}
supports:
  bed: {fix: [x, y, z]}
contact:
  touch: {slave: top, master: {rigid_surface: tool}, friction: 0.3}
stages:
  press: {steps: 4, motion: {tool: )" +
               motion + "}}\n");
}

TEST(ExactTool, IsLedAlongAPathWithNoNodeInside) {
    const support::SceneRun led = run(R"(
bodies:
  layer:
    mesh: {block: {origin: [-0.5, -0.2, -0.2], size: [1, 0.4, 0.2], divisions: [24, 4, 2]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
  tool:
    rigid_surface: {cylinder: {axis_point: [-0.3, 0, 0.151], axis_direction: [0, 1, 0], radius: 0.15}}
    rigid: {fix: [y, rx, rz]}
sets:
  bed: {body: layer, surface: z_min}
  top: {body: layer, surface: z_max}
supports:
  bed: {fix: [x, y, z]}
contact:
  touch: {slave: top, master: {rigid_surface: tool}, friction: 0.2}
stages:
  press: {steps: 4, motion: {tool: {x: 0 m, z: -3 cm, ry: 0 rad}}}
  plough: {steps: 20, motion: {tool: {x: 0.4 m, ry: {expression: "t", unit: rad}}}}
)");
    for (const support::RunStep& step : led.steps) {
        const Vec3 axis = Vec3(-0.3, 0, 0.151) - led.plan.model.origin +
                          step.state.u[static_cast<std::size_t>(led.plan.model.rigid[0].reference)];
        for (const Index node : led.plan.model.sets[1].nodes) {
            const Vec3 x =
                led.plan.model.X[static_cast<std::size_t>(node)] + step.state.u[static_cast<std::size_t>(node)];
            EXPECT_GT(std::hypot(x.x() - axis.x(), x.z() - axis.z()), 0.15 - 1e-9);
        }
        // what holds the tool is what it presses with, about its axis, too
        EXPECT_LT((step.held_force[0] + step.pairs[0].on_master).norm(), 1e-7 * step.pairs[0].normal + 1e-9);
        const Vec3 moment = step.pairs[0].moment_on_master - axis.cross(step.pairs[0].on_master);
        EXPECT_LT((step.held_moment[0] + moment).norm(), 1e-7 * step.pairs[0].normal + 1e-9);
    }
    EXPECT_NEAR(led.steps.back().state.rigid[0].rotation.y(), 1, 1e-12);
    EXPECT_NEAR(led.steps.back().pairs[0].friction, 0.2 * led.steps.back().pairs[0].normal,
                1e-6 * led.steps.back().pairs[0].normal);
}

/// By a quarter of a turn about z, which takes x to y.
TEST(ExactTool, GivesTheTurnedAnswerOfATurnedScene) {
    const Mat3 Q = Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()).toRotationMatrix();
    struct Shape {
        const char *straight, *turned;
    };
    for (const Shape& shape :
         {Shape{"plane: {point: [0, 0, 0.026], normal: [0.05, 0, -1]}",
                "plane: {point: [0, 0, 0.026], normal: [0, 0.05, -1]}"},
          Shape{"sphere: {centre: [0.1, 0, 0.301], radius: 0.3}", "sphere: {centre: [0, 0.1, 0.301], radius: 0.3}"},
          Shape{"cylinder: {axis_point: [0.1, 0, 0.301], axis_direction: [0.2, 1, 0], radius: 0.3}",
                "cylinder: {axis_point: [0, 0.1, 0.301], axis_direction: [-1, 0.2, 0], radius: 0.3}"},
          Shape{"cone: {apex: [-1, 0, 0.001], axis_direction: [1, 0, 0.5463024898437905], half_angle: 0.5}",
                "cone: {apex: [0, -1, 0.001], axis_direction: [0, 1, 0.5463024898437905], half_angle: 0.5}"},
          Shape{"extruded: {points: [[-1, 0, 0.5], [0, 0, 0.001], [1, 0, 0.4]], direction: [0, 1, 0], outward: [0, 0, "
                "-1], fillet: 0.2}",
                "extruded: {points: [[0, -1, 0.5], [0, 0, 0.001], [0, 1, 0.4]], direction: [-1, 0, 0], outward: [0, 0, "
                "-1], fillet: 0.2}"}}) {
        SCOPED_TRACE(shape.straight);
        const support::SceneRun a = tooled(Mat3::Identity(), shape.straight,
                                           "{x: 1 cm, y: 0 m, z: -3 cm, rx: 0 rad, ry: 0.1 rad, rz: 0 rad}"),
                                b = tooled(Q, shape.turned,
                                           "{x: 0 m, y: 1 cm, z: -3 cm, rx: -0.1 rad, ry: 0 rad, rz: 0 rad}");
        const Vec3 f = a.steps.back().held_force[0], m = a.steps.back().held_moment[0];
        EXPECT_GT(f.norm(), 10);
        EXPECT_LT((b.steps.back().held_force[0] - Q * f).norm(), 1e-6 * f.norm());
        EXPECT_LT((b.steps.back().held_moment[0] - Q * m).norm(), 1e-6 * (f.norm() * 0.3));
    }
}

/// Sheets pressed by an exact cylinder and by one of a fine mesh: the mesh comes nearer as it gets finer.
TEST(ExactTool, IsWhatEverFinerMeshesComeTo) {
    const auto pressed = [](const std::string& tool, const std::string& master) {
        return run(R"(
bodies:
  layer:
    mesh: {block: {origin: [-0.5, 0, -0.2], size: [1, 0.1, 0.2], divisions: [40, 1, 4]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
  tool:
)" + tool + R"(
    rigid: {reference_point: [0, 0, 0.301], fix: [x, y, rx, ry, rz]}
sets:
  bed: {body: layer, surface: z_min}
  top: {body: layer, surface: z_max}
)" + (master == "set: skin" ? "  skin: {body: tool, surface: outer}\n" : "") +
                   R"(
supports:
  bed: {fix: [x, y, z]}
contact:
  touch: {slave: top, master: {)" +
                   master + R"(}, discretisation: node}
stages:
  press: {steps: 4, motion: {tool: {z: -3 cm}}}
)")
            .steps.back()
            .held_force[0]
            .z();
    };
    const double exact =
        pressed("    rigid_surface: {cylinder: {axis_point: [0, 0, 0.301], axis_direction: [0, 1, 0], radius: 0.3}}",
                "rigid_surface: tool");
    std::vector<double> error;
    for (const char* around : {"8", "24"}) {
        const double meshed =
            pressed("    mesh: {cylinder: {radius: 0.3, length: 0.3, divisions: [" + std::string(around) +
                        ", 1, 3]}, rotate: {axis: [1, 0, 0], angle: 90 deg}, translate: [0, 0.2, 0.301]}",
                    "set: skin");
        error.push_back(std::abs(meshed / exact - 1));
    }
    EXPECT_LT(error[1], 0.01);
    EXPECT_LT(error[1], error[0]);
}

/// A ball much smaller than the facets, pressed between their nodes: no node meets it, and the run must not go on.
TEST(ExactTool, ThatSlipsBetweenNodesIsSeenByTheAudit) {
    const std::string text = R"(
bodies:
  layer:
    mesh: {block: {origin: [-0.5, -0.5, -0.2], size: [1, 1, 0.2], divisions: [5, 5, 1]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
  pin:
    rigid_surface: {sphere: {centre: [0, 0, 0.051], radius: 0.05}}
    rigid: {fix: [x, y, rx, ry, rz]}
sets:
  bed: {body: layer, surface: z_min}
  top: {body: layer, surface: z_max}
supports:
  bed: {fix: [x, y, z]}
contact:
  touch: {slave: top, master: {rigid_surface: pin}}
stages:
  press: {steps: 10, motion: {pin: {z: -0.15}}}
)";
    try {
        (void)run(text);
        FAIL() << "the pin goes through the layer";
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("deep in body 'pin'"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
