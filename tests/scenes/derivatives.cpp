/// Derivatives of a run's tables by numbers of its scene.

#include "scenes/program.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class DerivativesOfRuns : public Program {
protected:
    using Changes = std::vector<std::string>;

    /// Rows of history.csv or of a probe's table, in a folder of their own.
    [[nodiscard]] fs::path run_into(const std::string& name, const std::string& scene, const Changes& changes) const {
        std::vector<std::string> arguments{"run", scene, "-o", name, "--quiet"};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        const Outcome outcome = osculate(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return folder / name;
    }

    /// Compares derivatives with differences of whole runs with the number changed by a part of it.
    /// @param columns  whose largest derivative measures the errors
    void expect_differences(const std::string& scene, const std::string& key, double value, const Changes& changes,
                            const std::vector<std::string>& columns, double allowed) const {
        constexpr double part = 1e-4; // the difference's own error is of the order of its square
        const auto with = [&](double other) {
            Changes all = changes;
            std::ostringstream text;
            text.precision(17);
            text << key << '=' << other;
            all.push_back(text.str());
            return all;
        };
        Changes asked = changes;
        asked.push_back("output.derivatives={p: " + key + "}");
        const Csv derivative(run_into("own", scene, asked) / "derivatives/p/history.csv"),
            below(run_into("below", scene, with(value * (1 - part))) / "history.csv"),
            above(run_into("above", scene, with(value * (1 + part))) / "history.csv");
        ASSERT_EQ(derivative.rows.size(), below.rows.size());
        ASSERT_EQ(derivative.rows.size(), above.rows.size());
        double largest = 0;
        for (const std::string& column : columns)
            for (std::size_t row = 0; row < derivative.rows.size(); ++row)
                largest = std::max(largest, std::abs(derivative.number(row, column)));
        ASSERT_GT(largest, 0);
        for (const std::string& column : columns)
            for (std::size_t row = 0; row < derivative.rows.size(); ++row) {
                const double difference = (above.number(row, column) - below.number(row, column)) / (2 * part * value);
                EXPECT_NEAR(derivative.number(row, column), difference, allowed * largest) << column << " row " << row;
            }
    }

    const std::string blocks = scene_file("tests/scenes/column.yaml");
    const std::string half_tube = scene_file("configs/paper/half_tube.yaml"),
                      falling = scene_file("configs/validation/falling_block.yaml");
    const Changes coarse{"bodies.tube.mesh.half_tube.divisions=[7, 6, 1]",
                         "bodies.contactor.mesh.contactor.divisions=[6, 8, 1]", "stages.slide.steps=6",
                         "solver.tolerance=1e-12"};
};

/// A column of two blocks that stresses alone shorten: u(top) = -p (l_lower/E_lower + l_upper/E_upper).
TEST_F(DerivativesOfRuns, AreThoseOfAColumn) {
    const fs::path out = run_into("run", blocks,
                                  {"output.derivatives={soft: bodies.upper.material.linear_elastic.E, load: {key: "
                                   "stages.press.pressure.top, change: 1e-3}}"});
    constexpr double E = 1e7, p = 20e3, exact = 1e-7;
    const auto last = [&](const std::string& name) {
        const Csv table(out / "derivatives" / name / "probes/loaded.csv");
        return table.number(table.rows.size() - 1, "area_mean_displacement_z");
    };
    EXPECT_NEAR(last("soft"), p / (E * E), exact * p / (E * E));
    EXPECT_NEAR(last("load"), -2 / E, exact * 2 / E);
    EXPECT_NEAR(Csv(out / "derivatives/load/history.csv").number(3, "pair.joint.normal"), 1, exact);
}

TEST_F(DerivativesOfRuns, FollowFrictionAlongACurvedSurface) {
    const std::vector<std::string> forces{"pair.sliding.force_y", "pair.sliding.normal", "pair.sliding.friction",
                                          "set.rear.reaction_y"};
    constexpr double allowed = 1e-6;
    expect_differences(half_tube, "contact.sliding.friction", 0.1, coarse, forces, allowed);
    expect_differences(half_tube, "bodies.contactor.material.linear_elastic.E", 1e7, coarse, forces, allowed);
    expect_differences(half_tube, "bodies.tube.mesh.half_tube.thickness", 1, coarse, forces, allowed); // moves nodes
}

/// Steps stay as they are, so that the runs to compare with must take the same.
TEST_F(DerivativesOfRuns, FollowABounce) {
    const Changes equal{"stages.fall.control={step_size: fixed, allowed_interpenetration: 1}", "stages.fall.steps=500",
                        "solver.tolerance=1e-12"};
    expect_differences(falling, "bodies.block.material.linear_elastic.density", 1000, equal,
                       {"energy.kinetic", "energy.strain"}, 1e-4); // the bounce makes much of the difference's error
}

TEST_F(DerivativesOfRuns, LeaveTheRunAsItIs) {
    for (const std::string& scene : {half_tube, falling}) {
        const Changes changes = scene == half_tube ? coarse : Changes{"stages.fall.duration=0.3 s"};
        Changes asked = changes;
        asked.push_back(scene == half_tube ? "output.derivatives={p: contact.sliding.friction}"
                                           : "output.derivatives={p: bodies.block.material.linear_elastic.E}");
        const fs::path alone = run_into("alone", scene, changes), led = run_into("led", scene, asked);
        for (const char* table : {"history.csv", "steps.csv"}) EXPECT_EQ(content(alone / table), content(led / table));
        EXPECT_FALSE(fs::exists(alone / "derivatives"));
        fs::remove_all(alone);
        fs::remove_all(led);
    }
}

TEST_F(DerivativesOfRuns, ThatAreZeroAreWarnedOf) {
    const Outcome outcome = osculate({"run", blocks, "-o", "run", "--quiet", "--set",
                                      "output.derivatives={p: bodies.upper.initial_velocity.2}", "--set",
                                      "bodies.upper.initial_velocity=[0, 0, 1]"}); // in statics
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("derivative 'p' is 0"));
}

/// A block on a slope whose tangent is its friction: it slides with a little less.
TEST_F(DerivativesOfRuns, WithAKinkAreWarnedOf) {
    const Outcome outcome =
        osculate({"run", scene_file("configs/tutorials/block_on_incline.yaml"), "-o", "run", "--quiet", "--set",
                  "contact.sole.friction=0.5", "--set", "output.derivatives={p: contact.sole.friction}"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("more one way than the other"));
}

TEST_F(DerivativesOfRuns, SayWhatTheyCannotHave) {
    const auto said = [&](const std::string& scene, const Changes& changes, const Changes& options = {}) {
        std::vector<std::string> arguments{"run", scene, "-o", "refused", "--quiet"};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        arguments.insert(arguments.end(), options.begin(), options.end());
        const Outcome outcome = osculate(arguments);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_FALSE(fs::exists(folder / "refused"));
        return outcome.err;
    };
    EXPECT_THAT(said(blocks, {"output.derivatives={p: bodies.uper.material.linear_elastic.E}"}),
                HasSubstr("no 'bodies.uper' in the resolved scene"));
    EXPECT_THAT(said(blocks, {"output.derivatives={p: bodies.upper.material.linear_elastic.nu}"}),
                HasSubstr("a number other than 0"));
    EXPECT_THAT(said(blocks, {"output.derivatives={p: bodies.upper.material}"}), HasSubstr("found"));
    EXPECT_THAT(said(blocks, {"output.derivatives={p: bodies.upper.mesh.block.divisions.2}"}),
                HasSubstr("may be changed a little both ways"));
    EXPECT_THAT(said(blocks, {"output.derivatives={p: contact.joint.friction}", "contact={general: {friction: 0.2}}",
                              "output.probes={}", "output.plots={}"}),
                HasSubstr("contact by named pairs"));
    EXPECT_THAT(said(blocks, {"output.derivatives={p: stages.press.duration}"}), HasSubstr("of what is simulated"));
    EXPECT_THAT(said(blocks, {"output.derivatives={p: contact.joint.friction}"}, {"--checkpoint-every", "2"}),
                HasSubstr("a run without output.derivatives"));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
