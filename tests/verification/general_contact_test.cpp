/// General contact: what one line finds is what pairs written by hand say.

#include "support/diary.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <gmock/gmock.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::Diary;

/// A cap on a slab, pulled to and fro below a lid that comes down on it. The faces that press are within those below.
const std::string bodies = R"(
bodies:
  base:
    mesh: {block: {size: [4 m, 2 m, 0.5 m], divisions: [16, 8, 2]}}
    material: {linear_elastic: {E: 30 MPa, nu: 0.2}}
  cap:
    mesh: {block: {origin: [0.8 m, 0.45 m, 0.5 m], size: [1 m, 1 m, 0.5 m], divisions: [5, 5, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
    finish: rubber
  lid:
    mesh: {block: {origin: [0.3 m, 0.1 m, 2.2 m], size: [3 m, 1.6 m, 0.5 m], divisions: [9, 5, 2]}}
    material: {linear_elastic: {E: 30 MPa, nu: 0.2}}
sets:
  bed: {body: base, surface: z_min}
  ground: {body: base, surface: z_max}
  under: {body: cap, surface: z_min}
  top: {body: cap, surface: z_max}
  rear: {body: cap, surface: x_min}
  press: {body: lid, surface: z_max}
  below: {body: lid, surface: z_min}
  base: {body: base, box: {min: [-1 m, -1 m, -1 m], max: [9 m, 9 m, 9 m]}}
  lid: {body: lid, box: {min: [-1 m, -1 m, -1 m], max: [9 m, 9 m, 9 m]}}
supports:
  bed: {fix: [x, y, z]}
  press: {fix: [x, y]}
stages:
  press: {pressure: {top: 20 kPa}, displacement: {rear: {x: 0 m}, press: {z: -0.8 m}}}
  down: {steps: 3, displacement: {rear: {x: 0 m}, press: {z: -1.21 m}}}
  pull: {steps: 3, displacement: {rear: {x: 0.2 m}, press: {z: -1.21 m}}}
  push: {steps: 2, displacement: {rear: {x: 0.1 m}, press: {z: -1.21 m}}}
)";
const std::string general = "contact: {general: {friction: 0.3}}\n";
const std::string by_hand = R"(
contact:
  sliding: {slave: under, master: {set: base}, friction: 0.3}
  above: {slave: top, master: {set: lid}, friction: 0.3}
)";

Diary run(const std::string& text, const std::vector<scene::Override>& changes = {}, int reject_every = 0,
          int threads = 1) {
    app::Plan plan = support::compiled(scene::read_scene(support::scene_file("general.yaml", text), changes), threads);
    return support::diary_of(plan, reject_every);
}

/// With general contact, by one thread and without rejections.
const Diary& found() {
    static const Diary diary = run(bodies + general);
    return diary;
}

/// Largest difference of displacements over the largest displacement.
double difference(const model::State& a, const model::State& b) {
    return largest_distance(a.u, b.u).value / largest_component(b.u);
}

TEST(GeneralContact, IsThatOfPairsWrittenByHand) {
    constexpr double same = 1e-6; // of the displacements: to what steps are solved
    const Diary written = run(bodies + by_hand);
    ASSERT_EQ(found().states.size(), written.states.size());
    for (std::size_t k = 0; k < written.states.size(); ++k)
        EXPECT_LT(difference(found().states[k], written.states[k]), same) << k;
}

TEST(GeneralContact, FindsBodiesThatCameNear) {
    const auto names = [](const model::State& state) {
        std::vector<std::string> all;
        for (const model::ContactHistory& history : state.contact)
            if (!history.pair->slaves().facets.empty()) all.push_back(history.pair->name()); // not edges alone
        return all;
    };
    EXPECT_THAT(names(found().states.back()),
                testing::UnorderedElementsAre("general: cap on base", "general: cap on lid", "general: base on lid"));
}

TEST(GeneralContact, CarriesTheLoadOnEverySurfaceWithEveryDiscretisation) {
    constexpr double pressed = 20e3; // N
    const std::string stage =
        "stages: {press: {pressure: {top: 20 kPa}, displacement: {rear: {x: 0 m}, press: {z: 0 m}}}}\n";
    const std::string scene = bodies.substr(0, bodies.find("stages:")) + stage + general;
    for (const char* surface : {"facets", "blend"})
        for (const char* discretisation : {"node", "petrov_galerkin"}) {
            const Diary diary =
                run(scene, {{"contact.general.surface", surface}, {"contact.general.discretisation", discretisation}});
            double carried = 0;
            for (const model::ContactHistory& history : diary.states.back().contact)
                for (const Vec3& lambda : history.lambda) carried += lambda.z();
            EXPECT_NEAR(carried, pressed, 1e-7 * pressed) << surface << ' ' << discretisation;
        }
}

TEST(GeneralContact, RulesOfBodiesAndFinishes) {
    // cap and base without friction, cap and lid not at all
    const std::string rules = R"(
contact:
  general:
    friction: 0.3
    surface: facets
    discretisation: node
    stiffness_scale: 2
    closing_tolerance: 0.05
    initial_overlap_limit: 0.2
    pairs:
      oiled: {between: [rubber, base], friction: 0}
      apart: {between: [cap, lid], contact: false}
)";
    const std::string pairs = R"(
contact:
  sliding:
    slave: under
    master: {set: base, surface: facets}
    discretisation: node
    stiffness_scale: 2
    closing_tolerance: 0.05
)";
    // the audit would end a run whose bodies overlap without a word
    const Diary found = run(bodies + rules), written = run(bodies + pairs, {{"solver.audit", "false"}});
    ASSERT_EQ(found.states.size(), written.states.size());
    constexpr double same = 1e-9;
    EXPECT_LT(difference(found.states.back(), written.states.back()), same);
}

TEST(GeneralContact, PairsBesideItTreatTheirOwnSurfaces) {
    const std::string beside = R"(
contact:
  general: {friction: 0.3}
  sliding: {slave: under, master: {set: ground}, friction: 0.1}
)";
    const Diary found = run(bodies + beside);
    std::vector<std::string> names;
    for (const model::ContactHistory& history : found.states.back().contact)
        if (!history.pair->slaves().facets.empty()) names.push_back(history.pair->name());
    EXPECT_THAT(names, testing::UnorderedElementsAre("sliding", "general: cap on lid", "general: base on lid"));
    const Diary written =
        run(bodies + by_hand, {{"contact.sliding.friction", "0.1"}, {"contact.sliding.master.set", "ground"}});
    constexpr double same = 1e-6;
    EXPECT_LT(difference(found.states.back(), written.states.back()), same);
}

TEST(GeneralContact, RejectedAttemptsLeaveNoTraceAndThreadsNoDifference) {
    support::expect_same_bits(found(), run(bodies + general, {}, 3, 3)); // every third attempt, by three threads
}

/// Two free cubes drawn 4 mm inside one another.
const std::string inside = R"(
bodies:
  left:
    mesh: {block: {size: [0.1 m, 0.1 m, 0.1 m], divisions: [2, 2, 2]}}
    material: {neo_hookean: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}
  right:
    mesh: {block: {origin: [0.096 m, 0.01 m, 0.01 m], size: [0.1 m, 0.08 m, 0.08 m], divisions: [3, 3, 3]}}
    material: {neo_hookean: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}
contact: {general: {friction: 0.3}}
stages:
  free: {analysis: dynamic, duration: 0.05 s, steps: 50}
)";

TEST(GeneralContact, LetsBodiesOutSlowlyThatAreInsideOneAnother) {
    app::Plan plan = support::compiled(scene::read_scene(support::scene_file("inside.yaml", inside)), 1);
    const Diary diary = support::diary_of(plan, 0);
    const model::State& last = diary.states.back();
    const auto mean = [&](const Field& field, std::size_t body) {
        const model::Body& b = plan.model.bodies[body];
        Vec3 sum = Vec3::Zero();
        for (Index i = 0; i < b.nodes(); ++i) sum += field[b.first_node + i] / b.nodes();
        return sum;
    };
    constexpr double depth = 0.004, leaves_in = 0.03; // m; s, thirty steps
    EXPECT_GT((mean(last.u, 1) - mean(last.u, 0)).x(), depth);
    const double apart = (mean(last.v, 1) - mean(last.v, 0)).x();
    EXPECT_GT(apart, 0);
    EXPECT_LT(apart, 2 * depth / leaves_in); // depth/dt would be thirty times as much
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
