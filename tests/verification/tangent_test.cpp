/// The consistent tangent of the whole step problem is the derivative of its residual, for every element, master surface
/// and contact status.

#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using contact::Status;

struct Case {
    const char* name;
    const char* element;
    const char* formulation;
    const char* surface;
    const char* support; ///< of the driven face
    const char* material = "linear_elastic";
    bool dynamic = false;
    const char* follower = "{}";
    const char* discretisation = "node";
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

const char* const damped = "{dynamic: {integrator: {generalised_alpha: {rho_inf: 0.5}}, stiffness_damping: 1 ms}}";

class Tangent : public testing::TestWithParam<Case> {};

/// Largest difference between a column of J and the central difference of F, over the largest entry of the column.
/// Truncation h^2 and round-off eps/h balance near h = 1e-5 of the scale, at 1e-9 to 1e-8 for residuals of order one.
constexpr double difference_step = 1e-5;
constexpr double tolerance = 1e-6;

TEST_P(Tangent, IsTheDerivativeOfTheResidual) {
    const Case& c = GetParam();
    const std::vector<scene::Override> overrides{
        {"bodies.tube.mesh.half_tube.divisions", "[7, 5, 1]"},
        {"bodies.contactor.mesh.contactor.divisions", "[4, 5, 1]"},
        {"bodies.tube.mesh.half_tube.element", c.element},
        {"bodies.contactor.mesh.contactor.element", c.element},
        {"bodies.tube.hex_formulation", c.formulation},
        {"bodies.contactor.hex_formulation", c.formulation},
        {"contact.sliding.surface", c.surface},
        {"contact.sliding.friction", "0.3"},
        {"contact.sliding.discretisation", c.discretisation},
        {"supports.rear", c.support},
        {"bodies.tube.material", "{" + std::string(c.material) + ": {E: 30 MPa, nu: 0.2, density: 2000 kg/m^3}}"},
        {"bodies.contactor.material", "{" + std::string(c.material) + ": {E: 10 MPa, nu: 0.2, density: 2000 kg/m^3}}"},
        {"stages.slide.follower_pressure", c.follower},
        {"stages.slide.analysis", c.dynamic ? damped : "static"},
    };
    const scene::Scene scene = scene::read_scene(support::shipped("paper/half_tube.yaml"), overrides);
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    const linear::Constraints constraints(plan.model.nodes(), plan.stages[1].constraints);
    const auto& dynamics = plan.stages[1].dynamics;
    equilibrium::Equilibrium equilibrium(plan.model, plan.model.pairs, constraints, dynamics ? &*dynamics : nullptr,
                                         plan.stages[1].tangent, timings, 1,
                                         !plan.stages[1].follower_pressures.empty());

    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto shake = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };

    // a start state, and a trial state that has slid and been shaken out of every symmetry
    model::State state;
    state.u.assign(plan.model.X.size(), Vec3::Zero());
    for (const auto& pair : plan.model.pairs) state.contact.push_back(model::opened(pair));
    const model::Body& contactor = plan.model.bodies[1];
    std::vector<Vec3> u(plan.model.X.size());
    for (std::size_t i = 0; i < u.size(); ++i) {
        const bool slides = static_cast<Index>(i) >= contactor.first_node;
        u[i] = 0.02 * shake() + (slides ? Vec3(0.03, 0.13, -0.01) : Vec3::Zero());
    }
    const double force = 1e5;
    equilibrium::Statuses statuses(1);
    for (Index j = 0; j < plan.model.pairs[0]->size(); ++j) {
        state.contact[0].lambda[j] = force * (Vec3(0, 0, 1) + 0.5 * shake());
        statuses[0].push_back(static_cast<Status>(j % 4));
    }
    equilibrium::StepLoad load{
        std::vector<Vec3>(u.size(), Vec3::Zero()), std::vector<Vec3>(u.size(), Vec3::Zero()), {}};
    if (c.dynamic) {
        for (std::size_t i = 0; i < u.size(); ++i) {
            state.v.values().push_back(shake());
            state.a.values().push_back(shake());
        }
    }
    constexpr double dt = 0.01; // s: inertia and stiffness weigh about the same
    for (const auto& pressure : plan.stages[1].follower_pressures)
        load.pressures.push_back({&pressure.faces, pressure.end / 2, pressure.end});
    equilibrium.begin_attempt(state, load, dt);
    equilibrium.set_statuses(statuses, equilibrium::StatusRule::frozen, false);
    Vector z = equilibrium.unknowns(u, state.contact);

    Vector F(z.size()), plus(z.size()), minus(z.size());
    for (int settle = 0; settle < 3; ++settle) (void)equilibrium.residual(z, F); // facets tracked
    const solve::SparseMatrix& J = equilibrium.jacobian();
    Matrix dense = Matrix::Zero(z.size(), z.size());
    for (Index i = 0; i < J.rows(); ++i)
        for (auto k = J.row_start[i]; k < J.row_start[i + 1]; ++k) dense(i, J.column[k]) += J.value[k];

    // what the tangent does without its matrix is what the matrix does: products, and solutions as far as asked
    solve::Tangent* tangent = equilibrium.tangent();
    ASSERT_NE(tangent, nullptr);
    tangent->linearise();
    Vector b(z.size()), x(z.size()), y(z.size());
    for (Index i = 0; i < b.size(); ++i) {
        b(i) = force * uniform(random);
        x(i) = uniform(random) * (i < constraints.equations() ? 1 : force);
    }
    tangent->multiply(x, y);
    constexpr double round_off = 1e-13;
    EXPECT_LT((dense * x - y).norm(), round_off * (dense.cwiseAbs() * x.cwiseAbs()).norm());
    EXPECT_EQ(tangent->solves(), !plan.model.nonlinear && plan.stages[1].follower_pressures.empty());
    if (tangent->solves()) {
        const double allowed = 1e-6 * b.norm();
        ASSERT_TRUE(tangent->solve(b, x, allowed));
        constexpr double condensed = 1e-9; // round-off of inverses, far below what is asked for
        EXPECT_LT((dense * x - b).norm(), allowed + condensed * b.norm());
    }

    double worst = 0;
    int closed = 0;
    for (Index j = 0; j < plan.model.pairs[0]->size(); ++j) closed += contact::is_closed(equilibrium.statuses()[0][j]);
    ASSERT_GT(closed, plan.model.pairs[0]->size() / 2) << "the trial state must touch";
    for (Index k = 0; k < z.size(); ++k) {
        const double scale = k < constraints.equations() ? 1 : force, h = difference_step * scale;
        Vector moved = z;
        moved(k) += h;
        (void)equilibrium.residual(moved, plus);
        moved(k) = z(k) - h;
        (void)equilibrium.residual(moved, minus);
        const Vector difference = (plus - minus) / (2 * h);
        const double largest = std::max(dense.col(k).cwiseAbs().maxCoeff(), 1e-3 * 1e6 / scale);
        worst = std::max(worst, (difference - dense.col(k)).cwiseAbs().maxCoeff() / largest);
    }
    EXPECT_LT(worst, tolerance);
}

INSTANTIATE_TEST_SUITE_P(
    All, Tangent,
    testing::Values(
        Case{"hex8_facets", "hex8", "full", "facets", "{fix: [x]}"},
        Case{"hex8_b_bar_rpim", "hex8", "b_bar", "{rpim: {ring: 2}}", "{fix: [x]}"},
        Case{"hex8_incompatible_rpim_tangential", "hex8", "incompatible_modes",
             "{rpim: {ring: 1, coordinates: tangential}}", "{fix: [x]}"},
        Case{"wedge6_facets", "wedge6", "full", "facets", "{fix: [x]}"},
        Case{"wedge6_rpim", "wedge6", "full", "{rpim: {ring: 1}}", "{fix: [x]}"},
        Case{"tet4_facets", "tet4", "full", "facets", "{fix: [x]}"},
        Case{"tet4_rpim", "tet4", "full", "{rpim: {ring: 2, m: 3}}", "{fix: [x]}"},
        Case{"hex8_blend", "hex8", "full", "blend", "{fix: [x]}"},
        Case{"tet4_blend_1_ring", "tet4", "full", "{blend: {ring: 1}}", "{fix: [x]}"},
        Case{"turned_support", "hex8", "full", "{rpim: {ring: 1}}", "{axes: [[0.6, 0.8, 0], [-0.8, 0.6, 0]]}"},
        Case{"symmetry", "hex8", "full", "{rpim: {ring: 1}}", "{symmetry: [0.6, 0, 0.8]}"},
        Case{"neo_hookean", "hex8", "full", "blend", "{fix: [x]}", "neo_hookean"},
        Case{"neo_hookean_f_bar", "hex8", "b_bar", "facets", "{fix: [x]}", "neo_hookean"},
        Case{"kirchhoff_tet4", "tet4", "full", "facets", "{fix: [x]}", "saint_venant_kirchhoff"},
        Case{"dynamic", "hex8", "full", "blend", "{fix: [x]}", "linear_elastic", true},
        Case{"follower_pressure", "hex8", "full", "facets", "{fix: [x]}", "linear_elastic", false, "{top: 3 MPa}"},
        Case{"dynamic_follower_pressure", "wedge6", "full", "facets", "{fix: [x]}", "neo_hookean", true,
             "{top: 3 MPa}"},
        Case{"mortar_facets", "hex8", "full", "facets", "{fix: [x]}", "linear_elastic", false, "{}", "mortar"},
        Case{"mortar_rpim_tet4", "tet4", "full", "{rpim: {ring: 1}}", "{fix: [x]}", "linear_elastic", false, "{}",
             "mortar"},
        Case{"mortar_blend", "hex8", "full", "blend", "{symmetry: [0.6, 0, 0.8]}", "linear_elastic", false, "{}",
             "mortar"},
        Case{"petrov_galerkin_facets", "hex8", "full", "facets", "{fix: [x]}", "linear_elastic", false, "{}",
             "petrov_galerkin"},
        Case{"petrov_galerkin_rpim_tet4", "tet4", "full", "{rpim: {ring: 1}}", "{fix: [x]}", "linear_elastic", false,
             "{}", "petrov_galerkin"},
        Case{"petrov_galerkin_blend", "hex8", "full", "blend", "{symmetry: [0.6, 0, 0.8]}", "linear_elastic", false,
             "{}", "petrov_galerkin"},
        Case{"dynamic_neo_hookean", "hex8", "full", "blend", "{fix: [x]}", "neo_hookean", true}),
    [](const auto& tested) { return tested.param.name; });

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
