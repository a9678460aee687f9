/// The way Newton's linear systems are solved is no part of the answer.

#include "osculate/app/load.hpp"
#include "osculate/equilibrium/tangent_choice.hpp"
#include "support/floating_point_traps.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::RunStep;
using support::SceneRun;

/// Of solutions whose residuals are below 1e-12 of the load: a small multiple of that times the condition of contact.
constexpr double same = 1e-10;

/// Largest difference of displacements and contact forces over all steps, of the largest of each.
double difference(const SceneRun& a, const SceneRun& b) {
    double u = 0, du = 0, lambda = 0, dlambda = 0;
    for (std::size_t k = 0; k < a.steps.size(); ++k) {
        const model::State &x = a.steps[k].state, &y = b.steps[k].state;
        for (std::size_t i = 0; i < x.u.size(); ++i) {
            u = std::max(u, x.u[i].norm());
            du = std::max(du, (x.u[i] - y.u[i]).norm());
        }
        for (std::size_t p = 0; p < x.contact.size(); ++p)
            for (std::size_t j = 0; j < x.contact[p].lambda.size(); ++j) {
                lambda = std::max(lambda, x.contact[p].lambda[j].norm());
                dlambda = std::max(dlambda, (x.contact[p].lambda[j] - y.contact[p].lambda[j]).norm());
            }
    }
    return std::max(du / u, dlambda / lambda);
}

void expect_same(const std::string& scene, std::vector<scene::Override> overrides) {
    overrides.push_back({"solver.tolerance", "1e-12"});
    SceneRun direct, condensed, iterative, multigrid;
    overrides.push_back({"solver.linear_solver", "direct"});
    support::run_scene(direct, support::shipped(scene), overrides);
    overrides.back() = {"solver.linear_solver", "condensed"};
    support::run_scene(condensed, support::shipped(scene), overrides);
    EXPECT_TRUE(condensed.plan.stages.front().tangent.condensed);
    overrides.back() = {"solver.linear_solver", "iterative"};
    support::run_scene(iterative, support::shipped(scene), overrides);
    overrides.back() = {"solver.linear_solver", "multigrid"};
    {
        const support::FloatingPointTraps suspended(false); // PETSc estimates eigenvalues at its own risk
        support::run_scene(multigrid, support::shipped(scene), overrides);
    }
    ASSERT_EQ(direct.steps.size(), condensed.steps.size());
    ASSERT_EQ(direct.steps.size(), iterative.steps.size());
    ASSERT_EQ(direct.steps.size(), multigrid.steps.size());
    EXPECT_LT(difference(direct, condensed), same);
    EXPECT_LT(difference(direct, iterative), same);
    EXPECT_LT(difference(direct, multigrid), same);
}

const std::vector<scene::Override> coarse{{"bodies.tube.mesh.half_tube.divisions", "[7, 5, 1]"},
                                          {"bodies.contactor.mesh.contactor.divisions", "[4, 5, 1]"},
                                          {"stages.slide.steps", "4"},
                                          {"stages.slide.duration", "4 s"},
                                          {"stages.slide.displacement", "{rear: {y: 0.4 m}}"}};

TEST(LinearSolvers, GiveTheSameHalfTube) {
    expect_same("paper/half_tube.yaml", coarse);
}

TEST(LinearSolvers, GiveTheSameHalfTubeOnFacetsByMortar) {
    auto overrides = coarse;
    overrides.push_back({"contact.sliding.surface", "facets"});
    overrides.push_back({"contact.sliding.discretisation", "mortar"});
    expect_same("paper/half_tube.yaml", overrides);
}

TEST(LinearSolvers, GiveTheSameHalfTubeByPetrovGalerkin) {
    auto overrides = coarse;
    overrides.push_back({"contact.sliding.discretisation", "petrov_galerkin"});
    expect_same("paper/half_tube.yaml", overrides);
}

TEST(LinearSolvers, GiveTheSameMotion) {
    expect_same("paper/half_tube_dynamic.yaml", {{"bodies.tube.mesh.half_tube.divisions", "[7, 5, 1]"},
                                                 {"bodies.contactor.mesh.contactor.divisions", "[4, 5, 1]"},
                                                 {"stages.slide.duration", "15 s"},
                                                 {"stages.slide.steps", "30"}});
}

TEST(LinearSolvers, GiveTheSameAtFiniteStrain) {
    const support::FloatingPointTraps suspended(false);
    SceneRun direct, multigrid;
    const auto by = [](const char* solver) {
        return std::vector<scene::Override>{{"solver.tolerance", "1e-12"}, {"solver.linear_solver", solver}};
    };
    support::run_scene(direct, support::shipped("extreme/rubber_mu_10.yaml"), by("direct"));
    support::run_scene(multigrid, support::shipped("extreme/rubber_mu_10.yaml"), by("multigrid"));
    ASSERT_EQ(direct.steps.size(), multigrid.steps.size());
    EXPECT_LT(difference(direct, multigrid), same);
}

/// Two bodies that move without strain as one, and a contact between them and a third.
TEST(LinearSolvers, GiveTheSameWithTiedBodies) {
    const auto path = support::scene_file("tied.yaml", R"(
bodies:
  lower: {mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [6, 6, 6]}}, material: {linear_elastic: {E: 100 MPa, nu: 0.3}}}
  middle:
    mesh: {block: {origin: [0.1 m, 0.1 m, 1 m], size: [0.8 m, 0.8 m, 0.4 m], divisions: [5, 5, 3]}}
    material: {linear_elastic: {E: 300 MPa, nu: 0.3}}
  upper:
    mesh: {block: {origin: [0.2 m, 0.2 m, 1.4 m], size: [0.5 m, 0.5 m, 0.4 m], divisions: [4, 4, 3]}}
    material: {linear_elastic: {E: 100 MPa, nu: 0.3}}
sets:
  bed: {body: lower, surface: z_min}
  ground: {body: lower, surface: z_max}
  under: {body: middle, surface: z_min}
  over: {body: middle, surface: z_max}
  sole: {body: upper, surface: z_min}
  top: {body: upper, surface: z_max}
supports: {bed: {fix: [x, y, z]}}
ties: {glue: {slave: under, master: ground}}
contact: {base: {slave: sole, master: {set: over}, friction: 0.3}}
stages: {press: {displacement: {top: {x: 0.2 mm, y: 0 m, z: -1 mm}}}}
)");
    const support::FloatingPointTraps suspended(false);
    SceneRun direct, multigrid;
    const auto by = [](const char* solver) {
        return std::vector<scene::Override>{{"solver.tolerance", "1e-12"}, {"solver.linear_solver", solver}};
    };
    support::run_scene(direct, path, by("direct"));
    support::run_scene(multigrid, path, by("multigrid"));
    EXPECT_TRUE(multigrid.plan.stages.front().tangent.multigrid);
    ASSERT_EQ(direct.steps.size(), multigrid.steps.size());
    EXPECT_LT(difference(direct, multigrid), same);
}

/// A free rigid tool, a cantilever on a moment at one end, whose columns are soft, and a motion after the rest.
TEST(LinearSolvers, GiveTheSameWithRigidBodiesAndCouplings) {
    const auto path = support::scene_file("rigid.yaml", R"(
bodies:
  beam:
    mesh: {block: {size: [2 m, 0.4 m, 0.4 m], divisions: [16, 4, 4]}}
    material: {linear_elastic: {E: 100 MPa, nu: 0.3, density: 1000 kg/m^3}}
  tool:
    rigid_surface: {sphere: {centre: [1.2 m, 0.2 m, 0.8 m], radius: 40 cm}}
    rigid: {fix: [x, y, rx, rz], mass: 100 kg, inertia: [5, 5, 5]}
sets:
  left: {body: beam, surface: x_min}
  right: {body: beam, surface: x_max}
  top: {body: beam, surface: z_max}
supports: {left: {fix: [x, y, z]}}
couplings: {grip: {set: right, reference_point: [2.2 m, 0.2 m, 0.2 m], fix: [y]}}
contact: {tip: {slave: top, master: {rigid_surface: tool}, friction: 0.3}}
stages:
  touch: {motion: {tool: {z: -5 mm, ry: 0 deg}}}
  press: {force: {tool: [0 N, 0 N, -20 kN], grip: [1 kN, 0 N, 5 kN]}, moment: {tool: [0 N m, 100 N m, 0 N m], grip: [0 N m, 2 kN m, 0 N m]}}
  spring_back: {analysis: dynamic, duration: 20 ms, steps: 4, force: {tool: [0 N, 0 N, 0 N]}}
)");
    const support::FloatingPointTraps suspended(false);
    SceneRun direct, multigrid;
    const auto by = [](const char* solver) {
        return std::vector<scene::Override>{{"solver.tolerance", "1e-12"}, {"solver.linear_solver", solver}};
    };
    support::run_scene(direct, path, by("direct"));
    support::run_scene(multigrid, path, by("multigrid"));
    EXPECT_TRUE(multigrid.plan.stages.front().tangent.multigrid);
    ASSERT_EQ(direct.steps.size(), multigrid.steps.size());
    EXPECT_LT(difference(direct, multigrid), same);
}

TEST(LinearSolvers, LeaveRigidSlavesToFactors) {
    const auto bar = [](const std::string& roles, LinearSolver asked) {
        const auto path = support::scene_file("roles.yaml", R"(
bodies:
  ground: {mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [3, 3, 3]}}, material: {linear_elastic: {E: 1 MPa, nu: 0.3}}}
  stone:
    mesh: {block: {origin: [0.2 m, 0.2 m, 1 m], size: [0.5 m, 0.5 m, 0.5 m], divisions: [2, 2, 2]}}
    rigid: {density: 3000 kg/m^3}
sets: {bed: {body: ground, surface: z_min}, top: {body: ground, surface: z_max}, sole: {body: stone, surface: z_min}}
supports: {bed: {fix: [x, y, z]}}
contact: {base: {)" + roles + R"(, friction: 0.3}}
stages: {press: {force: {stone: [0 N, 0 N, -10 N]}}}
)");
        Timings unused;
        const app::LoadedScene loaded = app::load(path, {}, 1, unused);
        return equilibrium::bars_multigrid(loaded.plan.model, asked) != nullptr;
    };
    EXPECT_TRUE(bar("slave: sole, master: {set: top}", LinearSolver::automatic));
    EXPECT_FALSE(bar("slave: sole, master: {set: top}", LinearSolver::multigrid));
    EXPECT_FALSE(bar("slave: top, master: {set: sole}", LinearSolver::automatic));
}

TEST(LinearSolvers, CondenseWhereThatCostsLess) {
    using equilibrium::CondensationCost;
    EXPECT_TRUE((CondensationCost{6, 1, 1e9}.pays()));
    EXPECT_FALSE((CondensationCost{6.1, 1, 1e9}.pays()));
    EXPECT_FALSE((CondensationCost{1, 1, 5e9}.pays()));
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
