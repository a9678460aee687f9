#include "time/friction_rung.hpp"

#include "time/solve_once.hpp"

#include <algorithm>
#include <limits>

namespace osculate::time {

using equilibrium::StatusRule;
using solve::KinsolOutcome;

LadderResult settle_friction(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                             const equilibrium::Statuses& statuses, LadderOptions& options) {
    constexpr int most_idle = 6; // rounds in a row that have not halved the residual: those that gain do so sooner
    LadderResult result;
    result.rung = "exact friction";
    result.outcome = KinsolOutcome::stopped;
    Vector F(z.size());
    equilibrium::Statuses last;
    double best = std::numeric_limits<double>::infinity();
    int idle = 0;
    // each has a cycle watch of its own: what went round before does not count
    const auto evaluate = [&](equilibrium::Statuses from) {
        equilibrium.set_statuses(std::move(from), StatusRule::natural, false);
        const auto verdict = equilibrium.residual(z, F);
        if (verdict == equilibrium::Equilibrium::Verdict::shorten || !F.allFinite())
            return false; // otherwise F holds nothing
        result.residual = F.cwiseAbs().maxCoeff() / options.reference_force;
        return true;
    };
    for (int k = 0; k < options.max_iterations; ++k, ++result.iterations) {
        if (!evaluate(last.empty() ? statuses : last)) return result;
        if (result.residual <= options.tolerance) {
            result.outcome = KinsolOutcome::converged;
            return result;
        }
        idle = result.residual < 0.5 * best ? 0 : idle + 1;
        best = std::min(best, result.residual);
        if (idle > most_idle) return result;
        if (k > 0 && equilibrium.statuses() == last) {
            Vector newton = z;
            const auto solved = solve_once(equilibrium, solver, newton, StatusRule::natural, options);
            result.iterations += solved.iterations;
            if (solved.outcome == KinsolOutcome::converged) {
                result.outcome = solved.outcome;
                result.residual = solved.residual;
                z = std::move(newton);
                return result;
            }
            if (!evaluate(last)) return result;
        }
        last = equilibrium.statuses();
        if (!equilibrium.advance_friction(z)) return result;
        // where the bodies buckle without contact, the step says little
        if (!(largest_component(equilibrium.displacements(z)) <= options.farthest)) return result;
    }
    result.outcome = KinsolOutcome::max_iterations;
    return result;
}

} // namespace osculate::time
