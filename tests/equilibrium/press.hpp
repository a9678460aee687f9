#pragma once
/// A small pair of bodies for tests of what happens within a step.

#include "osculate/app/compile.hpp"
#include "osculate/scene/reader.hpp"
#include "osculate/time/solve_ladder.hpp"
#include "support/source_tree.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <memory>

namespace osculate::equilibrium::fixtures {

/// A block pressed on another, and what is done with it over two steps.
class Press {
public:
    /// @param ranks  processes that share the bodies, each with a Press; null: one
    explicit Press(LinearSolver solver, const std::shared_ptr<Ranks>& ranks = nullptr) {
        const scene::Scene scene = scene::read_scene(support::source_tree() + "/tests/scenes/press.yaml", {});
        plan = app::compile(scene, app::build_meshes(scene), 1, timings, ranks);
        const time::Stage& pull = plan.stages[1];
        constraints = std::make_unique<linear::Constraints>(plan.model.nodes(), pull.constraints);
        equilibrium = std::make_unique<Equilibrium>(plan.model, plan.model.pairs, *constraints, nullptr,
                                                    choose_tangent(plan.model, plan.model.pairs, solver, false, false),
                                                    timings, 1);
        kinsol = std::make_unique<solve::KinsolSolver>(equilibrium->size(), timings);
        state.u.assign(plan.model.X.size(), Vec3::Zero());
        state.contact.push_back(model::opened(plan.model.pairs[0]));
        force = pull.force(plan.model.X.size(), 1);
    }
    /// All slave nodes of one status, but for the first few, which are open.
    [[nodiscard]] Statuses all(contact::Status status, std::size_t opened = 0) const {
        Statuses statuses{std::vector<contact::Status>(state.contact[0].status.size(), status)};
        std::fill_n(statuses[0].begin(), opened, contact::Status::open);
        return statuses;
    }
    /// Opens an attempt in which the rear face has moved by `rear`, m; returns the unknowns at its start.
    Vector begin(double rear) {
        StepLoad load{force, std::vector<Vec3>(state.u.size(), Vec3::Zero()), {}};
        for (Index i = plan.model.bodies[1].first_node; i < plan.model.nodes(); ++i)
            for (int k = 0; k < 3; ++k)
                if (constraints->constraint(i, k) != nullptr) load.prescribed[i](k) = rear;
        equilibrium->begin_attempt(state, load, 1);
        return equilibrium->unknowns(state.u, state.contact);
    }
    /// Such an attempt, solved with one set of statuses after another.
    Vector attempt(double rear, const std::vector<Statuses>& one_after_another) {
        Vector z = begin(rear);
        for (const Statuses& statuses : one_after_another) {
            const time::LadderOptions options{.tolerance = 1e-9, .reference_force = 1e5};
            converged = time::solve_trial(*equilibrium, *kinsol, z, statuses, options).converged();
        }
        return z;
    }
    void accept(const Vector& z) {
        EXPECT_TRUE(converged);
        state = equilibrium->state(z);
        equilibrium->commit();
    }

    Timings timings;
    app::Plan plan;
    std::unique_ptr<linear::Constraints> constraints;
    std::unique_ptr<Equilibrium> equilibrium;
    std::unique_ptr<solve::KinsolSolver> kinsol;
    model::State state;
    std::vector<Vec3> force;
    bool converged = false; ///< the last solve: a rejected attempt may fail as well
};

} // namespace osculate::equilibrium::fixtures
