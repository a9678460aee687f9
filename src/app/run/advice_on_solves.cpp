/// Advice where Newton's method finds no equilibrium.

#include "app/plan/settling.hpp"
#include "app/run/adviser.hpp"

#include <algorithm>

namespace osculate::app {

bool Adviser::cut_enough() const {
    constexpr std::size_t few = 3; // attempts
    constexpr double cut = 0.125;
    return found_.attempts.size() >= few || found_.dt <= cut * whole_step();
}

void Adviser::diverged() {
    if (!cut_enough()) smaller_steps("Newton starts nearer to the solution");
    less_load();
}

void Adviser::less_load() {
    add(stage_, "less load than at " + number(found_.last_time) +
                    " s, the last equilibrium, or a displacement instead of the load: a displacement can move a "
                    "body past the point where it gives way under a load");
}

void Adviser::larger_tolerance() {
    constexpr double near = 100; // times the tolerance
    constexpr double harmless = 1e-6;
    const double tolerance = failed_.ladder.tolerance;
    if (found_.residual > tolerance && found_.residual < std::max(near * tolerance, harmless))
        tolerance_above_residual();
}

void Adviser::tolerance_above_residual() {
    change("solver.tolerance", rounded(margin * found_.residual),
           "above " + number(found_.residual) + " instead of " + number(failed_.ladder.tolerance) +
               ": round-off keeps the residual there");
}

void Adviser::cycle() {
    larger_tolerance();
    smaller_steps("fewer nodes change their status at once");
    const model::ContactPair* const one = found_.contact ? pair(found_.contact->pair) : nullptr;
    if (one == nullptr) return;
    if (failed_.stage.dynamics && failed_.stage.dynamics->stiffness_damping == 0 && one->options().friction > 0) {
        const std::string value = rounded(automatic_stiffness_damping(whole_step())) + " s";
        change(in_stage("analysis.dynamic.stiffness_damping"), value,
               value + ": bodies that rock on surfaces with friction stick and slip in vibrations that are too "
                       "fast for any step");
    }
    if (one->options().friction > 0.3)
        add(key_of(*one) + ".friction", "below " + number(one->options().friction) +
                                            ", if only for a test: high friction makes stick and slip alternate");
    add(surface_key(*one), "blend, if it is facets or rpim: normals that jump at edges move nodes back and forth");
    add("bodies." + found_.body + ".mesh", "finer near the listed nodes: too few nodes carry the contact");
}

void Adviser::iterations() {
    const std::size_t n = found_.iterations.size();
    const double last = found_.residual, before = n > 1 ? found_.iterations[n - 2].residual : last;
    const double now = n > 0 ? found_.iterations[n - 1].residual : last;
    const int most = failed_.ladder.max_iterations;
    constexpr double near = 100; // times the tolerance: round-off rather than a lack of iterations
    constexpr int usual = 30;
    if (last < near * failed_.ladder.tolerance && !(now < 0.5 * before)) tolerance_above_residual();
    if (now < 0.5 * before || most < usual) {
        const std::string more = std::to_string(std::max(usual, 2 * most));
        change("solver.max_iterations", more,
               more + " instead of " + number(most) + (now < 0.5 * before ? ": the residual was still falling" : ""));
    } else
        smaller_steps("the residual did not fall any more, so more iterations alone would not help");
    if (most < usual) return;
    if (found_.contact)
        add(surface_key(*pair(found_.contact->pair)),
            "blend, if it is facets or rpim: Newton converges better if normals do not jump");
}

void Adviser::stall() {
    // without contact a residual that stops falling, however short the step, has no equilibrium to fall towards
    if (failed_.last.contact.empty() && !failed_.stage.dynamics && cut_enough())
        less_load();
    else
        smaller_steps("Newton starts nearer to the solution");
    larger_tolerance();
    if (found_.contact)
        add(key_of(*pair(found_.contact->pair)) + ".friction", "lower, if only to test whether friction is the cause");
}

} // namespace osculate::app
