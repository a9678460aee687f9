#include "scenes/program.hpp"

#include <cmath>
#include <string>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

class RidgeOnRidge : public Program {};

TEST_F(RidgeOnRidge, ReportsTheForceThatItsHoldersFeel) {
    const Csv history(run(scene_file("tests/scenes/ridges.yaml")) / "history.csv");
    ASSERT_EQ(history.rows.size(), 4U);
    constexpr double balance = 1e-7; // of the force; the solver's tolerance is 1e-9
    constexpr double moves = 0.006;  // m, the crossing from where ridges cross at first
    for (std::size_t i = 0; i < history.rows.size(); ++i) {
        const auto number = [&](const std::string& column) { return history.number(i, column); };
        const double press = number("body.lower.contact_force_z");
        EXPECT_LT(press, -100) << i;
        for (const std::string axis : {"x", "y", "z"}) {
            const double upper = number("body.upper.contact_force_" + axis),
                         lower = number("body.lower.contact_force_" + axis),
                         held = number("set.left.reaction_" + axis) + number("set.right.reaction_" + axis),
                         pushed = number("set.front.reaction_" + axis) + number("set.rear.reaction_" + axis);
            EXPECT_NEAR(upper + pushed, 0, -balance * press) << i << axis;
            EXPECT_NEAR(lower + held, 0, -balance * press) << i << axis;
            EXPECT_NEAR(upper + lower, 0, -balance * press) << i << axis;
        }
        // all forces act at the crossing, on top of the lower ridge
        const double x = 0.013, z = 0.0707, fx = number("body.lower.contact_force_x"),
                     fy = number("body.lower.contact_force_y");
        EXPECT_NEAR(number("body.lower.contact_moment_x"), -z * fy, -moves * press) << i;
        EXPECT_NEAR(number("body.lower.contact_moment_y"), z * fx - x * press, -moves * press) << i;
        EXPECT_NEAR(number("body.lower.contact_moment_z"), x * fy, -moves * press) << i;
        EXPECT_LE(number("pair.general.friction"), (0.3 + balance) * number("pair.general.normal")) << i;
        EXPECT_NEAR(std::hypot(number("pair.general.normal"), number("pair.general.friction")),
                    std::hypot(press, fx, fy), -balance * press)
            << i;
    }
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
