/// Derivatives of single quantities by the adjoint of a run.

#include "scenes/program.hpp"

#include <cmath>
#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class GradientsOfRuns : public Program {
protected:
    using Changes = std::vector<std::string>;

    [[nodiscard]] Outcome run(const std::string& scene, const Changes& changes, const std::string& name) const {
        std::vector<std::string> arguments{"run", scene, "-o", name, "--quiet"};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        return osculate(arguments);
    }
    [[nodiscard]] double derivative(const fs::path& table, const std::string& name) const {
        const Csv rows(table);
        for (std::size_t row = 0; row < rows.rows.size(); ++row)
            if (rows.text(row, "name") == name) return rows.number(row, "derivative");
        ADD_FAILURE() << "no row " << name << " in " << table;
        return 0;
    }
    /// Gradients of two forces, which hold one another in balance, and of a mean displacement beside derivatives that go forward: products
    /// with a tangent that is not transposed.
    void expect_as_forward(const std::string& scene, Changes changes, const std::string& pair, const std::string& held,
                           const std::string& moved,
                           const std::vector<std::pair<std::string, std::string>>& numbers) const {
        constexpr double allowed = 1e-6;
        std::string by, forward;
        for (const auto& [name, key] : numbers) {
            by += (by.empty() ? "" : ", ") + name + ": " + key;
            forward += (forward.empty() ? "" : ", ") + name + ": " + key;
        }
        changes.push_back("output.derivatives={" + forward + "}");
        changes.push_back("output.gradients={force: {contact_force: {pair: " + pair + ", direction: [0, 1, 0]}, by: {" +
                          by + "}}, reaction: {reaction: {set: " + held + ", direction: [0, 1, 0]}, by: {" + by +
                          "}}, displacement: {displacement: {set: " + moved + ", direction: [0, 0, 1]}, by: {" + by +
                          "}}}");
        changes.push_back("output.probes={moved: {nodes: {set: " + moved +
                          ", fields: [displacement], reduce: [mean]}}}");
        changes.emplace_back("output.plots={}");
        const Outcome outcome = run(scene, changes, "run");
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        for (const auto& [name, key] : numbers) {
            const fs::path out = folder / "run" / "derivatives" / name;
            const Csv history(out / "history.csv"), probe(out / "probes/moved.csv");
            const auto last = [](const Csv& table, const std::string& column) {
                return table.number(table.rows.size() - 1, column);
            };
            const auto expect = [&](const std::string& gradient, double value) {
                EXPECT_NEAR(derivative(folder / "run/gradients" / (gradient + ".csv"), name), value,
                            allowed * std::abs(value))
                    << gradient << " by " << key;
            };
            expect("force", last(history, "pair." + pair + ".force_y"));
            expect("reaction", -last(history, "pair." + pair + ".force_y"));
            expect("displacement", last(probe, "mean_displacement_z"));
        }
        fs::remove_all(folder / "run");
    }

    const std::string blocks = scene_file("tests/scenes/column.yaml"),
                      half_tube = scene_file("configs/paper/half_tube.yaml");
    const Changes coarse{"bodies.tube.mesh.half_tube.divisions=[7, 6, 1]",
                         "bodies.contactor.mesh.contactor.divisions=[6, 8, 1]", "stages.slide.steps=6",
                         "solver.tolerance=1e-12"};
    const std::vector<std::pair<std::string, std::string>> of_half_tube{
        {"mu", "contact.sliding.friction"},
        {"pressure", "stages.press.pressure.top"},
        {"path", "stages.slide.displacement.rear.y"},
        {"thickness", "bodies.tube.mesh.half_tube.thickness"}};
};

/// A column of two blocks that stresses alone shorten: u(top) = -p (l_lower/E_lower + l_upper/E_upper), and every force is p.
TEST_F(GradientsOfRuns, AreThoseOfAColumn) {
    const Outcome outcome =
        run(blocks,
            {"output.gradients={top: {displacement: {set: top, direction: [0, 0, 2]}, by: {E: "
             "bodies.upper.material.linear_elastic.E, p: {key: stages.press.pressure.top, change: 1e-3}}}, bed: "
             "{reaction: {set: bed, direction: [0, 0, -1]}, by: {p: stages.press.pressure.top}}, joint: "
             "{contact_force: {pair: joint, direction: [1, 0, 1]}, by: {p: stages.press.pressure.top}}}"},
            "run");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    constexpr double E = 1e7, p = 20e3, exact = 1e-7;
    const fs::path tables = folder / "run/gradients";
    EXPECT_NEAR(derivative(tables / "top.csv", "E"), p / (E * E), exact * p / (E * E));
    EXPECT_NEAR(derivative(tables / "top.csv", "p"), -2 / E, exact * 2 / E);
    EXPECT_NEAR(derivative(tables / "bed.csv", "p"), -1, exact);
    EXPECT_NEAR(derivative(tables / "joint.csv", "p"), 1 / std::sqrt(2), exact);
    EXPECT_EQ(Csv(tables / "top.csv").number(1, "value"), p);
}

TEST_F(GradientsOfRuns, FollowFrictionAlongACurvedSurface) {
    expect_as_forward(half_tube, coarse, "sliding", "rear", "face", of_half_tube);
}

TEST_F(GradientsOfRuns, FollowLargeStrains) {
    Changes changes = coarse;
    changes.emplace_back("bodies.contactor.material={neo_hookean: {E: 10 MPa, nu: 0.2}}");
    changes.emplace_back("stages.press.pressure.top=0.3 MPa");
    expect_as_forward(half_tube, changes, "sliding", "rear", "face", of_half_tube);
}

/// Slave nodes that are driven stick elastically: their forces at the start of a step count.
TEST_F(GradientsOfRuns, FollowElasticStick) {
    Changes changes = coarse;
    changes.emplace_back("contact.sliding.friction=0.6");
    changes.emplace_back("contact.sliding.stick_stiffness=50 MPa/m");
    expect_as_forward(half_tube, changes, "sliding", "rear", "face", of_half_tube);
}

TEST_F(GradientsOfRuns, LeaveTheRunAsItIs) {
    Changes asked = coarse;
    asked.emplace_back("output.gradients={f: {contact_force: {pair: sliding, direction: [0, 1, 0]}, by: {mu: "
                       "contact.sliding.friction}}}");
    ASSERT_EQ(run(half_tube, coarse, "alone").code, 0);
    ASSERT_EQ(run(half_tube, asked, "led").code, 0);
    for (const char* table : {"history.csv", "steps.csv"})
        EXPECT_EQ(content(folder / "alone" / table), content(folder / "led" / table));
    EXPECT_FALSE(fs::exists(folder / "alone/gradients"));
}

TEST_F(GradientsOfRuns, SayWhatTheyCannotHave) {
    const auto said = [&](const std::string& scene, const Changes& changes) {
        const Outcome outcome = run(scene, changes, "refused");
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_FALSE(fs::exists(folder / "refused"));
        return outcome.err;
    };
    const auto gradient = [](const std::string& of, const std::string& key) {
        return "output.gradients={q: {" + of + ", by: {p: " + key + "}}}";
    };
    const std::string top = "displacement: {set: top, direction: [0, 0, 1]}", load = "stages.press.pressure.top";
    EXPECT_THAT(said(blocks, {gradient("displacement: {set: tup, direction: [0, 0, 1]}", load)}), HasSubstr("top"));
    EXPECT_THAT(said(blocks, {gradient("reaction: {set: under, direction: [0, 0, 1]}", load)}),
                HasSubstr("a set that the last stage holds or drives"));
    EXPECT_THAT(said(blocks, {gradient(top, "bodies.uper.material.linear_elastic.E")}),
                HasSubstr("no 'bodies.uper' in the resolved scene"));
    EXPECT_THAT(said(blocks, {gradient(top, "stages.press.steps")}), HasSubstr("of what is simulated"));
    EXPECT_THAT(said(scene_file("configs/validation/falling_block.yaml"),
                     {gradient("displacement: {set: underside, direction: [0, 0, 1]}", "gravity.2")}),
                HasSubstr("dynamic"));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
