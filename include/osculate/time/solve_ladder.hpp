#pragma once
/// The deterministic ladder of nonlinear solves for one attempt: each rung is tried only if the previous one failed.

#include "osculate/equilibrium/equilibrium.hpp"

#include <functional>

namespace osculate::time {

/// The last rung, in statics: springs (see Stabilisation) support the bodies; they follow the bodies and become softer
/// until equilibrium holds without them.
struct StabilisationOptions {
    std::function<const std::vector<double>&()>
        share;                            ///< model::volume_shares, called when needed; empty: no such rung
    std::shared_ptr<const Field> start{}; ///< (nodes) displacements at which gap looks, m
    double finest = 0;                    ///< m, motions below it cannot pass through another body
    std::function<double()> gap;          ///< m, smallest gap at the start, called when needed
    double farthest = 0;                  ///< m, travel beyond which a body counts as unsupported
};

struct LadderOptions {
    double tolerance = 1e-9;
    int max_iterations = 30;
    double characteristic_length = 1; ///< m
    double reference_force = 1;       ///< N
    /// Reference force due to round-off of the internal forces, divided by the largest displacement, N/m: a lower limit
    /// for the reference force of a solve that stagnates there.
    double round_off = 0;
    double farthest = 0;   ///< m, an iterate with larger displacements counts as astray
    bool ran_away = false; ///< set where a solution is so far away that the tangent was singular but for round-off
    /// (nodes) displacements of the start values, driven nodes at their old places: with nonlinear elements the first
    /// residuals are linear about them (Equilibrium::linearise_first_about); empty: exact from the start.
    Field predicted{}, unpredicted{};
    /// Bodies settle: a trial is short, and Newton's method gives way early to exact friction, which starts afresh.
    bool settles = false;
    bool last_chance = false; ///< the step cannot be cut: rung 3 may take long, and any failure leads to rung 4
    StabilisationOptions stabilisation{};
    /// Whether displacements u, at which contact was last evaluated, may be those of a solution: where bodies have sprung through
    /// one another the next rung is tried. If none does better the first such solution is the result. Empty: all may.
    std::function<bool(const Field& u)> admissible{};
};

struct LadderResult {
    solve::KinsolOutcome outcome = solve::KinsolOutcome::converged;
    int iterations = 0;         ///< Newton iterations of all rungs
    double residual = 0;        ///< largest residual component, divided by the reference force
    double reference_force = 0; ///< N, the one used
    const char* rung = "";      ///< the rung that ended the attempt
    solve::SparseIndex failing_equation = -1;
    bool astray = false;                 ///< its last iterate is beyond LadderOptions::farthest
    bool held_geometry = false;          ///< solved with the geometry of contact held, see settle_geometry()
    int stabilised_solves = 0;           ///< number of solves with springs
    Index adrift = -1;                   ///< node with the largest travel, in a body without support
    double travelled = 0;                ///< that travel, m
    model::WorstElement worst_element{}; ///< at the last residual of that rung

    [[nodiscard]] bool converged() const { return outcome == solve::KinsolOutcome::converged; }
};

/// Solves with the given statuses, even if the complementarity functions differ: the trial of a step.
/// @param z  start values; last iterate afterwards
[[nodiscard]] LadderResult solve_trial(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                                       const std::vector<std::vector<contact::Status>>& statuses,
                                       const LadderOptions& options);

/// 1 semismooth Newton: statuses follow the iterate
/// 2 the same from the last state instead of the predicted one: a prediction beyond the elastic slip of a sticking node
///   can make Newton cycle in the slip branch
/// 3 statuses frozen during each KINSOL call and settled between calls; if releases make the tangent singular, half of
///   them are undone, repeatedly, so that no body loses its support
///   Where bodies settle, settle_geometry() follows.
/// 4 stabilised: for a singular tangent, or as a last resort. Repeated solves with springs that hold bodies at the last
///   solution, softer after each success; accepted if the residual without springs is within tolerance, so that motions
///   that nothing determines remain as they are
/// The stepper decides about a smaller step or a failure.
/// @param z            predicted start values; last iterate afterwards
/// @param unpredicted  gives start values without prediction
/// @param start        statuses at the start
/// @param force_first  use these for the first iterate of rung 1, even if the complementarity functions differ
[[nodiscard]] LadderResult climb(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                                 const std::function<Vector()>& unpredicted, const equilibrium::Statuses& start,
                                 bool force_first, const LadderOptions& options);

} // namespace osculate::time
