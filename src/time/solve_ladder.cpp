#include "osculate/time/solve_ladder.hpp"

#include <algorithm>
#include <set>

namespace osculate::time {

using contact::Status;
using solve::KinsolOutcome;

namespace {

constexpr int most_settlings = 40; ///< KINSOL calls of rung 3

/// Closes every second one of the nodes that `now` has open and `before` had closed; false when there are none.
bool take_back_half(const Statuses& before, Statuses& now) {
    std::vector<std::pair<std::size_t, std::size_t>> released;
    for (std::size_t p = 0; p < now.size(); ++p)
        for (std::size_t j = 0; j < now[p].size(); ++j)
            if (now[p][j] == Status::open && before[p][j] != Status::open) released.emplace_back(p, j);
    if (released.empty()) return false;
    for (std::size_t k = 0; k < released.size(); k += 2) {
        const auto [p, j] = released[k];
        now[p][j] = before[p][j];
    }
    return true;
}

LadderResult settle(Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z, Statuses statuses,
                    const std::vector<Vec3>& unpredicted, const solve::KinsolOptions& kinsol) {
    LadderResult result;
    result.rung = "frozen statuses";
    std::set<Statuses> seen;
    Statuses last = statuses;
    Vector last_z = z;
    for (int settling = 0; settling < most_settlings; ++settling) {
        equilibrium.set_statuses(statuses, StatusRule::frozen, false);
        z = last_z;
        if (settling == 0) equilibrium.linearise_first_about(unpredicted);
        const auto solved = solver.solve(equilibrium, z, kinsol);
        result.iterations += solved.iterations;
        result.outcome = solved.outcome;
        result.residual = solved.residual;
        result.failing_equation = solved.failing_equation;
        if (solved.outcome == KinsolOutcome::singular && take_back_half(last, statuses)) continue;
        if (solved.outcome != KinsolOutcome::converged) return result;
        last = equilibrium.statuses();
        last_z = z;
        Statuses next = equilibrium.natural_statuses();
        if (next == last) return result;
        if (!seen.insert(next).second) break;
        statuses = std::move(next);
    }
    result.outcome = KinsolOutcome::stopped;
    return result;
}

solve::KinsolOptions kinsol_options(Equilibrium& equilibrium, Index size, const LadderOptions& options) {
    solve::KinsolOptions kinsol;
    kinsol.tolerance = options.tolerance;
    kinsol.max_iterations = options.max_iterations;
    kinsol.residual_scale = 1 / options.reference_force;
    kinsol.unknown_scale = Vector::Constant(size, 1 / options.reference_force);
    kinsol.unknown_scale.head(equilibrium.constraints().equations()).setConstant(1 / options.characteristic_length);
    equilibrium.set_reference_force(options.reference_force);
    return kinsol;
}

} // namespace

LadderResult solve_trial(Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z, const Statuses& statuses,
                         const LadderOptions& options) {
    equilibrium.set_statuses(statuses, StatusRule::frozen, false);
    equilibrium.linearise_first_about(options.predicted);
    const auto solved =
        solver.solve(equilibrium, z, kinsol_options(equilibrium, static_cast<Index>(z.size()), options));
    return {solved.outcome, solved.iterations, solved.residual, "trial", solved.failing_equation};
}

LadderResult climb(Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z, const Vector& unpredicted,
                   const Statuses& start, bool force_first, const LadderOptions& options) {
    const solve::KinsolOptions kinsol = kinsol_options(equilibrium, static_cast<Index>(z.size()), options);
    const bool predicted = z != unpredicted;
    LadderResult result;
    const auto newton = [&](const char* rung, const std::vector<Vec3>& from) {
        equilibrium.set_statuses(start, StatusRule::natural, force_first);
        equilibrium.linearise_first_about(from);
        auto solved = solver.solve(equilibrium, z, kinsol);
        // what the linear residual alone says is no equilibrium
        if (solved.iterations == 0 && !from.empty()) solved = solver.solve(equilibrium, z, kinsol);
        result = {solved.outcome, result.iterations + solved.iterations, solved.residual, rung,
                  solved.failing_equation};
        return result.converged();
    };
    if (newton("semismooth Newton", options.predicted)) return result;
    z = unpredicted;
    if (predicted && newton("semismooth Newton without predictor", options.unpredicted)) return result;
    if (start.empty()) return result;
    z = unpredicted;
    LadderResult settled = settle(equilibrium, solver, z, start, options.unpredicted, kinsol);
    settled.iterations += result.iterations;
    return settled;
}

} // namespace osculate::time
