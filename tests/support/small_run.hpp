#pragma once
/// Stages of a model put together by hand, and what a run of them leaves behind.

#include "osculate/time/stepper.hpp"
#include "support/small_model.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace osculate::support {

/// A static stage of a finished model, with its constraints as they are now and no loads.
[[nodiscard]] inline time::Stage small_stage(const SmallModel& small, const std::string& name, int steps,
                                             LinearSolver solver = LinearSolver::automatic) {
    time::Stage stage;
    stage.name = name;
    stage.steps = steps;
    stage.constraints = small.constraints;
    stage.limits.dt_max = stage.duration / steps;
    stage.limits.dt_min = 1e-6 * stage.limits.dt_max;
    stage.tangent = equilibrium::choose_tangent(small.model, small.model.pairs, solver, false, false);
    return stage;
}

/// A dynamic one of fixed steps. @pre the model was finished with masses
[[nodiscard]] inline time::Stage small_motion(const SmallModel& small, const std::string& name, double duration,
                                              int steps, double rho_inf) {
    time::Stage stage = small_stage(small, name, steps);
    stage.duration = duration;
    stage.dynamics = equilibrium::Dynamics{equilibrium::generalised_alpha(rho_inf)};
    stage.limits.dt_max = duration / steps;
    stage.limits.dt_min = 1e-6 * stage.limits.dt_max;
    stage.tangent = equilibrium::choose_tangent(small.model, small.model.pairs, LinearSolver::automatic, true, false);
    return stage;
}

/// The state after every accepted step, and forces on supports.
class Record final : public time::StepObserver {
public:
    struct Step {
        model::State state;
        Field unbalanced; ///< what supports carry, N
        int iterations = 0;
        time::Ledger ledger{}; ///< of dynamic steps
    };
    void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
    void accepted(const time::AcceptedStep& step) override {
        steps.push_back({step.state, step.equilibrium.unbalanced(), step.iterations});
        if (step.ledger != nullptr) steps.back().ledger = *step.ledger;
    }
    void between_steps(const std::function<time::Checkpoint()>& checkpoint) override {
        if (steps.size() == keep_after) kept = checkpoint();
    }

    std::vector<Step> steps;
    std::size_t keep_after = 0; ///< steps; a checkpoint is kept
    std::optional<time::Checkpoint> kept;
};

} // namespace osculate::support
