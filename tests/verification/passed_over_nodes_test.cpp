/// General contact passes over nodes that are too far to touch: none of those that touch, and what it evaluates is the same.

#include "osculate/model/general_contact.hpp"
#include "osculate/model/model.hpp"
#include "support/diary.hpp"
#include "support/random.hpp"
#include "support/scene_file.hpp"

#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// A ball in the corner of an open box, and a thin plate above it that is curved: convex, concave and flat masters.
const std::string scene = R"(
bodies:
  floor:
    mesh: {block: {size: [4 m, 4 m, 0.5 m], divisions: [5, 5, 1]}, translate: [0 m, 0 m, -0.5 m]}
    material: &soft {linear_elastic: {E: 1 MPa, nu: 0.3}}
  wall:
    mesh: {block: {size: [0.5 m, 4 m, 3 m], divisions: [1, 6, 4]}, translate: [-0.5 m, 0 m, 0 m]}
    material: *soft
  ball:
    mesh: {ball: {radius: 1 m, divisions: [4, 2, 2]}, translate: [1 m, 1.5 m, 1 m]}
    material: *soft
  tube:
    mesh: {half_tube: {inner_radius: 1.1 m, thickness: 0.3 m, length: 3 m, divisions: [9, 4, 1]}, rotate: {axis: [1, 0, 0], angle: 180 deg}, translate: [1 m, 3 m, 1 m]}
    material: *soft
sets:
  bed: {body: floor, surface: z_min}
supports:
  bed: {fix: [x, y, z]}
stages: {rest: {steps: 1}}
solver: {audit: false} # the tube is drawn into the wall; nothing is run
)";

struct Nodes {
    long all = 0, passed_over = 0, touching = 0;
};

/// Moves every body at random, twice, and compares the evaluations of all nodes with those that pass over far ones.
Nodes compare(const std::string& options, unsigned seed) {
    const std::string contact = "contact: {general: {friction: 0.3, " + options + "}}\n";
    const app::Plan plan = support::compiled(scene::read_scene(support::scene_file("far.yaml", scene + contact)), 1);
    const model::Model& model = plan.model;
    support::Random random(seed);
    Timings timings;
    const auto moved = [&](Field x, double by) {
        for (const model::Body& body : model.bodies) {
            const Vec3 shift = by * random.vector();
            for (Index i = 0; i < body.nodes(); ++i) x[body.first_node + i] += shift + 0.1 * by * random.vector();
        }
        return x;
    };
    const Field start = moved(sum(model.X, Field(model.X.size())), 0.05);
    model::ContactScope scope = model.general->scope_at(start, 0.1);
    const std::vector<model::ContactHistory> histories = model.general->near(scope, {});
    Nodes count;
    for (const double step : {0.0, 0.01, 0.1, 0.4}) {
        const Field x = moved(start, step);
        for (const model::ContactHistory& history : histories) {
            model::ContactEvaluation every(*history.pair), some(*history.pair);
            some.pass_over_far_nodes(true);
            every.begin_step(start.values(), history, timings, 1);
            some.begin_step(start.values(), history, timings, 1);
            every.evaluate(x.values(), timings, 1);
            some.evaluate(x.values(), timings, 1);
            for (Index j = 0; j < history.pair->size(); ++j) {
                const contact::ContactPoint &of_every = every.point(j), &of_some = some.point(j);
                const bool touches = of_every.found && of_every.gap <= 0;
                ++count.all;
                count.touching += touches;
                count.passed_over += of_every.found && !of_some.found;
                EXPECT_TRUE(!touches || of_some.found) << history.pair->name() << " node " << j << " at " << step;
                if (!of_some.found) continue;
                EXPECT_EQ(of_some.gap, of_every.gap);
                EXPECT_EQ(of_some.normal, of_every.normal);
            }
            EXPECT_LE(some.least_gap(), every.least_gap() + 1e-12);
        }
    }
    return count;
}

TEST(PassedOverNodes, AreNoneThatTouch) {
    for (const char* options : {"surface: facets, discretisation: node", "surface: blend, discretisation: node",
                                "surface: blend, discretisation: petrov_galerkin"}) {
        Nodes all;
        for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
            const Nodes found = compare(options, seed);
            all.all += found.all;
            all.passed_over += found.passed_over;
            all.touching += found.touching;
        }
        EXPECT_GT(all.touching, 100) << options;
        EXPECT_GT(all.passed_over, all.touching) << options;
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
