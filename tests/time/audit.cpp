/// What the audit of a step takes as drawn, and what it holds against the step.

#include "osculate/time/audit.hpp"

#include "support/small_model.hpp"

#include <gtest/gtest.h>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

constexpr double drawn = 0.02, round_off = 1e-12; // m

/// Three blocks on top of one another, each 2 cm inside the next one. The upper two are a contact pair.
class DrawnOverlaps : public ::testing::Test {
protected:
    DrawnOverlaps() {
        const material::LinearElastic elastic{1e6, 0.3};
        const auto block = [](double corner, double bottom, double width) {
            return mesh::make_block({corner, corner, bottom}, {width, width, 0.5}, {2, 2, 2});
        };
        small.add_body("low", block(0, 0, 1), elastic);
        small.add_body("middle", block(0.1, 0.5 - drawn, 0.8), elastic);
        small.add_body("high", block(0.2, 1 - 2 * drawn, 0.6), elastic);
        small.add_pair("joint", {2, "z_min"}, {1, "z_max"}, elastic.E);
        u.reset(model.X.size());
    }
    /// Moves a body up.
    void lift(std::size_t body, double by) {
        const model::Body& one = model.bodies[body];
        for (Index i = one.first_node; i < one.first_node + one.nodes(); ++i) u[i].z() += by;
    }

    support::SmallModel small;
    const model::Model& model = small.model;
    Field u;
};

TEST_F(DrawnOverlaps, AreForgivenBetweenBodiesThatNothingParts) {
    Audit audit(model);
    lift(2, 2 * drawn); // out of the one below it
    (void)audit.examine(u);
    ASSERT_TRUE(audit.deepest());
    EXPECT_NEAR(audit.deepest()->excess, 0, round_off);
    lift(1, -drawn);
    (void)audit.examine(u);
    EXPECT_NEAR(audit.deepest()->excess, drawn, round_off) << "what is more than was drawn counts";
}

TEST_F(DrawnOverlaps, OfAContactPairCountInFull) {
    Audit audit(model);
    (void)audit.examine(u);
    ASSERT_TRUE(audit.deepest());
    EXPECT_NEAR(audit.deepest()->excess, drawn, round_off);
    EXPECT_NE(audit.deepest()->body, 0) << "the lower two were drawn so";
    EXPECT_NE(audit.deepest()->other, 0);
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
