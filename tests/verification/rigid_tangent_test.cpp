/// With rigid bodies too the tangent of the whole step problem is the derivative of its residual, as a matrix and as
/// products.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using contact::Status;

struct Case {
    const char* name;
    bool ball_is_slave = false, dynamic = false;
    const char* surface = "facets";
    const char* discretisation = "node";
    const char* fix = "[]";
    /// Forces on single nodes of a master, averaged over slave facets that reach beyond it, have a derivative that leaves
    /// the motion of the border out: the sum of the forces is exact, their moment is not.
    bool smooth = true;
    const char* follower = "{}";
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

std::string ball_on_slab(const Case& c) {
    const std::string slave = c.ball_is_slave ? "sphere" : "top", master = c.ball_is_slave ? "top" : "sphere";
    return R"(
bodies:
  slab:
    mesh: {block: {origin: [-0.2 m, -0.2 m, -0.2 m], size: [0.4 m, 0.4 m, 0.2 m], divisions: [6, 6, 1]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3, density: 1000}}
  ball:
    mesh: {ball: {radius: 0.25 m, divisions: [6, 1, 4]}, translate: [0.01, 0.02, 0.26]}
    rigid: {density: 2000, reference_point: [0.1, 0.05, 0.4], fix: )" +
           std::string(c.fix) + R"(}
sets:
  bottom: {body: slab, surface: z_min}
  top: {body: slab, surface: z_max}
  sphere: {body: ball, normal: {direction: [0, 0, -1], angle: 30 deg}}
supports:
  bottom: {fix: [x, y, z]}
contact:
  touch: {slave: )" +
           slave + ", master: {set: " + master + ", surface: " + c.surface +
           "}, friction: 0.3, initial_overlap_limit: 1, discretisation: " + c.discretisation + R"(}
stages:
  press:
    analysis: )" +
           (c.dynamic ? "{dynamic: {integrator: {generalised_alpha: {rho_inf: 0.5}}}}" : "static") + R"(
    duration: 0.1 s
    steps: 10
    follower_pressure: )" +
           c.follower + "\n";
}

class RigidTangent : public testing::TestWithParam<Case> {};

/// As in tangent_test.
constexpr double difference_step = 1e-5;
constexpr double tolerance = 1e-6, kink = 0.1, truncation = 0.01;

TEST_P(RigidTangent, IsTheDerivativeOfTheResidual) {
    const Case& c = GetParam();
    const scene::Scene scene = scene::read_scene(support::scene_file("rigid_tangent.yaml", ball_on_slab(c)));
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    const model::Model& model = plan.model;
    ASSERT_EQ(model.rigid.size(), 1U);
    const model::RigidBody& ball = model.rigid[0];
    const linear::Constraints constraints(model.nodes(), plan.stages[0].constraints, model::dependent_nodes(model),
                                          model::led_directions(model));
    const auto& dynamics = plan.stages[0].dynamics;
    equilibrium::Equilibrium equilibrium(model, model.pairs, constraints, dynamics ? &*dynamics : nullptr,
                                         plan.stages[0].tangent, timings, 1,
                                         !plan.stages[0].follower_pressures.empty());

    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto shake = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    const double force = 1e4;
    model::State state;
    state.u.reset(model.X.size());
    state.rigid.resize(1);
    model::RigidMotion& motion = state.rigid[0];
    motion.orientation = model::turned(motion.orientation, 0.3 * shake());
    model::spread_displacements(model, ball, motion.orientation, state.u);
    if (c.dynamic) {
        motion.velocity = shake(), motion.acceleration = 10 * shake();
        motion.angular_velocity = 5 * shake(), motion.angular_rate = 20 * shake();
        motion.moment = 30 * shake();
        state.v.reset(model.X.size());
        state.a.reset(model.X.size());
        for (std::size_t i = 0; i < state.v.size(); ++i) state.v[i] = shake(), state.a[i] = shake();
    }
    for (const auto& pair : model.pairs) state.contact.push_back(model::opened(pair));
    Field u = state.u;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += 0.01 * shake();
    u[static_cast<std::size_t>(ball.reference)] += Vec3(0.01, 0.02, -0.04);
    u[static_cast<std::size_t>(ball.rotation())] += 0.2 * ball.radius * shake();
    equilibrium::Statuses statuses(1);
    for (Index j = 0; j < model.pairs[0]->size(); ++j) {
        state.contact[0].lambda[static_cast<std::size_t>(j)] = force * (Vec3(0, 0, 1) + 0.5 * shake());
        statuses[0].push_back(static_cast<Status>(j % 4));
    }
    equilibrium::StepLoad load{Field(u.size()), Field(u.size()), {}};
    for (Vec3& f : load.force) f = 0.1 * force * shake();
    for (const auto& pressure : plan.stages[0].follower_pressures)
        load.pressures.push_back({&pressure.faces, pressure.end / 2, pressure.end});
    equilibrium.begin_attempt(state, load, 0.01);
    equilibrium.set_statuses(statuses, equilibrium::StatusRule::frozen, false);
    const Vector z = equilibrium.unknowns(u, state.contact);
    Vector F(z.size()), plus(z.size()), minus(z.size());
    for (int settle = 0; settle < 3; ++settle) (void)equilibrium.residual(z, F);
    int closed = 0;
    for (Index j = 0; j < model.pairs[0]->size(); ++j)
        closed += contact::is_closed(equilibrium.statuses()[0][static_cast<std::size_t>(j)]) &&
                  equilibrium.contact()[0].point(j).found;
    ASSERT_GT(closed, 3) << "the trial state must touch";

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

    if (!c.smooth) return;
    double worst = 0;
    Index kinks = 0;
    for (Index k = 0; k < z.size(); ++k) {
        const double scale = k < constraints.equations() ? 1 : force, h = difference_step * scale;
        Vector moved = z;
        moved(k) += h;
        (void)equilibrium.residual(moved, plus);
        moved(k) = z(k) - h;
        (void)equilibrium.residual(moved, minus);
        const Vector difference = (plus - minus) / (2 * h), bend = (plus - 2 * F + minus) / h;
        const double largest = std::max(dense.col(k).cwiseAbs().maxCoeff(), 1e-3 * 1e5 / scale);
        // a facet is left on the way; and where the residual bends strongly, truncation is a small part of the bend
        if (bend.cwiseAbs().maxCoeff() > kink * largest) {
            ++kinks;
            continue;
        }
        const Vector error = (difference - dense.col(k)).cwiseAbs() - truncation * bend.cwiseAbs();
        worst = std::max(worst, error.maxCoeff() / largest);
    }
    EXPECT_LT(kinks, z.size() / 4);
    EXPECT_LT(worst, tolerance);
}

INSTANTIATE_TEST_SUITE_P(
    All, RigidTangent,
    testing::Values(Case{"statics"}, Case{"dynamics", false, true}, Case{"blend", false, true, "blend"},
                    Case{"petrov_galerkin", false, false, "blend", "petrov_galerkin", "[]", false},
                    Case{"mortar", false, true, "facets", "mortar", "[]", false}, Case{"rigid_slave", true},
                    Case{"rigid_slave_in_dynamics", true, true, "blend"},
                    Case{"rigid_slave_petrov_galerkin", true, false, "facets", "petrov_galerkin"},
                    Case{"rigid_slave_mortar", true, true, "facets", "mortar"},
                    Case{"follower", false, true, "facets", "node", "[]", true, "{sphere: 500 kPa, top: 100 kPa}"},
                    Case{"follower_in_statics", false, false, "facets", "node", "[y]", true, "{sphere: 500 kPa}"},
                    Case{"held", false, true, "facets", "node", "[x, rz]"}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
