/// With couplings too the tangent of the whole step problem is the derivative of its residual, as a matrix and as
/// products.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <gtest/gtest.h>
#include <random>

namespace osculate {
namespace {

struct Case {
    const char* name;
    const char* analysis = "static";
    const char* fix = "[]";
    const char* follower = "{}";
    const char* material = "neo_hookean";
    const char* coupled = "cap"; ///< cap: above; sole: slave nodes among them; ground: masters among them
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

std::string block_on_ground(const Case& c) {
    return R"(
bodies:
  ground:
    mesh: {block: {origin: [-0.2, -0.2, -0.2], size: [0.9, 0.8, 0.2], divisions: [3, 3, 1]}}
    material: {)" +
           std::string(c.material) + R"(: {E: 1 MPa, nu: 0.3, density: 1000}}
  block:
    mesh: {block: {size: [0.5, 0.4, 0.3], divisions: [3, 2, 2]}, rotate: {axis: [0, 0, 1], angle: 0.2}}
    material: {)" +
           c.material + R"(: {E: 1 MPa, nu: 0.3, density: 1000}}
sets:
  bottom: {body: ground, surface: z_min}
  floor: {body: ground, surface: z_max}
  sole_all: {body: block, surface: z_min}
  cap: {body: block, surface: z_max}
  sole: {body: block, box: {min: [-0.2, -0.2, -0.1], max: [0.2, 0.6, 0.1]}}
  land: {body: ground, box: {min: [-0.3, -0.3, -0.1], max: [0.2, 0.2, 0.1]}}
supports:
  bottom: {fix: [x, y, z]}
couplings:
  head: {set: )" +
           c.coupled + ", reference_point: [0.2, 0.1, 0.5], fix: " + c.fix + R"(}
contact:
  touch: {slave: sole_all, master: {set: floor, surface: facets}, friction: 0.3, discretisation: node}
stages:
  press:
    analysis: )" +
           c.analysis + R"(
    duration: 0.1 s
    steps: 10
    follower_pressure: )" +
           c.follower + "\n";
}

class CouplingTangent : public testing::TestWithParam<Case> {};

TEST_P(CouplingTangent, IsTheDerivativeOfTheResidual) {
    const scene::Scene scene =
        scene::read_scene(support::scene_file("coupling_tangent.yaml", block_on_ground(GetParam())));
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    const model::Model& model = plan.model;
    ASSERT_EQ(model.rigid.size(), 1U);
    const model::RigidBody& head = model.rigid[0];
    const time::Stage& stage = plan.stages[0];
    const linear::Constraints constraints(model.nodes(), stage.constraints, model::dependent_nodes(model));
    equilibrium::Equilibrium equilibrium(model, model.pairs, constraints, stage.dynamics ? &*stage.dynamics : nullptr,
                                         stage.tangent, timings, 1, !stage.follower_pressures.empty());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto shake = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    constexpr double force = 1e3, small = 1e-3;
    model::State state;
    state.u.reset(model.X.size());
    state.rigid.resize(1);
    model::RigidMotion& motion = state.rigid[0];
    motion.orientation = model::turned(motion.orientation, 0.1 * shake());
    for (Vec3& u : state.u) u = small * shake();
    model::spread_displacements(model, head, motion.orientation, state.u);
    if (stage.dynamics) {
        state.v.reset(model.X.size());
        state.a.reset(model.X.size());
        for (std::size_t i = 0; i < state.v.size(); ++i) state.v[i] = shake(), state.a[i] = shake();
    }
    for (const auto& pair : model.pairs) state.contact.push_back(model::opened(pair));
    equilibrium::Statuses statuses(1);
    for (Index j = 0; j < model.pairs[0]->size(); ++j) {
        state.contact[0].lambda[static_cast<std::size_t>(j)] = force * (Vec3(0, 0, 1) + 0.5 * shake());
        statuses[0].push_back(static_cast<contact::Status>(j % 4));
    }
    Field u = state.u;
    for (Vec3& one : u) one += small * shake();
    u[static_cast<std::size_t>(head.rotation())] += 0.1 * head.radius * shake();
    equilibrium::StepLoad load{Field(u.size()), Field(u.size()), {}};
    for (Vec3& f : load.force) f = 0.1 * force * shake();
    for (const auto& pressure : stage.follower_pressures)
        load.pressures.push_back({&pressure.faces, pressure.end / 2, pressure.end});
    equilibrium.begin_attempt(state, load, 0.01);
    equilibrium.set_statuses(statuses, equilibrium::StatusRule::frozen, false);
    const Vector z = equilibrium.unknowns(u, state.contact);
    Vector F(z.size()), plus(z.size()), minus(z.size());
    for (int settle = 0; settle < 3; ++settle)
        ASSERT_NE(equilibrium.residual(z, F), solve::NonlinearProblem::Verdict::shorten);

    const solve::SparseMatrix& J = equilibrium.jacobian();
    Matrix dense = Matrix::Zero(z.size(), z.size());
    for (Index i = 0; i < J.rows(); ++i)
        for (auto k = J.row_start[i]; k < J.row_start[i + 1]; ++k) dense(i, J.column[k]) += J.value[k];
    solve::Tangent* tangent = equilibrium.tangent();
    ASSERT_NE(tangent, nullptr);
    tangent->linearise();
    Vector x(z.size()), y(z.size());
    for (Index i = 0; i < x.size(); ++i) x(i) = uniform(random) * (i < constraints.equations() ? 1 : force);
    tangent->multiply(x, y);
    constexpr double round_off = 1e-12;
    EXPECT_LT((dense * x - y).norm(), round_off * (dense.cwiseAbs() * x.cwiseAbs()).norm());

    constexpr double step = 1e-6, tolerance = 2e-6, kink = 0.05, truncation = 0.01;
    double worst = 0;
    Index kinks = 0;
    for (Index k = 0; k < z.size(); ++k) {
        const double scale = k < constraints.equations() ? 1 : force, h = step * scale;
        Vector moved = z;
        moved(k) += h;
        (void)equilibrium.residual(moved, plus);
        moved(k) = z(k) - h;
        (void)equilibrium.residual(moved, minus);
        const Vector difference = (plus - minus) / (2 * h), bend = (plus - 2 * F + minus) / h;
        const double largest = std::max(dense.col(k).cwiseAbs().maxCoeff(), 1e2 / scale);
        if (bend.cwiseAbs().maxCoeff() > kink * largest) { // a facet is left on the way
            ++kinks;
            continue;
        }
        const Vector error = (difference - dense.col(k)).cwiseAbs() - truncation * bend.cwiseAbs();
        worst = std::max(worst, error.maxCoeff() / largest);
    }
    EXPECT_LT(kinks, z.size() / 8);
    EXPECT_LT(worst, tolerance);
}

const char* const dynamic = "{dynamic: {integrator: {generalised_alpha: {rho_inf: 0.5}}}}";

INSTANTIATE_TEST_SUITE_P(All, CouplingTangent,
                         testing::Values(Case{"statics"}, Case{"dynamics", dynamic}, Case{"held", dynamic, "[x, rz]"},
                                         Case{"follower", dynamic, "[]", "{cap: 500 kPa, floor: 100 kPa}"},
                                         Case{"linear", dynamic, "[]", "{}", "linear_elastic"},
                                         Case{"slaves", dynamic, "[]", "{sole_all: 10 kPa}", "neo_hookean", "sole"},
                                         Case{"masters", dynamic, "[]", "{}", "neo_hookean", "land"}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

} // namespace
} // namespace osculate
