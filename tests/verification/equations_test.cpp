/// Linear equations between displacements: what they lead moves as they say, and their forces do no work.

#include "osculate/core/error.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"
#include "support/step_tangent.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::scene_file;
using support::with;

std::unique_ptr<support::SceneRun> run(const std::string& text) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, scene_file("equations.yaml", text));
    return found;
}

/// Largest difference of the displacements of two runs on nodes at the same place, of the largest displacement.
double difference(const support::SceneRun& a, const support::SceneRun& b) {
    const Field &u = a.steps.back().state.u, &w = b.steps.back().state.u;
    double worst = 0, largest = 0;
    for (Index i = 0; i < a.plan.model.nodes(); ++i) {
        const Vec3 X = a.plan.model.X[i] + a.plan.model.origin;
        Index same = -1;
        for (Index k = 0; k < b.plan.model.nodes(); ++k)
            if ((b.plan.model.X[k] + b.plan.model.origin - X).norm() < 1e-9) same = k;
        EXPECT_GE(same, 0);
        if (same < 0) return 1;
        worst = std::max(worst, (u[i] - w[same]).norm());
        largest = std::max(largest, w[same].norm());
    }
    EXPECT_GT(largest, 1e-4);
    return worst / largest;
}

// ---- a face that stays plane ----

const std::string column = R"(
bodies:
  column:
    mesh: {block: {size: [1 m, 1 m, 2 m], divisions: [2, 3, 3], element: ELEMENT}}
    material: {LAW: {E: 10 MPa, nu: 0.3}}
sets:
  bed: {body: column, surface: z_min}
  top: {body: column, surface: z_max}
  corner: {body: column, box: {min: [0.9 m, 0.9 m, 1.9 m], max: [2 m, 2 m, 3 m]}}
supports:
  bed: {fix: [x, y, z]}
EQUATIONS
stages:
  load: {steps: 2, LOAD}
)";

TEST(Equations, NodesThatShareADisplacementShareAForce) {
    for (const char* law : {"linear_elastic", "neo_hookean"})
        for (const char* element : {"hex8", "tet4", "hex20"}) {
            const std::vector<std::pair<std::string, std::string>> kind{{"ELEMENT", element}, {"LAW", law}};
            const std::string text = with(column, kind);
            const auto driven = run(with(text, {{"EQUATIONS", ""}, {"LOAD", "displacement: {top: {z: -0.2 m}}"}}));
            const double reaction = driven->steps.back().reactions[1].z();
            for (const char* equations :
                 {"equations: {plane: {each: top, terms: {top: [0, 0, 1], corner: [0, 0, -1]}}}",
                  "equations: {plane: {each: top, terms: {corner: [0, 0, 3], top: [0, 0, -3]}}}",
                  "equations: {plane: {each: top, terms: {corner: [0, 0, 1], top: [0, 0, -1]}}, "
                  "again: {terms: {top: [0, 0, 2], corner: [0, 0, -2]}}}"}) {
                const auto led = run(
                    with(text, {{"EQUATIONS", equations},
                                {"LOAD", fmt::format("nodal_force: {{corner: [0 N, 0 N, {:.17g} N]}}", reaction)}}));
                EXPECT_LT(difference(*led, *driven), 1e-7) << law << " " << element << " " << equations;
            }
        }
}

TEST(Equations, AMeanPassesItsForceToAllNodesAlike) {
    // the mean of the top is held: a force of -F / n on each of its n nodes takes up one of F on the corner
    const std::string text = with(column, {{"ELEMENT", "hex8"}, {"LAW", "linear_elastic"}});
    const auto led = run(with(text, {{"EQUATIONS", "equations: {mean: {terms: {top: [0, 0, 1]}}}"},
                                     {"LOAD", "nodal_force: {corner: [0 N, 0 N, 120 kN]}"}}));
    const auto mean_of = [](const support::SceneRun& found) {
        const model::Set& top = *std::ranges::find(found.plan.model.sets, "top", &model::Set::name);
        double sum = 0;
        for (const Index node : top.nodes) sum += found.steps.back().state.u[node].z();
        return sum / static_cast<double>(top.nodes.size());
    };
    EXPECT_LT(std::abs(mean_of(*led)), 1e-12);
    const auto unit = run(with(text, {{"EQUATIONS", ""}, {"LOAD", "nodal_force: {top: [0 N, 0 N, 1 kN]}"}}));
    const double by_one = mean_of(*unit); // what 1 kN on each node adds
    const double mean =
        mean_of(*run(with(text, {{"EQUATIONS", ""}, {"LOAD", "nodal_force: {corner: [0 N, 0 N, 120 kN]}"}})));
    const auto balanced =
        run(with(text, {{"EQUATIONS", ""},
                        {"LOAD", fmt::format("nodal_force: {{top: [0 N, 0 N, {:.17g} kN], corner: [0 N, 0 N, {:.17g} "
                                             "kN]}}",
                                             -mean / by_one, 120.0)}}));
    EXPECT_LT(difference(*led, *balanced), 1e-7);
}

// ---- halves that equations join, node by node ----

/// A beam that one half or two make, of 4 m along x and cut at 2 m.
std::string beam(bool cut, const std::string& law, const std::string& rest, const std::string& order) {
    const auto body = [&](const char* name, const char* x, const char* length, int divisions) {
        return fmt::format("  {}:\n    mesh: {{block: {{origin: [{}, 0 m, 0 m], size: [{}, 1 m, 1 m], divisions: [{}, "
                           "2, 1]}}}}\n    material: {{{}: {{E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}}}\n",
                           name, x, length, divisions, law);
    };
    std::string text = "bodies:\n";
    text += cut ? body("left", "0 m", "2 m", 3) + body("right", "2 m", "2 m", 3) : body("left", "0 m", "4 m", 6);
    text += fmt::format("sets:\n  root: {{body: left, surface: x_min}}\n  tip: {{body: {0}, surface: x_max}}\n"
                        "  end: {{body: {0}, box: {{min: [3.9 m, -1 m, -1 m], max: [5 m, 2 m, 2 m]}}}}\n",
                        cut ? "right" : "left");
    std::string equations;
    for (int j = 0; cut && j < 3; ++j)
        for (int k = 0; k < 2; ++k) {
            for (const char* side : {"left", "right"})
                text += fmt::format("  {}_{}{}: {{body: {}, box: {{min: [1.99 m, {} m, {} m], max: [2.01 m, {} m, {} "
                                    "m]}}}}\n",
                                    side, j, k, side, 0.5 * j - 0.01, k - 0.01, 0.5 * j + 0.01, k + 0.01);
            // axes that are not those of the scene, in any order
            for (const auto& [name, d] : {std::pair{"a", "0.6, 0.8, 0"}, {"b", "-0.8, 0.6, 0"}, {"c", "0, 0, 1"}}) {
                std::string minus = d;
                minus = std::string(name) == "a"   ? "-0.6, -0.8, 0"
                        : std::string(name) == "b" ? "0.8, -0.6, 0"
                                                   : "0, 0, -1";
                equations += fmt::format(fmt::runtime(order), fmt::format("{}{}{}", name, j, k),
                                         fmt::format("{}{}", j, k), d, minus);
            }
        }
    text += "supports:\n  root: {fix: [x, y, z]}\n";
    if (cut) text += "equations:\n" + equations;
    return text + rest;
}

const char* const left_first = "  {0}: {{terms: {{left_{1}: [{2}], right_{1}: [{3}]}}}}\n";
const char* const right_first = "  {0}: {{terms: {{right_{1}: [{2}], left_{1}: [{3}]}}}}\n";

TEST(Equations, HalvesJoinedNodeByNodeAreOneBeam) {
    const std::string statics =
        "stages:\n  load: {steps: 2, follower_pressure: {tip: 0.2 MPa}, nodal_force: {end: [0 N, "
        "20 kN, -60 kN]}}\n";
    const std::string dynamics =
        "stages:\n  load: {duration: 0.1 s, steps: 10, analysis: {dynamic: {}}, ramp: step, control: {step_size: "
        "fixed}, nodal_force: {end: [0 N, 20 kN, -60 kN]}}\n";
    for (const char* law : {"linear_elastic", "neo_hookean"})
        for (const std::string& stages : {statics, dynamics}) {
            const auto whole = run(beam(false, law, stages, left_first));
            for (const char* order : {left_first, right_first}) {
                const auto halves = run(beam(true, law, stages, order));
                EXPECT_LT(difference(*halves, *whole), 1e-7) << law << stages;
                EXPECT_EQ(halves->steps.size(), whole->steps.size());
            }
        }
}

TEST(Equations, CarryMomentumAndDoNoWork) {
    // no support: the impulse is the momentum of both, and the work of the force the energy
    const std::string free =
        with(beam(true, "neo_hookean",
                  "stages:\n  load: {duration: 0.1 s, steps: 20, analysis: {dynamic: {}}, ramp: step, nodal_force: "
                  "{end: [10 kN, 20 kN, -60 kN]}}\n",
                  right_first),
             {{"supports:\n  root: {fix: [x, y, z]}\n", ""}});
    const auto found = run(free);
    const Vec3 impulse = 0.1 * 6 * Vec3(1e4, 2e4, -6e4);
    const time::Ledger& ledger = found->steps.back().ledger;
    EXPECT_LT((ledger.linear - impulse).norm(), 1e-7 * impulse.norm());
    EXPECT_GT(ledger.kinetic, 1);
    EXPECT_LT(std::abs(ledger.balance), 1e-6 * ledger.kinetic);
}

TEST(Equations, ChainsInAnyOrderAreTheSame) {
    // four corners of the top in a ring of which one link says nothing new
    const std::string text =
        with(column, {{"ELEMENT", "hex8"},
                      {"LAW", "linear_elastic"},
                      {"LOAD", "nodal_force: {corner: [30 kN, 0 N, 90 kN]}"},
                      {"supports:", "  b: {body: column, box: {min: [-1 m, 0.9 m, 1.9 m], max: [0.1 m, 2 m, 3 m]}}\n"
                                    "  c: {body: column, box: {min: [-1 m, -1 m, 1.9 m], max: [0.1 m, 0.1 m, 3 m]}}\n"
                                    "  d: {body: column, box: {min: [0.9 m, -1 m, 1.9 m], max: [2 m, 0.1 m, 3 m]}}\n"
                                    "supports:"}});
    const std::vector<std::string> links{
        "{terms: {corner: [0, 0, 1], b: [0, 0, -2]}}", "{terms: {b: [0, 0, 1], c: [0, 0, 1]}}",
        "{terms: {c: [0, 0, 1], d: [1, 0, 0.5]}}", "{terms: {corner: [0, 0, 1], d: [-2, 0, -1]}}"};
    std::vector<std::size_t> order{0, 1, 2, 3};
    std::unique_ptr<support::SceneRun> first;
    do {
        std::string equations = "equations:\n";
        for (const std::size_t k : order) equations += fmt::format("  link_{}: {}\n", k, links[k]);
        auto found = run(with(text, {{"EQUATIONS", equations}}));
        EXPECT_EQ(found->plan.model.led.size(), 3);
        if (first)
            EXPECT_LT(difference(*found, *first), 1e-9) << equations;
        else
            first = std::move(found);
    } while (std::ranges::next_permutation(order).found);
    const Field& u = first->steps.back().state.u;
    const auto at = [&](const char* set) {
        return u[std::ranges::find(first->plan.model.sets, set, &model::Set::name)->nodes.front()];
    };
    EXPECT_NEAR(at("corner").z(), 2 * at("b").z(), 1e-12);
    EXPECT_NEAR(at("b").z(), -at("c").z(), 1e-12);
    EXPECT_NEAR(at("c").z(), -(at("d").x() + 0.5 * at("d").z()), 1e-12);
}

// ---- contact on nodes that equations lead ----

/// A block above another, with a gap of 1 mm.
const std::string stack = R"(
bodies:
  below:
    mesh: {block: {size: [2 m, 2 m, 1 m], divisions: [4, 4, 2]}}
    material: {LAW: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}
  above:
    mesh: {block: {origin: [0.3 m, 0.4 m, 1.001 m], size: [1.2 m, 1.1 m, 1 m], divisions: [3, 3, 2]}}
    material: {LAW: {E: 20 MPa, nu: 0.3, density: 1000 kg/m^3}}
sets:
  bed: {body: below, surface: z_min}
  upper: {body: below, surface: z_max}
  lower: {body: above, surface: z_min}
  top: {body: above, surface: z_max}
  edge: {body: below, box: {min: [0.9 m, 0.9 m, 0.9 m], max: [1.1 m, 1.1 m, 2 m]}}
supports:
  bed: {fix: [x, y, z]}
EQUATIONS
contact:
  meeting: {slave: lower, master: {set: upper, surface: SURFACE}, friction: 0.3, discretisation: NODES}
stages:
  press: {steps: 4, displacement: {top: {x: 0.05 m, y: 0 m, z: -0.1 m}}}
)";

/// The punch stays flat, and turns with nothing; a node of the master goes twice as deep as the mean of its face.
const char* const flat_punch = "equations: {flat: {each: lower, terms: {lower: [0, 0, 1], top: [0, 0, -1]}}, deep: "
                               "{terms: {edge: [0.6, 0, 0.8], upper: [0, 0.2, -1.6]}}}";

TEST(Equations, TangentsOfContactOnLedNodesAreExact) {
    // friction on smooth surfaces alone: on these facets slip is so short that differences do not resolve its direction
    for (const auto& [surface, friction] : {std::pair{"facets", "friction: 0"}, {"{blend: {}}", "friction: 0.3"}})
        for (const char* law : {"linear_elastic", "neo_hookean"})
            support::expect_exact_tangent(with(stack, {{"EQUATIONS", flat_punch},
                                                       {"SURFACE", surface},
                                                       {"friction: 0.3", friction},
                                                       {"LAW", law},
                                                       {"NODES", "node"},
                                                       {"1.001 m", "0.999 m"}}));
}

TEST(Equations, APunchThatStaysFlatIsOneThatIsDrivenSo) {
    const std::string text = with(stack, {{"SURFACE", "facets"}, {"LAW", "neo_hookean"}, {"NODES", "node"}});
    const auto led = run(
        with(text, {{"EQUATIONS", "equations: {flat: {each: lower, terms: {lower: [0, 0, 1], top: [0, 0, -1]}}}"}}));
    const auto driven = run(with(text, {{"EQUATIONS", ""}, {"-0.1 m}}", "-0.1 m}, lower: {z: -0.1 m}}"}}));
    EXPECT_LT(difference(*led, *driven), 1e-7);
    EXPECT_GT(led->steps.back().pairs[0].friction, 1e4);
}

TEST(Equations, ContactOnLedNodesIsTheSameForEverySolverAndInBalance) {
    for (const char* nodes : {"node", "mortar"}) {
        const std::string text = with(stack, {{"EQUATIONS", flat_punch},
                                              {"SURFACE", "{blend: {}}"},
                                              {"LAW", "neo_hookean"},
                                              {"friction: 0.3", "friction: 0"},
                                              {"NODES", nodes}});
        const auto found = run(text), direct = run(text + "solver: {linear_solver: direct}\n");
        EXPECT_LT(difference(*found, *direct), 1e-7) << nodes;
        const model::Model& m = found->plan.model;
        const Field& u = found->steps.back().state.u;
        const model::Set &lower = *std::ranges::find(m.sets, "lower", &model::Set::name),
                         &upper = *std::ranges::find(m.sets, "upper", &model::Set::name),
                         &edge = *std::ranges::find(m.sets, "edge", &model::Set::name);
        for (const Index node : lower.nodes) EXPECT_NEAR(u[node].z(), -0.1, 1e-12);
        Vec3 mean = Vec3::Zero();
        for (const Index node : upper.nodes) mean += u[node] / static_cast<double>(upper.nodes.size());
        EXPECT_NEAR(Vec3(0.6, 0, 0.8).dot(u[edge.nodes.front()]), Vec3(0, -0.2, 1.6).dot(mean), 1e-12);
        const support::RunStep& last = found->steps.back();
        EXPECT_GT(last.pairs[0].normal, 1e5) << nodes;
        EXPECT_LT(last.pairs[0].penetration, 1e-7) << nodes;
        EXPECT_LT((last.pairs[0].on_slave + last.pairs[0].on_master).norm(), 1e-9 * last.pairs[0].normal);
    }
}

// ---- what is refused ----

std::string faults(const std::string& text) {
    try {
        (void)run(text);
    } catch (const SceneError& error) {
        std::string all;
        for (const Fault& fault : error.faults()) all += fault.key + ": " + fault.expected + "; " + fault.found + "\n";
        return all;
    }
    return "none";
}

TEST(Equations, RefuseWhatTheyWouldGetWrong) {
    using testing::HasSubstr;
    const auto of = [&](const std::string& equations, const std::string& load = "pressure: {top: 1 kPa}") {
        return faults(with(column, {{"ELEMENT", "hex8"},
                                    {"LAW", "linear_elastic"},
                                    {"EQUATIONS", "equations: {one: " + equations + "}"},
                                    {"LOAD", load}}));
    };
    EXPECT_THAT(of("{each: bed, terms: {bed: [0, 0, 1]}}"), "none"); // what is at rest anyway
    EXPECT_THAT(of("{each: bed, terms: {bed: [0, 0, 1], top: [0, 0, 0]}}"), "none");
    EXPECT_THAT(of("{each: top, terms: {top: [0, 0, 1]}}", "displacement: {top: {z: 1 mm}}"),
                HasSubstr("a node that is free along its factors"));
    EXPECT_THAT(of("{terms: {top: [0, 0, 0]}}"), HasSubstr("a factor other than zero"));
    EXPECT_THAT(of("{each: bed, terms: {top: [0, 0, 1]}}"), HasSubstr("one of the sets under terms"));
    EXPECT_THAT(of("{each: top, terms: {top: [1, 0, 1]}}", "displacement: {top: {z: 1 mm}}"),
                HasSubstr("a node that is free along its factors"));
    EXPECT_THAT(faults(with(column, {{"ELEMENT", "hex8"},
                                     {"LAW", "linear_elastic"},
                                     {"EQUATIONS", "couplings: {head: {set: top}}\nequations: {one: {each: top, terms: "
                                                   "{top: [0, 0, 1]}}}"},
                                     {"LOAD", "ramp: step"}})),
                HasSubstr("nodes that follow no tie, coupling"));
}

TEST(Equations, AHingeThatNothingTurnsIsAFreeMotion) {
    const std::string hinge = with(
        beam(true, "linear_elastic", "stages:\n  load: {pressure: {tip: 1 kPa}}\n", left_first), {{"  a00:", "  #"},
                                                                                                  {"  b00:", "  #"},
                                                                                                  {"  c00:", "  #"},
                                                                                                  {"  a10:", "  #"},
                                                                                                  {"  b10:", "  #"},
                                                                                                  {"  c10:", "  #"},
                                                                                                  {"  a20:", "  #"},
                                                                                                  {"  b20:", "  #"},
                                                                                                  {"  c20:", "  #"}});
    EXPECT_THAT(faults(hinge), testing::HasSubstr("bodies.right: supports or contact that hold the body"));
    EXPECT_EQ(faults(beam(true, "linear_elastic", "stages:\n  load: {pressure: {tip: 1 kPa}}\n", left_first)), "none");
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
