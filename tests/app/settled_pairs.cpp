/// What the program decides where a pair leaves it open: which side is the slave, and the discretisation.

#include "osculate/app/compile.hpp"
#include "osculate/scene/writer.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <gmock/gmock.h>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

using testing::HasSubstr;

const std::string text = R"(
bodies:
  lower:
    mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [4, 4, 2]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3, density: 1000}}
  upper:
    mesh: {block: {origin: [0.2 m, 0.2 m, 1 m], size: [0.6 m, 0.6 m, 0.5 m], divisions: [3, 3, 2]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3, density: 1000}}
sets:
  bed: {body: lower, surface: z_min}
  ground: {body: lower, surface: z_max}
  under: {body: upper, surface: z_min}
  top: {body: upper, surface: z_max}
  side: {body: upper, surface: x_min}
supports:
  bed: {fix: [x, y, z]}
  side: {fix: [x, y]}
contact:
  joint: {between: [ground, under], friction: 0.2}
stages:
  press: {pressure: {top: 1 MPa}}
)";

struct Compiled {
    scene::Scene scene;
    Plan plan;
    explicit Compiled(const std::vector<scene::Override>& changes)
        : scene(scene::read_scene(support::scene_file("settled.yaml", text), changes)) {
        Timings timings;
        plan = compile(scene, 1, timings);
    }
    [[nodiscard]] const scene::Pair& pair() const { return scene.contact[0].second; }
    [[nodiscard]] const PlanItem& item(const std::string& part) const {
        return *std::ranges::find(plan.items, part, &PlanItem::part);
    }
};

using Changes = std::vector<scene::Override>;
Compiled compiled(const Changes& changes) {
    return Compiled(changes);
}

constexpr const char* lower_mesh = "bodies.lower.mesh.block.divisions";
constexpr const char* lower_E = "bodies.lower.material.linear_elastic.E";

TEST(SettledPairs, TheFinerSideIsTheSlave) {
    EXPECT_EQ(compiled({}).pair().slave, "under"); // 0.2 m on 0.25 m
    const Compiled finer = compiled({{lower_mesh, "[8, 8, 2]"}});
    EXPECT_EQ(finer.pair().slave, "ground");
    EXPECT_EQ(finer.pair().master.set, "under");
    EXPECT_THAT(finer.item("choice of slaves").reason,
                HasSubstr("the slave is ground, whose facets are 0.625 times as long as those of 'under'"));
}

TEST(SettledPairs, AMuchSofterSideIsTheSlaveHoweverCoarse) {
    EXPECT_EQ(compiled({{lower_E, "100 MPa"}}).pair().slave, "under");
    EXPECT_EQ(compiled({{lower_E, "9 MPa"}}).pair().slave, "ground");
    EXPECT_EQ(compiled({{lower_E, "111 GPa"}, {lower_mesh, "[8, 8, 2]"}}).pair().slave, "under");
}

TEST(SettledPairs, OfSidesMeshedAlikeTheSofterIsTheSlaveElseTheFirst) {
    const scene::Override alike{lower_mesh, "[5, 5, 2]"};
    EXPECT_EQ(compiled({alike, {lower_E, "0.8 GPa"}}).pair().slave, "ground");
    EXPECT_EQ(compiled({alike, {lower_E, "1.2 GPa"}}).pair().slave, "under");
    EXPECT_EQ(compiled({alike}).pair().slave, "ground");
    EXPECT_EQ(compiled({alike, {"contact.joint.between", "[under, ground]"}}).pair().slave, "under");
}

TEST(SettledPairs, OfSidesThatDifferTheOrderDecidesNothing) {
    const Compiled one = compiled({}), other = compiled({{"contact.joint.between", "[under, ground]"}});
    EXPECT_EQ(one.pair(), other.pair());
}

TEST(SettledPairs, ASceneThatIsWrittenHasTheRolesAndCompilesTheSame) {
    const Compiled settled = compiled({});
    EXPECT_EQ(settled.pair().between[0], "");
    EXPECT_EQ(settled.pair().discretisation, Discretisation::petrov_galerkin);
    scene::Scene again = scene::parse_scene(scene::write_scene(settled.scene), "again");
    Timings timings;
    const Plan plan = compile(again, 1, timings);
    EXPECT_EQ(again.contact, settled.scene.contact);
    EXPECT_EQ(plan.model.pairs[0]->slaves().node, settled.plan.model.pairs[0]->slaves().node);
}

TEST(SettledPairs, StagesDecideTheDiscretisationAndExplainSaysSo) {
    EXPECT_EQ(compiled({}).plan.model.pairs[0]->options().discretisation, Discretisation::petrov_galerkin);
    EXPECT_EQ(compiled({}).item("averaged forces").reason, "joint: petrov_galerkin: every stage is static");
    const Compiled dynamic = compiled({{"stages.press.analysis", "dynamic"}});
    EXPECT_EQ(dynamic.plan.model.pairs[0]->options().discretisation, Discretisation::node);
    EXPECT_FALSE(dynamic.item("averaged forces").present);
    EXPECT_EQ(dynamic.item("averaged forces").reason, "joint: node, which conserves energy: a stage is dynamic");
    for (const auto& [word, choice] : {std::pair{"node", Discretisation::node}, {"mortar", Discretisation::mortar}}) {
        const Compiled asked = compiled({{"contact.joint.discretisation", word}});
        EXPECT_EQ(asked.plan.model.pairs[0]->options().discretisation, choice);
        EXPECT_EQ(asked.item("averaged forces").reason, std::string("joint: ") + word);
    }
    // one dynamic stage is enough
    std::string two = text;
    two += "  drop: {analysis: dynamic, steps: 1}\n";
    scene::Scene scene = scene::parse_scene(two, "two");
    Timings timings;
    (void)compile(scene, 1, timings);
    EXPECT_EQ(scene.contact[0].second.discretisation, Discretisation::node);
}

TEST(SettledPairs, ThePressureDependsOnTheOrderOfSidesOnlyWhereNothingElseDecides) {
    // meshed alike but not matching, equally stiff: either may be the slave, the force is the load's and pressures agree
    std::vector<double> uz;
    for (const char* order : {"[under, ground]", "[ground, under]"}) {
        support::SceneRun run;
        support::run_scene(
            run, support::scene_file("either.yaml", text),
            {{lower_mesh, "[5, 5, 2]"}, {"contact.joint.between", order}, {"contact.joint.friction", "0"}});
        double least = 0;
        for (const Vec3& u : run.steps.back().state.u) least = std::min(least, u.z());
        uz.push_back(least);
    }
    EXPECT_NEAR(uz[0] / uz[1], 1, 0.01);
}

TEST(SettledPairs, PlaneMastersTakeFacetsInDynamicsAndCurvedOnesABlend) {
    const auto surface = [](const Changes& changes) { return compiled(changes).pair().master.surface; };
    const auto facets = [&](const Changes& changes) {
        return std::holds_alternative<scene::FacetsSurface>(surface(changes));
    };
    const scene::Override dynamic{"stages.press.analysis", "dynamic"};
    EXPECT_TRUE(facets({dynamic}));
    EXPECT_FALSE(facets({})) << "statics, where shares of the master's nodes would change";
    EXPECT_EQ(surface({}),
              (std::variant<scene::AutomaticSurface, scene::FacetsSurface, scene::RpimSurface, scene::BlendSurface>(
                  scene::BlendSurface{})));
    EXPECT_FALSE(facets({dynamic, {"contact.joint.discretisation", "petrov_galerkin"}}));
    EXPECT_FALSE(facets({dynamic, {"contact.joint.surface", "blend"}}));
}

constexpr const char* analysis = "stages.press.analysis";
const scene::Override general{"contact", "{general: {friction: 0.3}}"};

scene::DynamicAnalysis analysed(const Changes& changes) {
    return std::get<scene::DynamicAnalysis>(compiled(changes).scene.stages[0].second.analysis);
}

TEST(SettledDynamics, GeneralContactSettlesUnlessEnergyIsAskedFor) {
    struct Case {
        const char* analysis;
        bool settles;
    };
    for (const Case& one :
         {Case{"dynamic", true}, Case{"{dynamic: {integrator: {generalised_alpha: {rho_inf: 0}}}}", true},
          Case{"{dynamic: {integrator: {generalised_alpha: {rho_inf: 1}}}}", false},
          Case{"{dynamic: {integrator: newmark}}", false},
          Case{"{dynamic: {integrator: {newmark: {beta: 0.3, gamma: 0.6}}}}", true},
          Case{"{dynamic: {integrator: {hht: {alpha: 0}}}}", false},
          Case{"{dynamic: {integrator: backward_euler}}", true}, Case{"{dynamic: {impacts: resolved}}", false}}) {
        const Changes changes{general, {analysis, one.analysis}, {"stages.press.steps", "20"}};
        const scene::DynamicAnalysis found = analysed(changes);
        EXPECT_EQ(found.impacts, one.settles ? scene::Impacts::inelastic : scene::Impacts::resolved) << one.analysis;
        EXPECT_DOUBLE_EQ(found.stiffness_damping.value(), one.settles ? 0.1 / 20 : 0) << "of 1 s; " << one.analysis;
    }
    const Changes bounded{general, {analysis, "dynamic"}, {"stages.press.control.error_tolerance", "1 mm"}};
    EXPECT_EQ(analysed(bounded).impacts, scene::Impacts::resolved);
}

TEST(SettledDynamics, PairsByHandResolveImpactsUnlessTold) {
    EXPECT_EQ(analysed({{analysis, "dynamic"}}).impacts, scene::Impacts::resolved);
    EXPECT_EQ(analysed({{analysis, "dynamic"}}).stiffness_damping, 0);
    const scene::DynamicAnalysis told = analysed({{analysis, "{dynamic: {impacts: inelastic}}"}});
    EXPECT_EQ(told.impacts, scene::Impacts::inelastic);
    EXPECT_DOUBLE_EQ(told.stiffness_damping.value(), 0.1);
    EXPECT_EQ(analysed({{analysis, "{dynamic: {impacts: inelastic, stiffness_damping: 0 s}}"}}).stiffness_damping, 0);
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
