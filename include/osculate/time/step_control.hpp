#pragma once
/// What becomes of an attempted step: pure decisions over evidence.

#include "osculate/contact/surface_audit.hpp"
#include "osculate/core/types.hpp"
#include "osculate/time/attempt.hpp"

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace osculate::time {

/// Fraction of a step at which a point that was open at its start is expected to have an admissible gap, for a gap that
/// changes at constant speed.                                                              [Qian 2014, eqs (27) and (28)]
///   g1 >= -g_p   1: admissible as it is
///   g0 >= g_p    lambda = g0/(g0 - g1)             ends on the surface                                            (27)
///   g0 < g_p     lambda = (g_p + g0)/(g0 - g1)     ends at the allowed interpenetration                           (28)
/// The paper has (27) for all g0 >= 0; at g0 = 0 that would stand still, and near it nearly so.
/// @param g0   gap at the start, m; negative inside the master
/// @param g1   gap in the trial, m
/// @param g_p  allowed interpenetration, m, > 0
/// @returns    within [0, 1]; 0 where no fraction is admissible, g0 <= -g_p
[[nodiscard]] double reduction_factor(double g0, double g1, double g_p);

/// A point that was open at the start of the step.
struct GapEvidence {
    double g0 = 0, g1 = 0; ///< gap at the start and in the trial, m
    Index pair = -1, slave = -1;
    double length = 1; ///< unit of StepLimits::allowed_interpenetration here, m
};

/// Steps whose lengths differ by less, relatively, are the same: above what fit_to() stretches a step by.
inline constexpr double same_step = 1e-6;

/// What is known of an attempt. The defaults speak against nothing, so that a trial can be judged by its gaps alone
/// before the equilibrium with contact is solved, and the whole step once more afterwards.
struct StepEvidence {
    std::vector<GapEvidence> gaps;
    bool solved = true;     ///< false: nothing else is looked at
    bool hopeless = false;  ///< not solved, and no smaller step would be
    int iterations = 0;     ///< of all solves of the attempt
    double residual = 0;    ///< relative
    double local_error = 0; ///< Integrator::local_error(), m
    double energy_jump = 0; ///< in the unit of its tolerance, >= 0
    /// Error that the step makes by itself in the velocities of the bodies' centres, of the speed that all energy would
    /// give: sqrt(sum_b |e_b|^2 m_b/(2 energy)), e_b = c dt (a - a_n), c of Integrator::local_error() and a of contact.
    double velocity_error = 0;
    double closing_energy = 0;  ///< taken by gaps that closed, of all energy there has been
    bool closes_anyhow = false; ///< a longer attempt at the step lost less of it, by its length: no cut helps
    double collision = 1;       ///< fraction of the step at which a path first goes through a surface; 1: none does
    Index collision_pair = -1, collision_slave = -1; ///< whose path that is
    /// Deepest slave node of a mortar pair that lies inside the master where its facets overlap nothing, so that no
    /// average sees it; pair -1: there is none. In the solution, not in the trial.
    GapEvidence unseen;
    /// Deepest place at which a body lies inside another in the solution, by geometry alone.
    std::optional<contact::Intrusion> intrusion;
    bool forced = false; ///< repeat the step as it is, for tests of repetition
};

struct StepLimits {
    double allowed_interpenetration = std::numeric_limits<double>::infinity(); ///< g_p in GapEvidence::length, > 0
    /// allowed_interpenetration is a default of statics: steps are solved without a trial until one of their size was cut,
    /// and what is accepted is held to more.
    bool usual_bound = false;
    bool in_metres = false;       ///< for whoever sets GapEvidence::length: 1 m, else the facet's size
    double smallest_lambda = 0.1; ///< floor of lambda
    double failure_lambda = 0.5;  ///< where nothing tells how much to cut: failed solves, energy jumps
    /// Of the proposals that aim at a bound itself: (28) and the time error. Without it a gap that closes
    /// slower and slower creeps up to -g_p from below, cut by cut, and does not arrive.
    double reserve = 0.9;
    double dt_min = 0, dt_max = std::numeric_limits<double>::infinity(); ///< s
    int most_repeats = 20;                                               ///< of one step
    double growth = 1.5;                                                 ///< of dt after an easy step
    int easy_iterations = 5;               ///< an easy step takes no more, and is accepted at first go
    double unseen_interpenetration = 0.01; ///< of GapEvidence::length, for StepEvidence::unseen
    double audited_depth = std::numeric_limits<double>::infinity();   ///< of Intrusion::relative()
    double error_tolerance = std::numeric_limits<double>::infinity(); ///< m
    double energy_tolerance = std::numeric_limits<double>::infinity();
    double velocity_error = std::numeric_limits<double>::infinity(); ///< of a step that can be cut, as the next
    double closing_energy = std::numeric_limits<double>::infinity();
};

struct Decision {
    Verdict verdict = Verdict::accept;
    Reason reason = Reason::none;
    double dt = 0;     ///< of the next step after accept, of the same step after retry, s
    double lambda = 1; ///< fraction of a rejected attempt's dt that was called for, floor included, dt_min not
    double value =
        0; ///< what decided: gap g1, residual, local error, energy jump, share or fraction; accepted: the residual
    Index pair = -1, slave = -1;                 ///< governing point of an interpenetration or a collision
    bool unseen = false;                         ///< an interpenetration that no average sees
    std::optional<contact::Intrusion> intrusion; ///< what the audit found
    std::string cause;                           ///< in words; empty when accepted
};

/// Whether judge() gives up where it would cut the step.
[[nodiscard]] bool cannot_be_cut(const StepLimits& limits, double dt, int repeats);

/// The smallest lambda of all objections governs, among equals the first of: solver, interpenetration, collision, audit,
/// error, velocity_error, energy, closing_energy. A cut never goes below dt_min, which is tried before giving up. Velocities' error
/// and closing gaps only cut: at dt_min they are no objection, and RunChecks reports what they cost.
/// @param dt       of the attempt, s
/// @param repeats  of this step so far, forced ones not counted
[[nodiscard]] Decision judge(const StepEvidence& evidence, const StepLimits& limits, double dt, int repeats);

struct FittedStep {
    double dt = 0, time = 0; ///< time at its end: a target itself, not a sum that comes near it, s
    bool on_target = false;
};

/// The step to take at time t so that every target is hit exactly and no sliver is left before one: a step that would
/// leave less than itself is halved with what it leaves. Never longer than dt, but for round-off. Whoever takes a shorter
/// step keeps dt for after the target, since judge() lets grow the step it was given.
/// @param targets  ascending, s; those reached are passed over, those equal but for round-off count as one, the last
[[nodiscard]] FittedStep fit_to(double t, double dt, std::span<const double> targets);

/// Times at which the steps of a stage must end on top of the ends of its equal steps.
/// @param corners  since the stage's start, s, in any order
/// @param t_start  of the stage, s
/// @returns        ascending, within the stage, none that is an end of a step or another corner but for round-off
[[nodiscard]] std::vector<double> corners_between(std::vector<double> corners, double t_start, double duration,
                                                  int steps);

} // namespace osculate::time
