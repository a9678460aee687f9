#include "time/solve_once.hpp"

namespace osculate::time {

using solve::KinsolOutcome;

namespace {

solve::KinsolOptions kinsol_options(equilibrium::Equilibrium& equilibrium, Index size, const LadderOptions& options) {
    solve::KinsolOptions kinsol;
    kinsol.tolerance = options.tolerance;
    kinsol.max_iterations = options.max_iterations;
    kinsol.residual_scale = 1 / options.reference_force;
    kinsol.unknown_scale = Vector::Constant(size, 1 / options.reference_force);
    kinsol.unknown_scale.head(equilibrium.constraints().equations()).setConstant(1 / options.characteristic_length);
    equilibrium.set_reference_force(options.reference_force);
    return kinsol;
}

/// Whether nothing holds a body of this solution, though round-off kept the tangent from being singular.
bool nothing_holds(const equilibrium::Equilibrium& equilibrium, const Vector& z, const LadderOptions& options) {
    constexpr double absurd = 1000; // times where an iterate counts as astray
    if (!options.stabilisation.share || equilibrium.contact().empty()) return false;
    const double moved = largest_component(equilibrium.displacements(z));
    if (moved <= absurd * options.farthest) return false;
    const double driven = largest_component(equilibrium.displacements(Vector::Zero(z.size())));
    return !(moved <= absurd * (options.farthest + driven));
}

} // namespace

solve::KinsolResult solve_once(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                               equilibrium::StatusRule rule, LadderOptions& options) {
    const auto size = static_cast<Index>(z.size());
    const auto call = [&] {
        solve::KinsolResult solved = solver.solve(equilibrium, z, kinsol_options(equilibrium, size, options));
        if (solved.outcome != KinsolOutcome::stopped || !equilibrium.rests()) return solved;
        solved.outcome = KinsolOutcome::converged;
        z = equilibrium.last_iterate(); // KINSOL's is the one before
        solved.residual = equilibrium.records().back().residual;
        return solved;
    };
    solve::KinsolResult solved = call();
    if (solved.outcome == KinsolOutcome::converged && nothing_holds(equilibrium, z, options)) {
        solved.outcome = KinsolOutcome::singular;
        options.ran_away = true;
    }
    if (solved.outcome != KinsolOutcome::stopped) return solved; // it may still gain
    const double moved = largest_component(equilibrium.displacements(z));
    if (!(moved <= options.farthest)) return solved; // it rests nowhere near a solution
    const double floor = options.round_off * moved;
    if (!(floor > options.reference_force && solved.residual * options.reference_force <= options.tolerance * floor))
        return solved;
    options.reference_force = floor;
    equilibrium.set_statuses(equilibrium.statuses(), rule, false);
    const int before = solved.iterations;
    solved = call();
    solved.iterations += before;
    return solved;
}

} // namespace osculate::time
