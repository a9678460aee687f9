#include "osculate/time/step_control.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace osculate::time {

namespace {

struct Objection {
    Reason reason = Reason::none;
    double lambda = 1;
    double value = 0;
    const GapEvidence* point = nullptr; ///< of an interpenetration
    bool of_velocity = false;           ///< a time error
};

/// The smaller lambda; among equals the one there already.
void consider(Objection& governing, const Objection& other) {
    if (governing.reason == Reason::none || other.lambda < governing.lambda) governing = other;
}

void consider_gap(Objection& governing, const GapEvidence& gap, const StepLimits& limits) {
    const double g_p = limits.allowed_interpenetration * gap.length;
    if (gap.g1 >= -g_p) return;
    const double aim = gap.g0 < g_p ? limits.reserve : 1;
    consider(governing, {Reason::interpenetration, aim * reduction_factor(gap.g0, gap.g1, g_p), gap.g1, &gap});
}

/// What speaks most strongly against the step. What is not a number does.
/// @param can_be_cut  otherwise what only asks for smaller steps is silent, as in impacts
Objection strongest(const StepEvidence& evidence, const StepLimits& limits, bool can_be_cut) {
    Objection governing;
    if (!evidence.solved) return {Reason::solver, limits.failure_lambda, evidence.residual, nullptr};
    for (const GapEvidence& gap : evidence.gaps) consider_gap(governing, gap, limits);
    if (const GapEvidence& unseen = evidence.unseen;
        unseen.pair >= 0 && !(unseen.g1 >= -limits.unseen_interpenetration * unseen.length))
        consider(governing, {Reason::interpenetration, limits.failure_lambda, unseen.g1, &unseen});
    if (!(evidence.collision >= 1))
        consider(governing, {Reason::collision, evidence.collision, evidence.collision, nullptr});
    if (evidence.intrusion && !(evidence.intrusion->relative() <= limits.audited_depth))
        consider(governing, {Reason::audit, limits.failure_lambda, evidence.intrusion->excess, nullptr});
    if (evidence.far && !(evidence.far->relative() <= limits.audited_depth))
        consider(governing, {Reason::distance, limits.failure_lambda, evidence.far->distance, nullptr});
    if (!(evidence.local_error <= limits.error_tolerance)) {
        const double lambda =
            limits.reserve * std::cbrt(limits.error_tolerance / evidence.local_error); // of order dt^3
        consider(governing, {Reason::error, lambda, evidence.local_error, nullptr});
    }
    if (can_be_cut && !(evidence.velocity_error <= limits.velocity_error)) {
        const double lambda = limits.reserve * std::sqrt(limits.velocity_error / evidence.velocity_error);
        consider(governing, {Reason::error, lambda, evidence.velocity_error, nullptr, true});
    }
    if (!(evidence.energy_jump <= limits.energy_tolerance))
        consider(governing, {Reason::energy, limits.failure_lambda, evidence.energy_jump, nullptr});
    if (can_be_cut && !evidence.closes_anyhow && !(evidence.closing_energy <= limits.closing_energy)) {
        // the work of a force that grows with the step along a gap that does
        const double lambda = limits.reserve * std::sqrt(limits.closing_energy / evidence.closing_energy);
        consider(governing, {Reason::closing_energy, lambda, evidence.closing_energy, nullptr});
    }
    return governing;
}

void describe(std::ostream& text, const Objection& objection, const StepEvidence& evidence, const StepLimits& limits) {
    if (objection.point == &evidence.unseen) {
        text << "a slave node lies " << -objection.value
             << " m inside the master where its facets overlap no facet of the master, as on edges and vertices, so "
                "that mortar puts no force on it";
        return;
    }
    switch (objection.reason) {
    case Reason::solver: text << "the solve failed at a relative residual of " << objection.value; break;
    case Reason::interpenetration:
        text << "the trial has a gap of " << objection.value << " m, allowed is "
             << -limits.allowed_interpenetration * objection.point->length << " m";
        break;
    case Reason::collision: text << "a node passes through a surface at " << objection.value << " of the step"; break;
    case Reason::audit:
        text << "bodies lie inside one another: " << objection.value
             << " m more than facets of a smooth surface may, allowed is "
             << limits.audited_depth * evidence.intrusion->length << " m";
        break;
    case Reason::distance: {
        const FarForce& far = *evidence.far;
        text << "a contact force acts across " << far.distance << " m, allowed is "
             << far.distance - far.excess + limits.audited_depth * far.length << " m";
        break;
    }
    case Reason::error:
        if (objection.of_velocity) {
            text << "the error of the centres' velocities is " << objection.value
                 << " of the speed that all energy would give, allowed is " << limits.velocity_error;
            break;
        }
        text << "the local time error is " << objection.value << " m, allowed is " << limits.error_tolerance << " m";
        break;
    case Reason::energy:
        text << "the energy jumps by " << objection.value << ", allowed is " << limits.energy_tolerance;
        break;
    case Reason::closing_energy:
        text << "closing gaps take " << objection.value << " of all energy so far, allowed is "
             << limits.closing_energy;
        break;
    case Reason::none:
    case Reason::reach:
    case Reason::impact:
    case Reason::forced: break;
    }
}

/// Whether a shock of contact within the step can be the cause.
bool may_be_shock(const Objection& objection) {
    return objection.reason == Reason::solver || objection.reason == Reason::energy ||
           objection.reason == Reason::closing_energy || objection.of_velocity;
}

/// dt after an accepted step: larger after an easy one only, and not beyond what the time error admits.
double next_step(const StepEvidence& evidence, const StepLimits& limits, double dt, int repeats) {
    double factor = 1;
    if (repeats == 0 && evidence.iterations <= limits.easy_iterations) factor = limits.growth;
    if (evidence.local_error > 0) {
        const double admitted = limits.reserve * std::cbrt(limits.error_tolerance / evidence.local_error);
        factor = std::min(factor, std::max(admitted, 1.0));
    }
    if (evidence.velocity_error > 0 && !limits.inelastic_impacts) {
        const double admitted = limits.reserve * std::sqrt(limits.velocity_error / evidence.velocity_error);
        factor = std::min(factor, std::max(admitted, 1.0));
    }
    return std::min(factor * dt, limits.dt_max);
}

} // namespace

bool cannot_be_cut(const StepLimits& limits, double dt, int repeats) {
    return dt <= limits.dt_min * (1 + same_step) || repeats >= limits.most_repeats;
}

double reduction_factor(double g0, double g1, double g_p) {
    if (g1 >= -g_p) return 1;
    if (!(g0 > -g_p)) return 0;
    return g0 >= g_p ? g0 / (g0 - g1)          // (27)
                     : (g_p + g0) / (g0 - g1); // (28)
}

Decision judge(const StepEvidence& evidence, const StepLimits& limits, double dt, int repeats) {
    Decision decision;
    const bool can_be_cut = !cannot_be_cut(limits, dt, repeats) || (limits.inelastic_impacts && !evidence.impact);
    const Objection objection = strongest(evidence, limits, can_be_cut && !evidence.impact);
    if (objection.reason == Reason::none) {
        decision.value = evidence.residual;
        decision.impact = evidence.impact && !(evidence.velocity_error <= limits.velocity_error);
        if (!evidence.forced) {
            decision.dt = next_step(evidence, limits, dt, repeats);
            return decision;
        }
        decision.verdict = Verdict::retry;
        decision.reason = Reason::forced;
        decision.impact = evidence.impact;
        decision.dt = dt;
        decision.cause = "repeated on purpose";
        return decision;
    }

    decision.reason = objection.reason;
    decision.value = objection.value;
    decision.impact = evidence.impact;
    if (limits.inelastic_impacts && !evidence.impact && !evidence.hopeless && may_be_shock(objection)) {
        decision.verdict = Verdict::retry;
        decision.reason = Reason::impact;
        decision.impact = true;
        decision.dt = dt;
        std::ostringstream cause;
        describe(cause, objection, evidence, limits);
        decision.cause = cause.str() + "; repeated as an impact";
        return decision;
    }
    if (objection.point != nullptr) {
        decision.pair = objection.point->pair;
        decision.slave = objection.point->slave;
        decision.unseen = objection.point == &evidence.unseen;
    } else if (objection.reason == Reason::collision) {
        decision.pair = evidence.collision_pair;
        decision.slave = evidence.collision_slave;
    } else if (objection.reason == Reason::audit) {
        decision.intrusion = evidence.intrusion;
    } else if (objection.reason == Reason::distance) {
        decision.pair = evidence.far->pair;
        decision.slave = evidence.far->slave;
    }
    std::ostringstream cause;
    describe(cause, objection, evidence, limits);
    decision.lambda = std::max(limits.smallest_lambda, objection.lambda); // NaN becomes the floor
    const bool repeated = repeats >= limits.most_repeats, end = evidence.hopeless || cannot_be_cut(limits, dt, repeats);
    decision.dt = end ? dt : std::max(decision.lambda * dt, limits.dt_min);
    decision.verdict = end ? Verdict::give_up : Verdict::retry;
    if (evidence.hopeless)
        cause << "; no smaller step would help";
    else if (end && !repeated)
        cause << "; the step of " << dt << " s cannot be cut: dt_min is " << limits.dt_min << " s";
    else if (repeated)
        cause << "; the step has been repeated " << repeats << " times, the most allowed";
    decision.cause = cause.str();
    return decision;
}

std::vector<double> corners_between(std::vector<double> corners, double t_start, double duration, int steps) {
    constexpr double sliver = 1e-9; // of the step: round-off of the times, not a step of its own
    const double step = duration / steps;
    std::ranges::sort(corners);
    std::vector<double> times;
    double last = 0;
    for (const double corner : corners) {
        if (!(corner < duration) || corner - last <= sliver * step) continue;
        if (std::abs(corner - std::round(corner / step) * step) <= sliver * step) continue;
        times.push_back(t_start + corner);
        last = corner;
    }
    return times;
}

FittedStep fit_to(double t, double dt, std::span<const double> targets) {
    constexpr double same_time = 1e-12;   // relative; sums of some thousand steps differ by less
    constexpr double most_stretch = 1e-9; // relative; what a step is stretched rather than leave a sliver
    const auto after = [](double later, double earlier) {
        return later - earlier > same_time * std::max(std::abs(later), std::abs(earlier));
    };
    const auto next = std::ranges::find_if(targets, [&](double target) { return after(target, t); });
    if (next == targets.end()) return {dt, t + dt, false};
    const auto beyond = std::find_if(next, targets.end(), [&](double target) { return after(target, *next); });
    const double target = *(beyond - 1), left = target - t;
    if (std::abs(left - dt) <= dt * most_stretch) return {dt, target, true}; // equal steps stay equal, bit by bit
    if (left < dt) return {left, target, true};
    if (left < 2 * dt) dt = 0.5 * left;
    return {dt, t + dt, false};
}

} // namespace osculate::time
