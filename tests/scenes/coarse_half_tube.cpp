#include "scenes/program.hpp"

#include <cmath>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

/// The paper's half-tube on a mesh that takes a second, with either master surface.
class CoarseHalfTube : public Program, public testing::WithParamInterface<const char*> {};

TEST_P(CoarseHalfTube, DragIsTheSumOfContactForcesAndOfReactions) {
    const Csv history(
        run(scene_file("configs/paper/half_tube.yaml"),
            {"bodies.tube.mesh.half_tube.divisions=[7, 6, 1]", "bodies.contactor.mesh.contactor.divisions=[6, 8, 1]",
             "stages.slide.steps=6", std::string("contact.sliding.surface=") + GetParam()}) /
        "history.csv");
    ASSERT_EQ(history.rows.size(), 7U);
    for (std::size_t i = 0; i < history.rows.size(); ++i) {
        const double D = -history.number(i, "pair.sliding.force_y"), N = history.number(i, "pair.sliding.normal");
        constexpr double balance = 1e-8; // of N; the solver's tolerance is 1e-9
        EXPECT_NEAR(history.number(i, "set.rear.reaction_y"), D, balance * N);
        EXPECT_NEAR(-history.number(i, "set.tube_outer.reaction_y"), D, balance * N);
        EXPECT_NEAR(history.number(i, "set.tube_outer.reaction_z"), history.number(i, "pair.sliding.force_z"),
                    balance * N);
        EXPECT_NEAR(history.number(i, "pair.sliding.force_z"), 16e6, balance * N) << "1 MPa on 4 m x 4 m";
        if (i < 2) continue; // slides fully
        EXPECT_NEAR(history.number(i, "pair.sliding.friction"), 0.1 * N, balance * N);
        constexpr double faceting =
            0.05; // coarse facets tilt along the axis where the tube gives way: a share of D is normal force
        EXPECT_NEAR(D / (0.1 * N), 1, faceting);
    }
}

INSTANTIATE_TEST_SUITE_P(Both, CoarseHalfTube, testing::Values("facets", "rpim"),
                         [](const auto& test) { return std::string(test.param); });

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
