#pragma once
/// Decides about an attempted step: pure decisions from evidence.

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
/// changes at constant speed.                                                            [Qian 2014, eqs (27) and (28)]
///   g1 >= -g_p   1: admissible as it is
///   g0 >= g_p    lambda = g0/(g0 - g1)             ends on the surface                                            (27)
///   g0 < g_p     lambda = (g_p + g0)/(g0 - g1)     ends at the allowed interpenetration                           (28)
/// The paper uses (27) for all g0 >= 0; this gives lambda = 0 at g0 = 0, and almost zero near it.
/// @param g0   gap at the start, m; negative inside the master
/// @param g1   gap in the trial, m
/// @param g_p  allowed interpenetration, m, > 0
/// @returns within [0, 1]; 0 if no fraction is admissible, g0 <= -g_p
[[nodiscard]] double reduction_factor(double g0, double g1, double g_p);

/// A point that was open at the start of the step.
struct GapEvidence {
    double g0 = 0, g1 = 0; ///< gap at the start and in the trial, m
    Index pair = -1, slave = -1;
    double length = 1; ///< unit of StepLimits::allowed_interpenetration here, m
};

/// A slave that carries a contact force although the facets of its master are far from it.
struct FarForce {
    Index pair = -1, slave = -1;
    double force = 0;    ///< N
    double distance = 0; ///< of the slave from the closest facet of the master, m
    /// The distance less the gap that contact reports, and less what smooth surfaces may bulge by, >= 0, m. Where gaps are averages
    /// over facets of the slave, the distance of these counts.
    double excess = 0;
    double length = 1; ///< size of the larger of the facets there, m

    /// Excess in facet sizes.
    [[nodiscard]] double relative() const { return excess / length; }
};

/// Steps count as equal if their lengths differ by less than this, relatively: more than the stretch in fit_to().
inline constexpr double same_step = 1e-6;

/// Evidence about an attempt. The defaults contain no objection. So a trial can be judged by its gaps alone before the
/// equilibrium with contact is solved, and the whole step again afterwards.
struct StepEvidence {
    std::vector<GapEvidence> gaps;
    bool solved = true;     ///< false: the other members are ignored
    bool hopeless = false;  ///< not solved, and a smaller step would not help
    int iterations = 0;     ///< of all solves of the attempt
    double residual = 0;    ///< relative
    double local_error = 0; ///< Integrator::local_error(), m
    double energy_jump = 0; ///< in the unit of its tolerance, >= 0
    /// Error of this step in the velocities of the bodies' centres, divided by the speed if all energy were kinetic:
    /// sqrt(sum_b |e_b|^2 m_b/(2 energy)), e_b = c dt (a - a_n), c of Integrator::local_error() and a of contact.
    double velocity_error = 0;
    double closing_energy = 0;  ///< energy lost in closing gaps, divided by all energy of the run so far
    bool closes_anyhow = false; ///< a longer attempt lost less per unit of dt: cuts do not help
    double collision = 1;       ///< fraction of the step at which a path first crosses a surface; 1: none
    Index collision_pair = -1, collision_slave = -1; ///< slave node of this path
    /// Deepest slave node of a mortar pair that is inside the master where its facets have no overlap, so that no
    /// average detects it; pair -1: none. In the solution, not in the trial.
    GapEvidence unseen;
    /// Deepest place at which a body is inside another in the solution, from geometry alone.
    std::optional<contact::Intrusion> intrusion;
    std::optional<FarForce> far; ///< contact force across the largest distance, from geometry as well
    bool impact = false;         ///< the attempt was made by the rule for impacts
    bool forced = false;         ///< repeat the step unchanged, to test repetition
};

struct StepLimits {
    double allowed_interpenetration = std::numeric_limits<double>::infinity(); ///< g_p in GapEvidence::length, > 0
    /// allowed_interpenetration is a default of statics: steps of full size are solved without a trial until one was
    /// cut, and RunChecks applies a stricter bound.
    bool usual_bound = false;
    bool in_metres = false;       ///< unit of GapEvidence::length: 1 m, else the facet's size
    double smallest_lambda = 0.1; ///< floor of lambda
    double failure_lambda = 0.5;  ///< used if there is no estimate: failed solves, energy jumps
    /// Factor on proposals that aim exactly at a bound: (28) and the time error. Without it, a gap that closes ever
    /// more slowly approaches -g_p from below, cut by cut, and never reaches it.
    double reserve = 0.9;
    double dt_min = 0, dt_max = std::numeric_limits<double>::infinity(); ///< s
    int most_repeats = 20;                                               ///< largest number of repeats of one step
    double growth = 1.5;                                                 ///< factor on dt after an easy step
    int easy_iterations = 5;               ///< an easy step needs no more, and is accepted at the first attempt
    double unseen_interpenetration = 0.01; ///< allowed StepEvidence::unseen, in GapEvidence::length
    double audited_depth = std::numeric_limits<double>::infinity();   ///< largest Intrusion and FarForce::relative()
    double error_tolerance = std::numeric_limits<double>::infinity(); ///< m
    double energy_tolerance = std::numeric_limits<double>::infinity();
    double velocity_error = std::numeric_limits<double>::infinity(); ///< ignored if the step cannot be cut, as the next
    double closing_energy = std::numeric_limits<double>::infinity();
    /// A step in which contact acts as a shock is not cut, but made by backward Euler, for which an impact within a step
    /// is inelastic: what a step cannot follow comes to rest.
    bool inelastic_impacts = false;
};

struct Decision {
    Verdict verdict = Verdict::accept;
    Reason reason = Reason::none;
    bool impact = false; ///< the next attempt is one of an impact
    double dt = 0;       ///< of the next step after accept, of the same step after retry, s
    double lambda = 1;   ///< fraction of a rejected attempt's dt that was required, with floor but without dt_min
    double value =
        0; ///< deciding value: gap g1, residual, local error, energy jump, share or fraction; if accepted: the residual
    Index pair = -1, slave = -1;                 ///< governing point of an interpenetration, a collision or a far force
    bool unseen = false;                         ///< an interpenetration that no average detects
    std::optional<contact::Intrusion> intrusion; ///< intrusion found by the audit
    std::string cause;                           ///< in words; empty when accepted
};

/// Whether judge() gives up instead of cutting the step.
[[nodiscard]] bool cannot_be_cut(const StepLimits& limits, double dt, int repeats);

/// The objection with the smallest lambda governs; among equal ones the first of: solver, interpenetration, collision,
/// audit, distance, error, velocity_error, energy, closing_energy. A cut never goes below dt_min, which is tried before giving
/// up. Errors of velocities and closing gaps only cut: if the step cannot be cut they are ignored, and RunChecks
/// reports their cost. With inelastic impacts, an objection that a shock can cause (solver, error of velocities, energy,
/// closing_energy) makes the step an impact of the same dt; in an impact, errors of velocities and closing gaps are no
/// objections, and the last such step is one without them.
/// @param dt       of the attempt, s
/// @param repeats  of this step so far, without forced ones
[[nodiscard]] Decision judge(const StepEvidence& evidence, const StepLimits& limits, double dt, int repeats);

struct FittedStep {
    double dt = 0, time = 0; ///< time at its end, s: exactly a target, not a sum near it
    bool on_target = false;
};

/// The step from time t that lets steps hit every target exactly and leaves no sliver before one: if the rest after a
/// step would be shorter than the step, both get half of the total. Never longer than dt, except for round-off. After a
/// shorter step the caller keeps dt for the steps behind the target, because judge() increases only the step that it is
/// given.
/// @param targets  ascending, s; ignores those already reached; those equal within round-off count as one, the last
[[nodiscard]] FittedStep fit_to(double t, double dt, std::span<const double> targets);

/// Times at which steps of a stage must end, in addition to the ends of its equal steps.
/// @param corners  since the stage's start, s, in any order
/// @param t_start  of the stage, s
/// @returns ascending, within the stage, without times that equal the end of a step or another corner within round-off
[[nodiscard]] std::vector<double> corners_between(std::vector<double> corners, double t_start, double duration,
                                                  int steps);

} // namespace osculate::time
