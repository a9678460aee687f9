#pragma once
/// The deterministic ladder of nonlinear solves for one attempt: each rung is tried only when the one before it failed.

#include "osculate/equilibrium/equilibrium.hpp"

#include <functional>

namespace osculate::time {

/// The last rung, in statics: bodies lean on springs (see Stabilisation) that are moved after them and made softer until
/// equilibrium holds without them.
struct StabilisationOptions {
    std::function<const std::vector<double>&()>
        share;                   ///< model::volume_shares, when needed; none: the rung is left out
    double finest = 0;           ///< m, motions below it end on this side of whatever they meet
    std::function<double()> gap; ///< m, smallest at the start, when needed
    double farthest = 0;         ///< m, travel after which a body counts as held by nothing
};

struct LadderOptions {
    double tolerance = 1e-9;
    int max_iterations = 30;
    double characteristic_length = 1; ///< m
    double reference_force = 1;       ///< N
    /// Reference force that round-off of the internal forces calls for, over the largest displacement, N/m: a solve that comes
    /// to rest there is held against no smaller one.
    double round_off = 0;
    double farthest = 0; ///< m, displacements beyond which an iterate is not taken seriously there
    /// (nodes) displacements behind the start values, driven nodes where they were: what first residuals are linear about
    /// with nonlinear elements (Equilibrium::linearise_first_about); empty: exact from the start.
    Field predicted{}, unpredicted{};
    bool last_chance = false; ///< the step cannot be cut: rung 3 may take long, and any failure leads to rung 4
    StabilisationOptions stabilisation{};
};

struct LadderResult {
    solve::KinsolOutcome outcome = solve::KinsolOutcome::converged;
    int iterations = 0;         ///< Newton iterations of all rungs
    double residual = 0;        ///< largest residual component over the reference force
    double reference_force = 0; ///< N, the one it was held against
    const char* rung = "";      ///< the rung that ended the attempt
    solve::SparseIndex failing_equation = -1;
    bool astray = false;                 ///< its last iterate lies farther off than LadderOptions::farthest
    int stabilised_solves = 0;           ///< with springs in place
    Index adrift = -1;                   ///< node that travelled farthest, of a body that found no support
    double travelled = 0;                ///< how far it did, m
    model::WorstElement worst_element{}; ///< at the last residual of that rung

    [[nodiscard]] bool converged() const { return outcome == solve::KinsolOutcome::converged; }
};

/// Solves with the statuses given, whatever the complementarity functions say: the trial of a step.
/// @param z  start values, last iterate afterwards
[[nodiscard]] LadderResult solve_trial(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                                       const std::vector<std::vector<contact::Status>>& statuses,
                                       const LadderOptions& options);

/// 1 semismooth Newton: statuses follow the iterate
/// 2 the same from the last state instead of the predicted one: a prediction that overruns the elastic slip of a node
///   that sticks can send Newton round in the slip branch
/// 3 statuses frozen per KINSOL call and settled between calls; a release that leaves the tangent singular is taken back
///   by halves, so that no body loses its support
/// 4 stabilised: where a tangent is singular, or as a last resort. Solved again and again with springs that hold bodies to
///   where the last solve left them, softer each time it goes well; accepted where the residual without springs is within
///   tolerance, so that motions which nothing determines stay as they are
/// A smaller step and a named failure are the stepper's.
/// @param z            predicted start values, last iterate afterwards
/// @param unpredicted  start values without prediction
/// @param start        statuses to start from
/// @param force_first  they hold for the first iterate of rung 1, whatever the complementarity functions say
[[nodiscard]] LadderResult climb(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                                 const Vector& unpredicted, const equilibrium::Statuses& start, bool force_first,
                                 const LadderOptions& options);

} // namespace osculate::time
