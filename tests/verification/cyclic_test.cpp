/// Sectors that stand for rings: half a block, of which the other half is the same turned by 180 degrees.

#include "osculate/app/run_checks.hpp"
#include "osculate/core/error.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using Overrides = std::vector<scene::Override>;

/// Beams from a common middle, of which one bends up and the other down: the whole, and half of it.
const std::string whole = R"(
bodies:
  beam:
    mesh: {block: {origin: [-2 m, -1 m, 0 m], size: [4 m, 2 m, 1 m], divisions: [8, 3, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  right: {body: beam, surface: x_max}
  left: {body: beam, surface: x_min}
  floor: {body: beam, surface: z_min}
  push: {body: beam, box: {min: [-1 mm, 0.99 m, -1 m], max: [3 m, 1.01 m, 2 m]}}
  pull: {body: beam, box: {min: [-3 m, -1.01 m, -1 m], max: [1 mm, -0.99 m, 2 m]}}
supports:
  right: {fix: [x, y]}
  left: {fix: [x, y]}
  floor: {fix: [z]}
stages:
  load: {steps: 2, pressure: {push: 0.3 MPa, pull: 0.3 MPa}}
)";
const std::string half = R"(
bodies:
  beam:
    mesh: {block: {origin: [0 m, -1 m, 0 m], size: [2 m, 2 m, 1 m], divisions: [4, 3, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  right: {body: beam, surface: x_max}
  floor: {body: beam, surface: z_min}
  push: {body: beam, box: {min: [-1 mm, 0.99 m, -1 m], max: [3 m, 1.01 m, 2 m]}}
  upper: {body: beam, box: {min: [-1 mm, 1 mm, -1 m], max: [1 mm, 3 m, 2 m]}}
  lower: {body: beam, box: {min: [-1 mm, -3 m, -1 m], max: [1 mm, -1 mm, 2 m]}}
AXIS_SET
supports:
AXIS_SUPPORT
  right: {fix: [x, y]}
  floor: {fix: [z]}
cyclic:
  turn: {slave: upper, master: lower, point: [0 m, 0 m, 0 m], axis: [0, 0, 1], sectors: 2}
stages:
  load: {steps: 2, pressure: {push: 0.3 MPa}}
)";

/// Only midside nodes are on the axis: all sectors meet there.
std::string with_axis(std::string text, bool held) {
    for (const auto& [word, instead] :
         {std::pair{"AXIS_SET", "  middle: {body: beam, box: {min: [-1 mm, -1 mm, -1 m], max: [1 mm, 1 mm, 2 m]}}"},
          std::pair{"AXIS_SUPPORT", "  middle: {fix: [x, y]}"}})
        if (const auto at = text.find(word); at != std::string::npos)
            text.replace(at, std::string(word).size(), held ? instead : "");
    return text;
}

std::unique_ptr<support::SceneRun> run(const std::string& name, const std::string& text, const Overrides& overrides,
                                       bool axis = false) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, support::scene_file(name, with_axis(text, axis)), overrides);
    return found;
}

/// Largest difference of the displacements of nodes at the same place, over the largest displacement.
double difference(const support::SceneRun& part, const support::SceneRun& all) {
    const model::Model &a = part.plan.model, &b = all.plan.model;
    const Field &u = part.steps.back().state.u, &w = all.steps.back().state.u;
    double worst = 0, largest = 0;
    for (Index i = 0; i < a.nodes(); ++i) {
        const Vec3 X = a.X[i] + a.origin;
        Index same = -1;
        for (Index k = 0; k < b.nodes(); ++k)
            if (model::body_index(a, i) == model::body_index(b, k) && (b.X[k] + b.origin - X).norm() < 1e-9) same = k;
        EXPECT_GE(same, 0);
        if (same < 0) return 1;
        worst = std::max(worst, (u[i] - w[same]).norm());
        largest = std::max(largest, w[same].norm());
    }
    EXPECT_GT(largest, 1e-3);
    return worst / largest;
}

TEST(Cyclic, HalfABeamBendsAsInTheWhole) {
    for (const char* law : {"linear_elastic", "neo_hookean"})
        for (const char* element : {"hex8", "hex20"}) {
            const Overrides same{{"bodies.beam.material", fmt::format("{{{}: {{E: 10 MPa, nu: 0.3}}}}", law)},
                                 {"bodies.beam.mesh.block.element", element}};
            const auto all = run("whole.yaml", whole, same);
            const auto part = run("half.yaml", half, same, std::string(element) == "hex20");
            EXPECT_LT(difference(*part, *all), 1e-8) << law << " " << element;
            Overrides swapped = same;
            swapped.push_back({"cyclic.turn", "{slave: lower, master: upper, point: [0 m, 0 m, 5 m], axis: [0, 0, -2], "
                                              "sectors: 2, distance: 1 mm}"});
            EXPECT_LT(difference(*run("half.yaml", half, swapped, std::string(element) == "hex20"), *all), 1e-8)
                << law << " " << element;
        }
}

/// Whatever turns about the axis is free to do so, and nothing pulls it to the middle or from it but its own mass.
TEST(Cyclic, HalfARotorSpinsAsTheWhole) {
    const Overrides spin{{"bodies.beam.material", "{neo_hookean: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}"},
                         {"bodies.beam.initial_spin", "[0 rad/s, 0 rad/s, 5 rad/s]"},
                         {"supports", "{floor: {fix: [z]}}"},
                         {"stages", "{spin: {duration: 0.2 s, steps: 20, analysis: {dynamic: {}}}}"}};
    Overrides of_half = spin;
    of_half.push_back({"bodies.beam.initial_velocity", "[0 m/s, 5 m/s, 0 m/s]"});
    const auto all = run("whole.yaml", whole, spin), part = run("half.yaml", half, of_half);
    EXPECT_LT(difference(*part, *all), 1e-7);
}

/// One block turned on another under pressure, and half of each.
std::string stack(bool halved) {
    const auto block = [&](const char* name, const char* z, const char* divisions) {
        return fmt::format(
            "  {}:\n    mesh: {{block: {{origin: [{}, -1 m, {}], size: [{}, 2 m, 1 m], divisions: [{}, {}]}}}}\n"
            "    material: {{linear_elastic: {{E: {}, nu: 0.3}}}}\n",
            name, halved ? "0 m" : "-1 m", z, halved ? "1 m" : "2 m", halved ? "3" : "6", divisions,
            std::string(name) == "disc" ? "80 MPa" : "10 MPa");
    };
    const auto ends = [](const std::string& name) {
        return fmt::format("  {0}_out: {{body: {0}, box: {{min: [-1 mm, 1 mm, -1 m], max: [1 mm, 3 m, 3 m]}}}}\n"
                           "  {0}_in: {{body: {0}, box: {{min: [-1 mm, -3 m, -1 m], max: [1 mm, -1 mm, 3 m]}}}}\n",
                           name);
    };
    return "bodies:\n" + block("table", "0 m", "3, 2") + block("disc", "1 m", "3, 2") + R"(
sets:
  floor: {body: table, surface: z_min}
  table_top: {body: table, surface: z_max}
  under: {body: disc, surface: z_min}
  top: {body: disc, surface: z_max}
)" + (halved ? ends("table") + ends("disc") : "") +
           R"(
supports:
  floor: {fix: [x, y, z]}
  top: {fix: [x], cylinder: {point: [0 m, 0 m, 0 m], axis: [0, 0, 1]}}
)" +
           (halved ? R"(
cyclic:
  table: {slave: table_out, master: table_in, point: [0 m, 0 m, 0 m], axis: [0, 0, 1], sectors: 2}
  disc: {slave: disc_out, master: disc_in, point: [0 m, 0 m, 0 m], axis: [0, 0, 1], sectors: 2}
)"
                   : "") +
           R"(
contact:
  touch:
    slave: under
    master: {set: table_top, surface: facets}
    friction: 0.3
stages:
  press: {steps: 4, displacement: {top: {y: 0 m, z: -40 mm}}}
  turn: {steps: 1, displacement: {top: {y: 0 m, z: -40 mm}}}
)";
}

/// Both ends of a sector are slaves of the same place: they share what one node of the whole carries.
TEST(Cyclic, HalfABlockRubsAsTheWhole) {
    for (const char* how : {"node", "petrov_galerkin", "mortar"}) {
        const Overrides same{{"contact.touch.discretisation", how}};
        const auto all = run("stack.yaml", stack(false), same), part = run("half_stack.yaml", stack(true), same);
        EXPECT_LT(difference(*part, *all), 1e-6) << how;
        const support::PairForces &a = part->steps.back().pairs[0], &b = all->steps.back().pairs[0];
        EXPECT_NEAR(2 * a.normal / b.normal, 1, 1e-3) << how;
        EXPECT_NEAR(2 * a.friction / b.friction, 1, 1e-3) << how;
    }
}

/// Where the joint reaches the ends, tied nodes follow what follows the other end.
TEST(Cyclic, HalfATiedBlockTurnsAsTheWhole) {
    const auto glued = [](bool halved) {
        std::string text = stack(halved);
        const auto begin = text.find("contact:"), end = text.find("stages:");
        return text.replace(begin, end - begin, "ties: {glue: {slave: under, master: table_top}}\n");
    };
    const Overrides turn{{"stages.turn.displacement.top.y", "30 mm"}};
    const auto all = run("glued.yaml", glued(false), turn), part = run("half_glued.yaml", glued(true), turn);
    EXPECT_LT(difference(*part, *all), 1e-8);
}

/// Of what the neighbours would bear, a run says so.
TEST(Cyclic, SaysWhenANodeSlidesToTheNextSector) {
    const auto warnings = [](const char* turn) {
        struct Checker final : time::StepObserver {
            explicit Checker(const model::Model& model) : checks(model, std::nullopt) {}
            void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
            void accepted(const time::AcceptedStep& step) override { checks.accepted(step); }
            app::RunChecks checks;
        };
        scene::Scene scene = scene::read_scene(support::scene_file("half_stack.yaml", stack(true)),
                                               {{"stages.turn.displacement.top.y", turn}, {"stages.turn.steps", "8"}});
        Timings timings;
        const app::Plan plan = app::compile(scene, 1, timings);
        Checker checker(plan.model);
        time::Stepper(plan.model, plan.stages, plan.stepper, timings).run(checker);
        return checker.checks.warnings();
    };
    EXPECT_THAT(warnings("0 m"), testing::IsEmpty());
    EXPECT_THAT(warnings("150 mm"), testing::Contains(testing::HasSubstr("over the end of a sector")));
}

TEST(Cyclic, RefusesWhatItWouldGetWrong) {
    const auto faults = [](const Overrides& overrides) {
        std::string all;
        try {
            (void)run("half.yaml", half, overrides);
        } catch (const SceneError& error) {
            for (const Fault& fault : error.faults())
                all += fault.key + ": " + fault.expected + "; " + fault.found + "\n";
        }
        return all;
    };
    using testing::HasSubstr;
    EXPECT_EQ(faults({}), "");
    EXPECT_THAT(faults({{"cyclic.turn.sectors", "3"}}), HasSubstr("cyclic.turn.slave: nodes that the master's"));
    EXPECT_THAT(faults({{"cyclic.turn.master", "right"}}), HasSubstr("m from the nearest"));
    EXPECT_THAT(faults({{"cyclic.turn.point", "[0 m, 0.1 m, 0 m]"}}), HasSubstr("m from the nearest"));
    EXPECT_THAT(faults({{"cyclic.turn.point", "[0 m, 1 m, 0 m]"}}), HasSubstr("on it"));
    EXPECT_THAT(
        faults({{"sets.lower", "{body: beam, surface: x_min}"}, {"sets.upper", "{body: beam, surface: x_min}"}}),
        HasSubstr("cyclic.turn.master: nodes that follow nothing else"));
    EXPECT_THAT(faults({{"sets.upper", "{body: beam, box: {min: [-1 mm, 0.5 m, -1 m], max: [1 mm, 3 m, 2 m]}}"},
                        {"sets.lower", "{body: beam, box: {min: [-1 mm, -3 m, -1 m], max: [1 mm, -0.5 m, 2 m]}}"}}),
                HasSubstr("cyclic.turn: slave and master with all nodes of the sector's ends"));
    const std::string heavy = "{linear_elastic: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}";
    EXPECT_THAT(faults({{"bodies.beam.material", heavy}, {"gravity", "[0 m/s^2, -9.81 m/s^2, 0 m/s^2]"}}),
                HasSubstr("cyclic.turn.axis: gravity along the axis"));
    EXPECT_EQ(faults({{"bodies.beam.material", heavy}, {"gravity", "[0 m/s^2, 0 m/s^2, -9.81 m/s^2]"}}), "");
    EXPECT_THAT(faults({{"bodies.beam.material", heavy},
                        {"bodies.beam.initial_velocity", "[1 m/s, 0 m/s, 0 m/s]"},
                        {"stages.load.analysis", "dynamic"}}),
                HasSubstr("initial velocities that are the same in every sector"));
    EXPECT_THAT(faults({{"bodies.beam.mesh.block.element", "hex20"}}),
                HasSubstr("hold the body's nodes on the axis across it"));
    // at one end alone, along the scene's axes at both, in one stage but not in the other
    EXPECT_THAT(faults({{"supports.upper", "{fix: [z]}"}, {"supports.floor", "{fix: []}"}}),
                HasSubstr("cyclic.turn: supports and motions that are the same at both ends"));
    EXPECT_THAT(faults({{"sets.ends", "{body: beam, surface: x_min}"},
                        {"stages.load.displacement", "{ends: {x: 0 m, y: 1 mm, z: 0 m}}"}}),
                HasSubstr("cyclic.turn: supports and motions that are the same at both ends"));
    EXPECT_EQ(faults({{"sets.ends", "{body: beam, surface: x_min}"},
                      {"supports.ends", "{cylinder: {point: [0 m, 0 m, 0 m], axis: [0, 0, 1]}}"},
                      {"stages.load.displacement", "{ends: {x: 1 mm, y: 1 mm, z: 0 m}}"}}),
              "");
    EXPECT_THAT(faults({{"sets.ends", "{body: beam, surface: x_min}"},
                        {"supports.ends", "{cylinder: {point: [0 m, 0 m, 0 m], axis: [0, 0, 1]}}"},
                        {"stages.next", "{steps: 1, displacement: {ends: {x: 1 mm, y: 1 mm, z: 0 m}}}"}}),
                HasSubstr("in stage 'load'"));
    EXPECT_THAT(faults({{"stages.load.displacement", "{upper: {x: 1 mm}}"}}),
                HasSubstr("nodes that no stage drives, or in all directions"));
    EXPECT_THAT(
        faults({{"supports.right", "{fix: [x], axes: [[0, 1, 0], [1, 0, 0]], cylinder: {point: [0 m, 0 m, 0 m], "
                                   "axis: [0, 0, 1]}}"}}),
        HasSubstr("supports.right.cylinder: axes or cylinder"));
    EXPECT_THAT(faults({{"supports.right", "{fix: [x], cylinder: {point: [2 m, 1 m, 0 m], axis: [0, 0, 1]}}"}}),
                HasSubstr("supports.right.cylinder: nodes apart from the axis"));
}

/// The ends hold all rigid motions but that along the axis and the turn about it, of which one node can hold the latter.
TEST(Cyclic, EndsHoldWhatIsNotAlikeInAllSectors) {
    const auto faults = [](const Overrides& overrides) {
        try {
            (void)run("half.yaml", half, overrides);
        } catch (const SceneError& error) {
            return error.faults().front().found;
        }
        return std::string();
    };
    Overrides held{{"supports", "{floor: {fix: [z]}}"}, {"stages.load.pressure", "{right: 1 kPa}"}};
    EXPECT_THAT(faults(held), testing::HasSubstr("free rigid-body motions"));
    held.push_back({"sets.pin", "{body: beam, box: {min: [1.9 m, 0.9 m, -0.1 m], max: [2.1 m, 1.1 m, 0.1 m]}}"});
    held[0].value = "{floor: {fix: [z]}, pin: {fix: [y]}}";
    EXPECT_EQ(faults(held), "");
}

/// A node at (r, phi, z) that is driven by u_r, u_phi, u_z of a cylinder's axes goes there, and what holds it pulls along them.
TEST(Cylinder, AxesOfASupportAreRadialTangentialAndAxial) {
    const std::string tube = R"(
bodies:
  tube:
    mesh: {half_tube: {inner_radius: 2 m, thickness: 1 m, length: 1 m, divisions: [6, 2, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  inner: {body: tube, surface: inner}
  outer: {body: tube, surface: outer}
supports:
  inner: {cylinder: {point: [0 m, 7 m, 0 m], axis: [0, 1, 0]}}
  outer: {fix: [x, y, z]}
stages:
  drive: {steps: 1, displacement: {inner: {x: 3 mm, y: 2 mm, z: 1 mm}}}
)";
    const auto found = run("tube.yaml", tube, {});
    const model::Model& m = found->plan.model;
    for (const model::Set& set : m.sets) {
        if (set.name != "inner") continue;
        ASSERT_FALSE(set.nodes.empty());
        for (const Index node : set.nodes) {
            const Vec3 X = m.X[node] + m.origin, axis = Vec3::UnitY(), radial = (X - axis * axis.dot(X)).normalized();
            const Vec3 u = 3e-3 * radial + 2e-3 * axis.cross(radial) + 1e-3 * axis;
            EXPECT_LT((found->steps.back().state.u[node] - u).norm(), 1e-15);
        }
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
