/// What the audit of a step takes as drawn, and what it holds against the step.

#include "osculate/time/audit.hpp"

#include "osculate/app/compile.hpp"
#include "osculate/scene/reader.hpp"

#include <gtest/gtest.h>

namespace osculate::time {
namespace {

/// Three blocks on top of one another, each 2 cm inside the next one. The upper two are a contact pair.
const char* const overlapping = R"(
bodies:
  low:
    mesh: {block: {origin: [0 m, 0 m, 0 m], size: [1 m, 1 m, 0.5 m], divisions: [2, 2, 2]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3}}
  middle:
    mesh: {block: {origin: [0.1 m, 0.1 m, 0.48 m], size: [0.8 m, 0.8 m, 0.5 m], divisions: [2, 2, 2]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3}}
  high:
    mesh: {block: {origin: [0.2 m, 0.2 m, 0.96 m], size: [0.6 m, 0.6 m, 0.5 m], divisions: [2, 2, 2]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3}}
sets:
  bed: {body: low, surface: z_min}
  ground: {body: middle, surface: z_max}
  sole: {body: high, surface: z_min}
supports: {bed: {fix: [x, y, z]}}
contact: {joint: {slave: sole, master: {set: ground, surface: facets}}}
stages: {rest: {steps: 1}}
)";
constexpr double drawn = 0.02, round_off = 1e-12; // m

class DrawnOverlaps : public ::testing::Test {
protected:
    DrawnOverlaps() {
        const scene::Scene scene = scene::parse_scene(overlapping, "overlapping.yaml");
        plan = app::compile(scene, app::build_meshes(scene), 1, timings);
        u.assign(plan.model.X.size(), Vec3::Zero());
    }
    /// Moves a body up.
    void lift(std::size_t body, double by) {
        const model::Body& one = plan.model.bodies[body];
        for (Index i = one.first_node; i < one.first_node + one.nodes(); ++i) u[i].z() += by;
    }

    Timings timings;
    app::Plan plan;
    std::vector<Vec3> u;
};

TEST_F(DrawnOverlaps, AreForgivenBetweenBodiesThatNothingParts) {
    Audit audit(plan.model);
    lift(2, 2 * drawn); // out of the one below it
    (void)audit.examine(u);
    ASSERT_TRUE(audit.deepest());
    EXPECT_NEAR(audit.deepest()->excess, 0, round_off);
    lift(1, -drawn);
    (void)audit.examine(u);
    EXPECT_NEAR(audit.deepest()->excess, drawn, round_off) << "what is more than was drawn counts";
}

TEST_F(DrawnOverlaps, OfAContactPairCountInFull) {
    Audit audit(plan.model);
    (void)audit.examine(u);
    ASSERT_TRUE(audit.deepest());
    EXPECT_NEAR(audit.deepest()->excess, drawn, round_off);
    EXPECT_NE(audit.deepest()->body, 0) << "the lower two were drawn so";
    EXPECT_NE(audit.deepest()->other, 0);
}

} // namespace
} // namespace osculate::time
