/// Nodes that are moved before a run, and derivatives by their positions.

#include "scenes/program.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Imperfections : public Program {
protected:
    [[nodiscard]] Outcome run(const std::string& scene, const std::vector<std::string>& changes,
                              const std::string& name) const {
        std::vector<std::string> arguments{"run", scene, "-o", name, "--quiet"};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        return osculate(arguments);
    }
    [[nodiscard]] double derivative(const std::string& table, std::size_t row) const {
        return Csv(folder / table).number(row, "derivative");
    }
    const std::string column = scene_file("tests/scenes/imperfect_column.yaml");
};

/// u(top) = -p (l_lower + l_upper) / E wherever nodes inside lie: the patch test.
TEST_F(Imperfections, OfASetChangeLengthsAndInsideNothing) {
    const Outcome outcome = run(column, {}, "run");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    constexpr double E = 1e7, p = 20e3, length = 2.5, exact = 1e-10, exact_difference = 1e-7;
    const Csv loaded(folder / "run/probes/loaded.csv");
    for (const char* name : {"min_displacement_z [m]", "max_displacement_z [m]"})
        EXPECT_NEAR(loaded.number(loaded.rows.size() - 1, name), -p * length / E, exact * p * length / E);
    EXPECT_NEAR(derivative("run/gradients/top.csv", 0), -p / E, exact_difference * p / E);
    EXPECT_NEAR(derivative("run/gradients/top.csv", 1), 0, exact_difference * p / E) << "a node inside is not felt";
}

/// By the position of one node of the master, of one of the slave and of one inside, along a curved surface with friction.
TEST_F(Imperfections, GiveDerivativesByPositionsOfNodes) {
    std::vector<std::string> changes{"bodies.tube.mesh.half_tube.divisions=[7, 6, 1]",
                                     "bodies.contactor.mesh.contactor.divisions=[6, 8, 1]",
                                     "stages.slide.steps=4",
                                     "stages.slide.duration=4 s",
                                     "stages.slide.displacement={rear: {y: 0.4 m}}",
                                     "solver.tolerance=1e-12",
                                     "sets.under={body: tube, node: {point: [0.3 m, 3.2 m, -2.9 m]}}",
                                     "sets.over={body: contactor, node: {point: [0.7 m, 2.1 m, -2.9 m]}}",
                                     "output.template=minimal",
                                     "output.plots={}"};
    const std::string half_tube = scene_file("configs/paper/half_tube.yaml");
    const auto force = [&](const std::string& under, const std::string& over) {
        std::vector<std::string> moved = changes;
        moved.push_back("imperfections={under: [0, 0, " + under + "], over: [" + over + ", 0, 0]}");
        const Outcome outcome = run(half_tube, moved, "moved");
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Csv rows(folder / "moved/history.csv");
        const double value = rows.number(rows.rows.size() - 1, "pair.sliding.force_y");
        fs::remove_all(folder / "moved");
        return value;
    };
    constexpr double h = 1e-3, allowed = 1e-4; // m; of differences, whose error is of the order of h^2
    const double by_under = (force("1 mm", "0") - force("-1 mm", "0")) / (2 * h),
                 by_over = (force("0", "1 mm") - force("0", "-1 mm")) / (2 * h);
    changes.emplace_back("imperfections={under: [0, 0, 0], over: [0, 0, 0]}");
    changes.emplace_back("output.gradients={drag: {contact_force: {pair: sliding, direction: [0, 1, 0]}, by: {under: "
                         "{key: imperfections.under.2, step: 1e-5}, over: {key: imperfections.over.0, step: 1e-5}}}}");
    const Outcome outcome = run(half_tube, changes, "run");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NEAR(derivative("run/gradients/drag.csv", 0), by_under, allowed * std::abs(by_under));
    EXPECT_NEAR(derivative("run/gradients/drag.csv", 1), by_over, allowed * std::abs(by_over));
}

/// Cross-sections of a slender bar moved aside by a cosine, and pushed: 1/(1 - P/P_Euler) - 1 as much again [Southwell]. Midside
/// nodes between the sections are in no set.
TEST_F(Imperfections, GrowUnderALoadAsAColumnsDo) {
    constexpr double E = 210e9, side = 0.02, length = 1, crooked = 1e-3, share = 0.5;
    constexpr int sections = 20;
    const double euler = std::pow(M_PI, 2) * E * std::pow(side, 4) / 12 / (length * length);
    std::ostringstream sets, moves, scene;
    for (int i = 1; i < sections; ++i) {
        const double x = -0.5 + static_cast<double>(i) / sections;
        sets << "  s" << i << ": {body: bar, box: {min: [" << x - 1e-3 << ", -0.011, -0.011], max: [" << x + 1e-3
             << ", 0.011, 0.011]}}\n";
        moves << "  s" << i << ": [0, 0, " << crooked * std::cos(M_PI * x) << "]\n";
    }
    scene << "bodies:\n  bar:\n    mesh: {block: {origin: [-0.5, -0.01, -0.01], size: [1, 0.02, 0.02], divisions: ["
          << sections << ", 2, 2], element: hex20}}\n"
          << "    material: {saint_venant_kirchhoff: {E: 210 GPa, nu: 0}}\nsets:\n"
          << "  right: {body: bar, surface: x_max}\n  side: {body: bar, surface: y_min}\n"
          << "  left_axis: {body: bar, box: {min: [-0.501, -0.011, -0.001], max: [-0.499, 0.011, 0.001]}}\n"
          << "  right_axis: {body: bar, box: {min: [0.499, -0.011, -0.001], max: [0.501, 0.011, 0.001]}}\n"
          << "  middle: {body: bar, box: {min: [-0.001, -0.011, -0.011], max: [0.001, 0.011, 0.011]}}\n"
          << sets.str() << "imperfections:\n"
          << moves.str() << "supports:\n  left_axis: {fix: [x, z]}\n  right_axis: {fix: [z]}\n"
          << "  side: {symmetry: [0, 1, 0]}\nstages:\n  push: {steps: 2, pressure: {right: "
          << share * euler / (side * side) << "}}\noutput:\n  template: minimal\n"
          << "  probes: {middle: {nodes: {set: middle, fields: [displacement], reduce: [mean]}}}\n";
    std::ofstream(folder / "bar.yaml") << scene.str();
    const Outcome outcome = run("bar.yaml", {}, "run");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Csv middle(folder / "run/probes/middle.csv");
    const double expected = crooked * share / (1 - share),
                 of_the_bar = 0.005; // shortening, and straight edges for a cosine
    EXPECT_NEAR(middle.number(middle.rows.size() - 1, "mean_displacement_z [m]"), expected, of_the_bar * expected);
}

TEST_F(Imperfections, ThatCannotBeAreRefused) {
    const auto said = [&](const std::vector<std::string>& changes) {
        const Outcome outcome = run(column, changes, "refused");
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_FALSE(fs::exists(folder / "refused"));
        return outcome.err;
    };
    EXPECT_THAT(said({"imperfections.inside=[0, 0, 260 mm]"}), HasSubstr("elements fold"));
    EXPECT_THAT(said({"imperfections={insight: [0, 0, 1 mm]}", "output.gradients={}"}), HasSubstr("inside"));
    EXPECT_THAT(said({"bodies.upper.rigid={}"}), HasSubstr("a set of rigid body 'upper'"));
    EXPECT_THAT(said({"sets.inside.node.point=[0.25 m, 0.5 m, 1.5 m]"}), HasSubstr("2 nodes as near"));
    EXPECT_THAT(said({"output.gradients.top.by.length={key: imperfections.top.1}"}),
                HasSubstr("or a step beside its key"));
}

/// A tie or `adjust` that puts nodes back would leave the run, or a derivative, without the imperfection.
TEST_F(Imperfections, ThatOthersUndoAreRefused) {
    const std::vector<std::string> plain{"output.gradients={}", "output.derivatives={}"};
    const auto said = [&](std::vector<std::string> changes) {
        changes.insert(changes.end(), plain.begin(), plain.end());
        const Outcome outcome = run(column, changes, "run");
        fs::remove_all(folder / "run");
        return outcome.code == 0 ? "" : outcome.err;
    };
    const std::string tie = "ties={joint: {slave: under, master: ground}}", untied = "contact={}",
                      adjust = "contact.joint.adjust=20 mm";
    EXPECT_THAT(said({untied, tie, "imperfections={under: [0, 0, 10 mm]}"}), HasSubstr("9 that are, one at ["));
    EXPECT_THAT(said({adjust, "imperfections={under: [0, 0, 10 mm]}"}), HasSubstr("move those of the master"));
    EXPECT_EQ(said({untied, tie, "imperfections={ground: [0, 0, 10 mm]}"}), "") << "the slave's go along";
    EXPECT_EQ(said({untied, tie, "imperfections={under: [10 mm, 0, 0]}"}), "") << "along the master they stay";
    const std::string apart = "bodies.upper.mesh.block.origin=[0 m, 0 m, 1.0002 m]"; // a gap that the tie closes
    EXPECT_EQ(said({untied, tie, apart, "imperfections={under: [10 mm, 0, 0]}"}), "");
    EXPECT_EQ(said({untied, tie, apart, "imperfections={ground: [0, 0, 10 um], under: [0, 0, 10 um]}"}), "");
    EXPECT_THAT(said({untied, tie, apart, "imperfections={under: [0, 0, 10 um], top: [0, 0, 0]}"}),
                AllOf(HasSubstr("imperfections.under"), Not(HasSubstr("imperfections.top"))));
    const std::string far = "bodies.upper.mesh.block.origin=[0 m, 0 m, 1.2 m]",
                      near_tie = tie.substr(0, tie.size() - 2);
    EXPECT_EQ(said({untied, near_tie + ", distance: 0.05 m}}", far, "imperfections={under: [0, 0, -0.16 m]}"}), "")
        << "tied for its imperfection alone";
    const Outcome from_zero = run(column,
                                  {adjust, "imperfections={under: [0, 0, 0]}", plain.front(),
                                   "output.derivatives={height: {key: imperfections.under.2, step: 1e-4}}"},
                                  "run");
    EXPECT_EQ(from_zero.code, 2) << "its changes are undone";
    EXPECT_THAT(from_zero.err, HasSubstr("output.derivatives.height.key"));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
