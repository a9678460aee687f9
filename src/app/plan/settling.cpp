#include "app/plan/settling.hpp"

#include "app/overloaded.hpp"

namespace osculate::app {

namespace {
/// Whether an integrator damps no vibration.
bool keeps_energy(const scene::DynamicAnalysis& analysis) {
    return std::visit(Overloaded{
                          [](const scene::GeneralisedAlpha& s) { return s.rho_inf == 1; },
                          [](const scene::Newmark& s) { return s.gamma == 0.5; },
                          [](const scene::Hht& s) { return s.alpha == 0; },
                          [](const scene::BackwardEuler&) { return false; },
                      },
                      analysis.integrator);
}
} // namespace

double automatic_stiffness_damping(double whole_step) {
    constexpr double share = 0.1;
    return share * whole_step;
}

double recovery_time(double whole_step) {
    constexpr double steps = 30;
    return steps * whole_step;
}

bool settle_dynamics(scene::Scene& scene) {
    bool by_rule = false;
    for (auto& [name, stage] : scene.stages) {
        auto* analysis = std::get_if<scene::DynamicAnalysis>(&stage.analysis);
        if (analysis == nullptr) continue;
        if (analysis->impacts == scene::Impacts::automatic) {
            const bool settles = scene.general && !keeps_energy(*analysis) && !stage.control.error_tolerance;
            analysis->impacts = settles ? scene::Impacts::inelastic : scene::Impacts::resolved;
            by_rule = by_rule || settles;
        }
        if (!analysis->stiffness_damping)
            analysis->stiffness_damping = analysis->impacts == scene::Impacts::inelastic
                                              ? automatic_stiffness_damping(stage.duration / stage.steps)
                                              : 0;
    }
    return by_rule;
}

} // namespace osculate::app
