#include "time/geometry_rung.hpp"

#include "time/friction_rung.hpp"
#include "time/solve_once.hpp"

namespace osculate::time {

using equilibrium::StatusRule;
using solve::KinsolOutcome;

LadderResult settle_geometry(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                             const equilibrium::Statuses& statuses, LadderOptions& options) {
    constexpr int most_rounds = 5;
    constexpr double near_enough = 0.01; // ContactTerm::geometry_error(): a tenth of what the audit allows
    LadderResult result;
    result.rung = "held geometry";
    result.outcome = KinsolOutcome::stopped;
    if (!equilibrium.can_hold_contact()) return result;
    equilibrium::Statuses last = statuses;
    Vector F(z.size());
    for (int round = 0;; ++round) {
        equilibrium.let_go_of_contact();
        equilibrium.set_statuses(last, StatusRule::natural, false);
        if (equilibrium.residual(z, F) == equilibrium::Equilibrium::Verdict::shorten || !F.allFinite()) return result;
        result.residual = F.cwiseAbs().maxCoeff() / options.reference_force;
        if (result.residual <= options.tolerance) {
            result.outcome = KinsolOutcome::converged;
            return result;
        }
        equilibrium.hold_contact();
        const LadderResult held = settle_friction(equilibrium, solver, z, last, options);
        result.iterations += held.iterations;
        if (!held.converged()) break;
        result.residual = held.residual;
        last = equilibrium.statuses();
        if (round + 1 < most_rounds) continue;
        if (!(equilibrium.contact_geometry_error() <= near_enough)) break;
        result.held_geometry = true;
        result.outcome = KinsolOutcome::converged;
        return result;
    }
    equilibrium.let_go_of_contact();
    return result;
}

} // namespace osculate::time
