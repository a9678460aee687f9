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
    using Numbers = std::vector<std::pair<std::string, std::string>>; ///< names and keys
    /// A quantity, and where the run says what it is.
    struct Quantity {
        std::string name, of, table, column;
        double sign = 1;
    };
    /// Gradients beside derivatives that go forward: products with a tangent that is not transposed.
    void expect_as_forward(const std::string& scene, Changes changes, const std::vector<Quantity>& quantities,
                           const Numbers& numbers) const {
        constexpr double allowed = 1e-6;
        std::string by, all;
        for (const auto& [name, key] : numbers) by += (by.empty() ? "" : ", ") + name + ": " + key;
        for (const Quantity& q : quantities)
            all += (all.empty() ? "" : ", ") + q.name + ": {" + q.of + ", by: {" + by + "}}";
        changes.push_back("output.derivatives={" + by + "}");
        changes.push_back("output.gradients={" + all + "}");
        changes.emplace_back("output.plots={}");
        const Outcome outcome = run(scene, changes, "run");
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        for (const auto& [name, key] : numbers)
            for (const Quantity& q : quantities) {
                const Csv rows(folder / "run" / "derivatives" / name / q.table);
                const double value = q.sign * rows.number(rows.rows.size() - 1, q.column);
                EXPECT_NE(value, 0);
                EXPECT_NEAR(derivative(folder / "run/gradients" / (q.name + ".csv"), name), value,
                            allowed * std::abs(value))
                    << q.name << " by " << key;
            }
        fs::remove_all(folder / "run");
    }
    /// Two forces, which hold one another in balance, and a mean displacement.
    void expect_as_forward(const std::string& scene, Changes changes, const std::string& pair, const std::string& held,
                           const std::string& moved, const Numbers& numbers) const {
        changes.push_back("output.probes={moved: {nodes: {set: " + moved +
                          ", fields: [displacement], reduce: [mean]}}}");
        const std::string force = "pair." + pair + ".force_y";
        expect_as_forward(
            scene, changes,
            {{"force", "contact_force: {pair: " + pair + ", direction: [0, 1, 0]}", "history.csv", force},
             {"reaction", "reaction: {set: " + held + ", direction: [0, 1, 0]}", "history.csv", force, -1},
             {"displacement", "displacement: {set: " + moved + ", direction: [0, 0, 1]}", "probes/moved.csv",
              "mean_displacement_z"}},
            numbers);
    }

    const std::string blocks = scene_file("tests/scenes/column.yaml"),
                      half_tube = scene_file("configs/paper/half_tube.yaml");
    const Changes coarse{"bodies.tube.mesh.half_tube.divisions=[7, 6, 1]",
                         "bodies.contactor.mesh.contactor.divisions=[6, 8, 1]", "stages.slide.steps=6",
                         "solver.tolerance=1e-12"};
    const Numbers of_half_tube{{"mu", "contact.sliding.friction"},
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

/// So many steps that the first ones add nothing to most derivatives, but are all there is to two of them.
TEST_F(GradientsOfRuns, LeaveOutNoStepsThatCount) {
    Changes changes = coarse;
    changes.emplace_back("stages.slide.steps=24");
    changes.emplace_back("contact.sliding.friction=0.1");
    changes.emplace_back("stages.press.friction.sliding=0.2");
    changes.emplace_back("stages.slide.friction.sliding=0.1");
    expect_as_forward(half_tube, changes, "sliding", "rear", "face",
                      {{"mu", "stages.slide.friction.sliding"},
                       {"pressure", "stages.press.pressure.top"},
                       {"path", "stages.slide.displacement.rear.y"}});
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

/// A hub that is shrunk on a shaft, and the shaft is pressed out: stages, pairs out of force, temperatures.
TEST_F(GradientsOfRuns, FollowTemperatures) {
    expect_as_forward(
        scene_file("configs/tutorials/press_fit.yaml"),
        {"bodies.shaft.mesh.tube.divisions=[24, 2, 3]", "bodies.hub.mesh.tube.divisions=[28, 2, 5]",
         "stages.cool.temperature.hub=10 K", "solver.tolerance=1e-12", "output.history=[pairs, reactions]",
         "output.probes={moved: {nodes: {set: bore, fields: [displacement], reduce: [mean]}}}"},
        {{"push", "contact_force: {pair: fit, direction: [0, 0, 1]}", "history.csv", "pair.fit.force_z"},
         {"held", "reaction: {set: hub_end, direction: [0, 0, 1]}", "history.csv", "set.hub_end.reaction_z"},
         {"wide", "displacement: {set: bore, direction: [1, 0, 0]}", "probes/moved.csv", "mean_displacement_x"}},
        {{"E", "bodies.hub.material.linear_elastic.E"},
         {"mu", "stages.push.friction.fit"},
         {"expansion", "bodies.hub.material.linear_elastic.expansion"},
         {"warm", "stages.cool.temperature.hub"},
         {"thick", "bodies.hub.mesh.tube.thickness"},
         {"way", "{key: stages.push.displacement.shaft_end.z, change: 3e-4}"}});
}

/// A block that falls, touches and bounces, by numbers of what falls, of how it begins, and of what drives it; its plate with dampers.
TEST_F(GradientsOfRuns, FollowABounce) {
    const Quantity up{"up", "displacement: {set: underside, direction: [0, 0, 1]}", "probes/moved.csv",
                      "mean_displacement_z"},
        along{"along", "displacement: {set: underside, direction: [1, 0, 0]}", "probes/moved.csv",
              "mean_displacement_x"},
        held{"held", "reaction: {set: rigid, direction: [0, 0, 1]}", "history.csv", "set.rigid.reaction_z"};
    const auto falling = [](const std::string& duration, double rho_inf) {
        return Changes{"stages.fall.control={step_size: fixed, allowed_interpenetration: 1}",
                       "bodies.block.initial_velocity=[0.2 m/s, 0 m/s, -2 m/s]",
                       "stages.fall.duration=" + duration,
                       "stages.fall.steps=100",
                       "solver.tolerance=1e-12",
                       "contact.floor.friction=0.2",
                       "stages.fall.analysis.dynamic={integrator: {generalised_alpha: {rho_inf: " +
                           std::to_string(rho_inf) + "}}, mass_damping: 0.5 1/s, stiffness_damping: 1e-4 s}",
                       "output.history=[pairs, reactions]",
                       "output.probes={moved: {nodes: {set: underside, fields: [displacement], reduce: [mean]}}}"};
    };
    const Numbers numbers{{"E", "bodies.block.material.linear_elastic.E"},
                          {"density", "bodies.block.material.linear_elastic.density"},
                          {"gravity", "gravity.2"},
                          {"start", "bodies.block.initial_velocity.2"},
                          {"height", "{key: bodies.block.mesh.block.origin.2, change: 2e-6}"},
                          {"mu", "contact.floor.friction"},
                          {"damping", "stages.fall.analysis.dynamic.mass_damping"}};
    const std::string scene = scene_file("configs/validation/falling_block.yaml");
    expect_as_forward(scene, falling("0.25 s", 0.6), {up, along}, numbers);
    expect_as_forward(scene, falling("0.1825 s", 1), {held}, {numbers[0], numbers[1], numbers[3]}); // it touches
}

/// Of rubber, whose wave speed is seven times that of the fall: forces of elements are means over a step, and their tangent is not symmetric.
TEST_F(GradientsOfRuns, FollowABounceAtFiniteStrain) {
    const Quantity along{"along", "displacement: {set: underside, direction: [1, 0, 0]}", "probes/moved.csv",
                         "mean_displacement_x"};
    for (const auto& [material, rho_inf] : {std::pair{"neo_hookean", "0.6"}, {"saint_venant_kirchhoff", "1"}})
        expect_as_forward(
            scene_file("configs/validation/falling_block.yaml"),
            {"stages.fall.control={step_size: fixed, allowed_interpenetration: 1}",
             "bodies.block.initial_velocity=[0.2 m/s, 0 m/s, -2 m/s]",
             std::string("bodies.block.material={") + material + ": {E: 200 kPa, nu: 0.3, density: 1000}}",
             "stages.fall.duration=0.22 s", "stages.fall.steps=88", "solver.tolerance=1e-12",
             "contact.floor.friction=0.2",
             std::string("stages.fall.analysis.dynamic={integrator: {generalised_alpha: {rho_inf: ") + rho_inf +
                 "}}, mass_damping: 0.5 1/s}",
             "output.history=[pairs, reactions]",
             "output.probes={moved: {nodes: {set: underside, fields: [displacement], reduce: [mean]}}}"},
            {along},
            {{"E", std::string("bodies.block.material.") + material + ".E"},
             {"density", std::string("bodies.block.material.") + material + ".density"},
             {"gravity", "gravity.2"},
             {"start", "bodies.block.initial_velocity.2"},
             {"height", "{key: bodies.block.mesh.block.origin.2, change: 2e-6}"}});
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
    const std::string falling = scene_file("configs/validation/falling_block.yaml"),
                      fall = gradient("displacement: {set: underside, direction: [0, 0, 1]}", "gravity.2");
    EXPECT_THAT(said(falling, {fall, "bodies.block.material={neo_hookean: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}",
                               "stages.fall.analysis.dynamic.stiffness_damping=1e-5 s"}),
                HasSubstr("found a dynamic stage with stiffness_damping, and body 'block' at finite strain"));
    EXPECT_THAT(said(falling, {fall, "contact.floor.pressure_overclosure={linear: {stiffness: 1e9 N/m^3}}"}),
                HasSubstr("pair 'floor', whose forces in dynamics are means over a step"));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
