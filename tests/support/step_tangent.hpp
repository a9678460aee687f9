#pragma once
/// Whether the tangent of a whole step problem is the derivative of its residual, at a shaken state of a scene.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <gtest/gtest.h>
#include <random>

namespace osculate::support {

/// Of the first stage of a scene with one contact pair whose nodes are at most some mm from the master.
/// @param turn  how far rigid bodies and couplings are turned before the step, rad
inline void expect_exact_tangent(const std::string& text, double turn = 0.1, double small = 1e-3) {
    const scene::Scene scene = scene::read_scene(scene_file("tangent.yaml", text));
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    const model::Model& model = plan.model;
    const time::Stage& stage = plan.stages[0];
    const linear::Constraints constraints(model.nodes(), stage.constraints, model::dependent_nodes(model),
                                          model::led_directions(model));
    equilibrium::Equilibrium equilibrium(model, model.pairs, constraints, stage.dynamics ? &*stage.dynamics : nullptr,
                                         stage.tangent, timings, 1, !stage.follower_pressures.empty());
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto shake = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    constexpr double force = 1e3;
    model::State state;
    state.u.reset(model.X.size());
    state.rigid.resize(model.rigid.size());
    for (Vec3& u : state.u) u = small * shake();
    for (std::size_t k = 0; k < model.rigid.size(); ++k) {
        state.rigid[k].orientation = model::turned(state.rigid[k].orientation, turn * shake());
        model::spread_displacements(model, model.rigid[k], state.rigid[k].orientation, state.u);
    }
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
    for (const model::RigidBody& body : model.rigid)
        u[static_cast<std::size_t>(body.rotation())] += turn * body.radius * shake();
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

} // namespace osculate::support
