#include "osculate/time/solve_ladder.hpp"

#include "time/friction_rung.hpp"
#include "time/geometry_rung.hpp"
#include "time/solve_once.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

namespace osculate::time {

using contact::Status;
using solve::KinsolOutcome;

namespace {

constexpr int most_settlings = 40; ///< KINSOL calls of rung 3
constexpr int most_means = 3;      ///< ways out of a cycle of two iterates, one after another

/// Whether z, which solves the equations, still does so when every slave node looks for its facet from where it started:
/// iterates that ran away may have left nodes latched on facets that are not below them.
bool is_solution(equilibrium::Equilibrium& equilibrium, const Vector& z, const LadderOptions& options) {
    const auto latched = [](const model::ContactEvaluation& evaluation) {
        for (Index j = 0; j < evaluation.pair().size(); ++j)
            if (evaluation.hit(j).latched) return true;
        return false;
    };
    if (!options.settles || std::ranges::none_of(equilibrium.contact(), latched)) return true;
    equilibrium.forget_paths();
    equilibrium.set_statuses(equilibrium.statuses(), equilibrium::StatusRule::natural, false);
    Vector F(z.size());
    if (equilibrium.residual(z, F) != equilibrium::Equilibrium::Verdict::proceed || !F.allFinite()) return false;
    constexpr double same = 10; // times the tolerance: patches of other facets have round-off of their own
    return F.cwiseAbs().maxCoeff() <= same * options.tolerance * options.reference_force;
}

/// Closes every second one of the nodes that `now` has open and `before` had closed; false when there are none.
bool take_back_half(const equilibrium::Statuses& before, equilibrium::Statuses& now) {
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

bool touches(const equilibrium::Statuses& statuses) {
    return std::ranges::any_of(statuses, [](const auto& pair) {
        return std::ranges::any_of(pair, [](Status s) { return s != Status::open; });
    });
}

LadderResult settle(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                    equilibrium::Statuses statuses, LadderOptions& options) {
    LadderResult result;
    result.rung = "frozen statuses";
    std::set<equilibrium::Statuses> seen;
    equilibrium::Statuses last = statuses;
    Vector last_z = z;
    // a smaller step is cheaper than a long search
    const int most_iterations = (options.last_chance ? 4 : 2) * options.max_iterations;
    for (int settling = 0; settling < most_settlings && result.iterations < most_iterations; ++settling) {
        equilibrium.set_statuses(statuses, equilibrium::StatusRule::frozen, false);
        z = last_z;
        if (settling == 0) equilibrium.linearise_first_about(options.unpredicted);
        auto solved = solve_once(equilibrium, solver, z, equilibrium::StatusRule::frozen, options);
        for (int k = 0; k < most_means && solved.outcome == KinsolOutcome::stopped; ++k) {
            const int before = solved.iterations;
            z = equilibrium.midpoint();
            equilibrium.set_statuses(statuses, equilibrium::StatusRule::frozen, false);
            solved = solve_once(equilibrium, solver, z, equilibrium::StatusRule::frozen, options);
            solved.iterations += before;
        }
        result.iterations += solved.iterations;
        result.outcome = solved.outcome;
        result.residual = solved.residual;
        result.failing_equation = solved.failing_equation;
        if (solve::is_singular(solved.outcome) && take_back_half(last, statuses)) continue;
        if (solved.outcome != KinsolOutcome::converged) return result;
        last = equilibrium.statuses();
        last_z = z;
        equilibrium::Statuses next = equilibrium.natural_statuses();
        if (next == last) return result;
        if (!seen.insert(next).second) {
            // statuses that go round for what is no more than round-off
            if (equilibrium.holds(z, next, options.tolerance)) return result;
            break;
        }
        statuses = std::move(next);
    }
    result.outcome = KinsolOutcome::stopped;
    return result;
}

/// N, the largest force of the springs k S (u - anchor) at a node.
double most_borne(const std::vector<double>& share, double stiffness, const Field& u, const Field& anchor) {
    double most = 0;
    for (std::size_t i = 0; i < share.size(); ++i)
        most = std::max(most, stiffness * share[i] * (u[i] - anchor[i]).norm());
    return most;
}

/// Rung 4, a proximal point iteration: u_k+1 solves f(u) + k S (u - u_k) = f_ext + f_contact.
LadderResult stabilise(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                       equilibrium::Statuses statuses, bool force_first, LadderOptions& options) {
    constexpr int most_solves = 200, most_slow = 40, most_failures = 24, most_in_a_row = 12, easy = 6;
    constexpr double softer = 1.0 / 16, little_softer = 0.5, stiffer = 16;
    constexpr double above = 4;     // times what was too soft: halfway to what is tried next
    constexpr double forgets = 0.7; // per success: what was too soft there may hold here
    constexpr double near = 0.1;    // of a stride: worth trying without springs

    const StabilisationOptions& how = options.stabilisation;
    // a smaller step is cheaper than a long search, and where nothing can come into contact there is nothing to search for
    const bool at_any_cost = options.last_chance && !statuses.empty();
    const int most_iterations = at_any_cost ? std::numeric_limits<int>::max() : 4 * options.max_iterations;
    LadderResult result;
    result.rung = "stabilised";
    result.outcome = KinsolOutcome::stopped;
    const Field start = equilibrium.displacements(z);
    // a wide gap is crossed in a few strides, and nothing is gone through that should have been met
    double gap = how.gap();
    const auto stride = [&] { return std::max(how.finest, 0.5 * gap); };
    const auto too_far = [&] { return std::max(how.finest, gap); };
    Field anchor = start;
    Vector anchor_z = z;
    // the reference force is a norm over the nodes; this is no less than their sum
    double stiffness = options.reference_force * std::sqrt(static_cast<double>(start.size())) / stride();
    double least = 0;                         // N/m, not tried below after a solve that failed
    double last_move = 0;                     // m
    int failures = 0, in_a_row = 0, slow = 0; // slow: not on the way across a gap
    const auto newton = [&](bool springs) {
        if (springs)
            equilibrium.stabilise({&how.share(), stiffness, anchor});
        else
            equilibrium.release();
        equilibrium.set_statuses(statuses, equilibrium::StatusRule::natural,
                                 force_first && result.stabilised_solves == 0);
        const auto solved = solve_once(equilibrium, solver, z, equilibrium::StatusRule::natural, options);
        result.iterations += solved.iterations;
        result.residual = solved.residual;
        result.failing_equation = solved.failing_equation;
        return solved;
    };
    bool undetermined = false; // the tangent without springs was singular with these statuses
    while (result.stabilised_solves < most_solves && slow < most_slow && failures < most_failures &&
           in_a_row < most_in_a_row && result.iterations < most_iterations) {
        z = anchor_z;
        equilibrium.set_sparing(true);
        auto solved = newton(true);
        equilibrium.set_sparing(false);
        if ((solved.outcome == KinsolOutcome::unsolved || solved.outcome == KinsolOutcome::stopped) &&
            (touches(statuses) || touches(equilibrium.statuses()))) {
            z = anchor_z;
            const LadderResult rubbed = settle_friction(equilibrium, solver, z, statuses, options);
            result.iterations += rubbed.iterations;
            if (rubbed.converged()) solved.outcome = rubbed.outcome;
        }
        if (solved.outcome == KinsolOutcome::unsolved && equilibrium.factorisable()) {
            z = anchor_z;
            solved = newton(true);
        }
        ++result.stabilised_solves;
        if (solved.outcome != KinsolOutcome::converged) {
            ++in_a_row;
            if (++failures > 1) least = above * stiffness; // one may be chance
            stiffness *= stiffer;
            continue;
        }
        in_a_row = 0;
        least *= forgets;
        Field u = equilibrium.displacements(z);
        const double moved = largest_distance(u, anchor).value;
        if (moved > too_far()) {
            stiffness *= moved / stride();
            continue;
        }
        const AtNode travelled = largest_distance(u, start);
        result.travelled = travelled.value;
        if (result.travelled > how.farthest) {
            result.adrift = travelled.node;
            break;
        }
        const double before = stride();
        slow += moved < 0.5 * before && !(moved > last_move) ? 1 : 0; // what moves ever further leaves where it was
        last_move = moved;
        equilibrium::Statuses next = equilibrium.statuses();
        undetermined = undetermined && next == statuses;
        statuses = std::move(next);
        const double borne = most_borne(how.share(), stiffness, u, anchor);
        anchor = std::move(u);
        anchor_z = z;
        if (const double now = equilibrium.least_gap(); std::isfinite(now)) gap = now;

        equilibrium.release();
        equilibrium.set_statuses(statuses, equilibrium::StatusRule::frozen, false);
        Vector F(z.size());
        if (equilibrium.residual(z, F) == equilibrium::Equilibrium::Verdict::proceed && F.allFinite()) {
            result.residual = F.cwiseAbs().maxCoeff() / options.reference_force;
            if (result.residual <= options.tolerance && equilibrium.natural_statuses() == statuses) {
                result.outcome = KinsolOutcome::converged;
                return result;
            }
        }
        // a body that may slide along a contact keeps the tangent without springs singular, though they bear nothing any more
        if (borne <= options.tolerance * options.reference_force && touches(statuses) &&
            equilibrium.holds(anchor_z, statuses, options.tolerance) && equilibrium.natural_statuses() == statuses) {
            result.outcome = KinsolOutcome::converged;
            return result;
        }
        if (moved < near * before && !undetermined) {
            const auto free = newton(false);
            if (free.outcome == KinsolOutcome::converged &&
                largest_distance(equilibrium.displacements(z), anchor).value < stride()) {
                result.outcome = KinsolOutcome::converged;
                return result;
            }
            undetermined = solve::is_singular(free.outcome);
        }
        // a body that has met nothing yet moves by a stride at a time, not through what it should meet
        stiffness =
            std::max(least, stiffness * std::max(solved.iterations <= easy ? softer : little_softer, moved / stride()));
    }
    if (result.adrift < 0 && result.stabilised_solves == most_solves && in_a_row < most_in_a_row) {
        const AtNode travelled = largest_distance(anchor, start);
        result.travelled = travelled.value;
        // below it moved, but did not run away
        if (!(travelled.value < 0.5 * how.farthest)) result.adrift = travelled.node;
    }
    if (result.adrift < 0 || result.stabilised_solves == most_solves) z = anchor_z; // not a try without springs
    equilibrium.release();
    return result;
}

} // namespace

LadderResult solve_trial(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                         const equilibrium::Statuses& statuses, const LadderOptions& options) {
    constexpr int most_iterations = 10; // sliding that goes on needs more, and says as little about what is open
    LadderOptions now = options;
    if (options.settles) now.max_iterations = std::min(now.max_iterations, most_iterations);
    equilibrium.set_statuses(statuses, equilibrium::StatusRule::frozen, false);
    equilibrium.linearise_first_about(options.predicted);
    const auto solved = solve_once(equilibrium, solver, z, equilibrium::StatusRule::frozen, now);
    return {solved.outcome, solved.iterations, solved.residual, now.reference_force, "trial", solved.failing_equation};
}

LadderResult climb(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver, Vector& z,
                   const std::function<Vector()>& unpredicted, const equilibrium::Statuses& start, bool force_first,
                   const LadderOptions& options) {
    LadderOptions now = options;
    const bool predicted = z != unpredicted();
    LadderResult result;
    struct Sprung {
        LadderResult result;
        Vector z;
        equilibrium::Statuses statuses;
    };
    std::optional<Sprung> sprung; // through another body: the first such solution
    const auto admitted = [&](const LadderResult& found) {
        if (!options.admissible || options.admissible(equilibrium.displacements(z))) return true;
        if (!sprung) sprung = {found, z, equilibrium.statuses()};
        return false;
    };
    const auto newton = [&](const char* rung, const Field& from, bool force) {
        equilibrium.set_statuses(start, equilibrium::StatusRule::natural, force);
        equilibrium.linearise_first_about(from);
        auto solved = solve_once(equilibrium, solver, z, equilibrium::StatusRule::natural, now);
        // what the linear residual alone says is no equilibrium
        if (solved.iterations == 0 && !from.empty())
            solved = solve_once(equilibrium, solver, z, equilibrium::StatusRule::natural, now);
        result = {
            solved.outcome,         result.iterations + solved.iterations, solved.residual, now.reference_force, rung,
            solved.failing_equation};
        if (result.converged() && !(is_solution(equilibrium, z, now) && admitted(result)))
            result.outcome = KinsolOutcome::stopped;
        return result.converged();
    };
    const auto rungs = [&] {
        bool singular = false;
        // an iterate that ran away says nothing about what holds the bodies
        const auto found_singular = [&] {
            return now.ran_away || (solve::is_singular(result.outcome) &&
                                    largest_component(equilibrium.displacements(z)) <= options.farthest);
        };
        if (newton("semismooth Newton", options.predicted, force_first)) return singular;
        singular = found_singular();
        if (start.empty()) return singular;
        equilibrium.set_impatient(false);
        z = unpredicted();
        if (options.settles) equilibrium.forget_paths();
        LadderResult rubbed = settle_friction(equilibrium, solver, z, start, now);
        rubbed.iterations += result.iterations;
        rubbed.reference_force = now.reference_force;
        if (rubbed.converged() && is_solution(equilibrium, z, now) && admitted(rubbed)) {
            result = rubbed;
            return singular;
        }
        result.iterations = rubbed.iterations;
        z = unpredicted();
        if (options.settles) equilibrium.forget_paths();
        if (predicted && newton("semismooth Newton without predictor", options.unpredicted, force_first))
            return singular;
        singular = singular || found_singular();
        for (int k = 0; k < most_means && result.outcome == KinsolOutcome::stopped; ++k) {
            z = equilibrium.midpoint();
            if (newton("semismooth Newton from the mean of two iterates", {}, false)) return singular;
        }
        z = unpredicted();
        LadderResult settled = settle(equilibrium, solver, z, start, now);
        settled.iterations += result.iterations;
        settled.reference_force = now.reference_force;
        result = settled;
        if (result.converged() && !admitted(result)) result.outcome = KinsolOutcome::stopped;
        if (result.converged() || !options.settles) return singular || found_singular();
        const Vector failed = z;
        z = unpredicted();
        equilibrium.forget_paths();
        LadderResult held = settle_geometry(equilibrium, solver, z, start, now);
        result.iterations += held.iterations;
        if (held.converged()) {
            held.iterations = result.iterations;
            held.reference_force = now.reference_force;
            result = held;
        } else {
            z = failed; // says more
        }
        return singular || found_singular();
    };
    const Vector first = predicted ? equilibrium.kept(z) : Vector(); // else it is the other
    equilibrium.set_impatient(options.settles);
    const bool singular = rungs();
    equilibrium.set_impatient(false);
    result.worst_element = equilibrium.worst_element();
    result.astray = !(largest_component(equilibrium.displacements(z)) <= options.farthest);
    const auto first_sprung = [&] {
        z = sprung->z;
        equilibrium.set_statuses(sprung->statuses, equilibrium::StatusRule::frozen, false);
        Vector F(z.size());
        (void)equilibrium.residual(z, F);
        sprung->result.iterations = result.iterations;
        return sprung->result;
    };
    const StabilisationOptions& how = options.stabilisation;
    if (result.converged() || !how.share || !(singular || options.last_chance))
        return sprung && !result.converged() ? first_sprung() : result;
    const Vector last = z;
    const equilibrium::Statuses last_statuses = equilibrium.statuses();
    z = predicted ? equilibrium.restored(first) : unpredicted();
    LadderResult held = stabilise(equilibrium, solver, z, start, force_first, now);
    held.reference_force = now.reference_force;
    held.iterations += result.iterations;
    result.iterations = held.iterations;
    if (sprung && !(held.converged() && admitted(held))) return first_sprung();
    if (!held.converged() && held.adrift < 0) { // what failed without springs says more
        z = last;
        equilibrium.set_statuses(last_statuses, equilibrium::StatusRule::frozen, false);
        return result;
    }
    if (held.adrift >= 0) held.outcome = KinsolOutcome::singular;
    return held;
}

} // namespace osculate::time
