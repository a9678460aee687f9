/// What to change after a failure. Every piece names a key of the scene, and where a value can be told, `--set` takes it.

#include "osculate/app/advice.hpp"

#include "app/plan/settling.hpp"
#include "osculate/core/without_traps.hpp"
#include "osculate/model/general_contact.hpp"
#include "osculate/time/collision_check.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace osculate::app {

using model::body_of;
using time::Cause;
using time::FailedAttempt;
using time::PostMortem;

namespace {

std::string number(double value) {
    return fmt::format("{:g}", value);
}

/// A round number for an override.
std::string rounded(double value) {
    return fmt::format("{:.2g}", value);
}

/// Gathers advice for one failure.
class Adviser {
public:
    Adviser(PostMortem& found, const FailedAttempt& failed)
        : found_(found), failed_(failed), stage_("stages." + failed.stage.name) {}

    void advise() {
        switch (found_.cause) {
        case Cause::unsupported_body: unsupported(); break;
        case Cause::singular_tangent: contradiction(); break;
        case Cause::linear_system:
            add("solver.linear_solver",
                "iterative instead of multigrid, if there is enough memory to factorise the bodies",
                {"solver.linear_solver=iterative"});
            break;
        case Cause::diverged: diverged(); break;
        case Cause::status_cycle: cycle(); break;
        case Cause::iterations_exhausted: iterations(); break;
        case Cause::stalled:
        case Cause::no_descent:
        case Cause::not_evaluable: stall(); break;
        case Cause::not_finite: not_finite(); break;
        case Cause::inside_out: inside_out(); break;
        case Cause::interpenetration:
        case Cause::collision: too_deep(); break;
        case Cause::unseen_contact: unseen(); break;
        case Cause::far_contact: far(); break;
        case Cause::time_error: time_error(); break;
        case Cause::energy: energy(); break;
        case Cause::load_not_finite: break;
        }
    }

private:
    static constexpr double margin = 2; ///< of values that are set beyond a limit, which a longer run may need again

    void add(std::string key, std::string text, std::vector<std::string> set = {}) {
        found_.advice.push_back({std::move(key), std::move(text), std::move(set)});
    }
    /// Advice that is one value of its key.
    void change(const std::string& key, const std::string& value, std::string text) {
        add(key, std::move(text), {key + "=" + value});
    }
    [[nodiscard]] std::string in_stage(const std::string& key) const { return stage_ + "." + key; }
    [[nodiscard]] const model::ContactPair* pair(const std::string& name) const {
        for (const model::ContactHistory& one : failed_.last.contact)
            if (one.pair->name() == name) return one.pair.get();
        return nullptr;
    }
    /// Key of the scene that describes a pair.
    [[nodiscard]] std::string key_of(const model::ContactPair& pair) const {
        return is_own(pair.name()) ? "contact." + pair.name() : "contact.general";
    }
    [[nodiscard]] std::string surface_key(const model::ContactPair& pair) const {
        return key_of(pair) + (is_own(pair.name()) ? ".master.surface" : ".surface");
    }
    /// Whether the scene has a pair of this name; general contact finds others.
    [[nodiscard]] bool is_own(const std::string& name) const {
        return std::ranges::any_of(failed_.model.pairs, [&](const auto& one) { return one->name() == name; });
    }
    [[nodiscard]] double whole_step() const { return failed_.stage.duration / failed_.stage.steps; }

    /// More cuts, where that is what was missing; more steps otherwise.
    void smaller_steps(const std::string& why) {
        const double smallest = found_.smallest_dt / whole_step();
        if (at_smallest())
            change("solver.smallest_step", number(smallest / 100),
                   number(smallest / 100) + " instead of " + number(smallest) +
                       ", so that the step may be cut further: " + why);
        const int steps = 4 * failed_.stage.steps;
        change(in_stage("steps"), std::to_string(steps),
               std::to_string(steps) + " instead of " + number(failed_.stage.steps) +
                   ", so that every step asks for less");
    }
    [[nodiscard]] bool at_smallest() const { return found_.dt <= found_.smallest_dt * (1 + time::same_step); }

    /// The same where it is known by how much: nothing where a run would not come to its end with such steps.
    /// @param share  of the last attempt's step that would do
    /// @param least  of the stage's steps, steps that a run can do with
    void steps_smaller_by(double share, double least, const std::string& why) {
        const double smallest = found_.smallest_dt / whole_step(), wanted = found_.dt / whole_step() * share / margin;
        if (!at_smallest() || !(wanted > least)) return;
        change("solver.smallest_step", rounded(wanted),
               rounded(wanted) + " instead of " + number(smallest) + ", so that the step may be cut further: " + why);
    }

    static std::string listed(const std::vector<std::string>& words) {
        std::string text;
        for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
        return text;
    }

    void unsupported() {
        const auto at = std::ranges::find(found_.bodies, found_.body, &time::BodyHold::body);
        if (at == found_.bodies.end()) return;
        const time::BodyHold& loose = *at;
        const std::string ways = loose.free_motions.empty()
                                     ? "free in " + std::to_string(loose.free_by_supports) + " ways without contact"
                                     : "free " + listed(loose.free_motions);
        add("supports",
            "hold body '" + loose.body + "', which is " + ways + ": fix one of its sets, or add a symmetry plane");
        const bool adrift = failed_.result.adrift >= 0;
        constexpr double apart = 1e-6; // facets
        const bool lay = loose.nearest_gap <= apart * loose.facet,
                   slid = adrift && lay && closed_again(loose.nearest_pair);
        if (loose.in_pair && loose.pressed == 0 && !slid && (loose.touching + loose.touched > 0 || adrift)) {
            const std::string how = loose.touching > 0
                                        ? "contact would have to pull at " + std::to_string(loose.touching) + " nodes"
                                    : loose.touched > 0 ? "it touched at " + std::to_string(loose.touched) +
                                                              " nodes at the last good time, and contact cannot pull"
                                                        : "nothing in its way stops it";
            add(stage_, "this stage pulls body '" + loose.body + "' off (" + how +
                            "): reverse or reduce the load, or move the body by a displacement instead of a load");
        }
        if (loose.in_pair && loose.touching + loose.touched == 0 && !loose.nearest_pair.empty() && !lay) {
            add(in_stage("displacement"),
                "move the body by a displacement until it touches, instead of loading it: its nearest slave node is " +
                    number(loose.nearest_gap) + " m away");
            if (failed_.ladder.stabilisation.share == nullptr)
                change("solver.stabilisation", "true",
                       "true, so that the load can move the body until it touches something");
            else if (loose.nearest_gap < loose.facet && !adrift) // else the load does not lead there
                change(key_of(*pair(loose.nearest_pair)) + ".closing_tolerance",
                       rounded(std::min(1.0, margin * loose.nearest_gap / loose.facet)),
                       "above " + number(loose.nearest_gap / loose.facet) +
                           ", so that nodes this close count as touching in the first solve");
        }
        if (loose.pressed > 0 || slid)
            if (const model::ContactPair* const one = pair(loose.nearest_pair);
                one != nullptr && one->options().friction == 0)
                change(key_of(*one) + ".friction", "0.3",
                       "above 0, for example 0.3, if the real surfaces are rough: without friction, contact holds "
                       "the body only along its normals");
        dynamics("if body '" + loose.body + "' is really meant to move freely: its inertia then holds it");
    }

    /// Whether nodes of a pair that opened during the last attempt closed again: what pulls a body off does not do that.
    [[nodiscard]] bool closed_again(const std::string& name) const {
        return std::ranges::any_of(found_.changes, [&](const time::StatusChanges& one) {
            const auto opened = std::ranges::find_if_not(one.sequence, contact::is_closed);
            return one.pair == name && std::any_of(opened, one.sequence.end(), contact::is_closed);
        });
    }

    void dynamics(const std::string& why) {
        const std::string key = in_stage("analysis");
        const auto has_density = [](const model::Body& body) { return body.has_mass(); };
        if (std::ranges::all_of(failed_.model.bodies, has_density))
            change(key, "dynamic", "dynamic, " + why);
        else
            add(key, "dynamic, " + why + ", and every body needs a density");
    }

    void contradiction() {
        add("supports", "look for parts that are held or driven on both sides of a contact: if neither side can move, "
                        "neither force nor gap is determined");
        add(in_stage("displacement"),
            "drive a part of the body that is not itself in contact, so that the part in contact can deform");
        if (found_.contact && is_own(found_.contact->pair))
            add("contact." + found_.contact->pair + ".slave", "leave out nodes that are held or driven");
    }

    /// Whether the step was cut so often, in this step or before, that more of it would change nothing.
    [[nodiscard]] bool cut_enough() const {
        constexpr std::size_t few = 3; // attempts
        constexpr double cut = 0.125;
        return found_.attempts.size() >= few || found_.dt <= cut * whole_step();
    }
    void diverged() {
        if (!cut_enough()) smaller_steps("Newton starts nearer to the solution");
        less_load();
    }
    void less_load() {
        add(stage_, "less load than at " + number(found_.last_time) +
                        " s, the last equilibrium, or a displacement instead of the load: a displacement can move a "
                        "body past the point where it gives way under a load");
    }

    /// Where the residual is so small that round-off rather than the contact may hold it there.
    void larger_tolerance() {
        constexpr double near = 100; // times the tolerance
        constexpr double harmless = 1e-6;
        const double tolerance = failed_.ladder.tolerance;
        if (found_.residual > tolerance && found_.residual < std::max(near * tolerance, harmless))
            tolerance_above_residual();
    }
    void tolerance_above_residual() {
        change("solver.tolerance", rounded(margin * found_.residual),
               "above " + number(found_.residual) + " instead of " + number(failed_.ladder.tolerance) +
                   ": round-off keeps the residual there");
    }

    void cycle() {
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

    void iterations() {
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
                   more + " instead of " + number(most) +
                       (now < 0.5 * before ? ": the residual was still falling" : ""));
        } else
            smaller_steps("the residual did not fall any more, so more iterations alone would not help");
        if (most < usual) return;
        if (found_.contact)
            add(surface_key(*pair(found_.contact->pair)),
                "blend, if it is facets or rpim: Newton converges better if normals do not jump");
    }

    void stall() {
        // without contact a residual that stops falling, however short the step, has no equilibrium to fall towards
        if (failed_.last.contact.empty() && !failed_.stage.dynamics && cut_enough())
            less_load();
        else
            smaller_steps("Newton starts nearer to the solution");
        larger_tolerance();
        if (found_.contact)
            add(key_of(*pair(found_.contact->pair)) + ".friction",
                "lower, if only to test whether friction is the cause");
    }

    void not_finite() {
        add(stage_, "loads and motions of an ordinary size: forces or displacements overflow");
        smaller_steps("a number overflowed within the step");
    }

    void inside_out() {
        if (!found_.element) return;
        constexpr double crushed = 0.1; // of its volume is left: it is the motion that does it, step by step
        const bool gradually = volume_left() < crushed;
        if (!gradually) smaller_steps("elements can take only a little compression in one step");
        add(stage_, "a smaller load or motion on body '" + found_.element->body + "', " +
                        (gradually ? "in which an element has almost no volume left at the last good time already"
                                   : "if the body cannot bear this one at all"));
        if (!gradually)
            add("bodies." + found_.element->body + ".material",
                "neo_hookean, if it is saint_venant_kirchhoff, which loses its stiffness under strong compression");
        add("bodies." + found_.element->body + ".mesh", "a mesh without thin or skewed elements there");
    }

    /// Least det F at the last accepted state.
    [[nodiscard]] double volume_left() const {
        const model::Model& model = failed_.model;
        Field f(model.X.size());
        return model.nonlinear ? model.nonlinear->add_force(model.X, failed_.last.at_rest(), f, 1).J : 1;
    }

    void too_deep() {
        constexpr double least = 1e-6; // steps grow again once the surfaces touch
        const std::string why = "the node then moves less in a step";
        if (found_.cause == Cause::collision) { // shorter still: at the surface its depth is bounded, too
            constexpr double most = 0.02;
            return steps_smaller_by(std::min({failed_.decision.value, most, share_within_depth()}), least, why);
        }
        const time::StepLimits& limits = failed_.stage.limits;
        const double depth = std::abs(failed_.decision.value), unit = unit_of_depth();
        steps_smaller_by(limits.allowed_interpenetration * unit / depth, least, why);
        const std::string words = limits.in_metres ? " m" : " (of the facet size)";
        const double enough = margin * depth / unit;
        const std::string key = in_stage("control.allowed_interpenetration");
        const std::string text = "more than " + number(limits.allowed_interpenetration) + words +
                                 ", if a trial gap of " + number(failed_.decision.value) +
                                 " m does no harm: contact pushes the node back before the step is done";
        if (limits.in_metres && std::isfinite(enough))
            change(key, rounded(enough) + " m", text);
        else if (constexpr double largest = 1; !limits.in_metres && enough <= largest)
            change(key, rounded(enough), text);
        else
            add(key, text);
    }

    /// Share of a step that ended beyond the surface, within which the node moves no more than it may enter; infinite: not known.
    [[nodiscard]] double share_within_depth() const {
        constexpr double unknown = std::numeric_limits<double>::infinity();
        if (!found_.contact || found_.contact->master_facet < 0 || !(found_.contact->gap < 0)) return unknown;
        const double beyond = 1 - failed_.decision.value, moved = -found_.contact->gap / beyond;
        const double depth = std::min(failed_.stage.limits.allowed_interpenetration * unit_of_depth(),
                                      time::CollisionCheck::deepest *
                                          pair(found_.contact->pair)->thickness(found_.contact->master_facet));
        return beyond > 0 && moved > 0 ? depth / moved : unknown;
    }

    /// What allowed_interpenetration is a share of at the node in question, m.
    [[nodiscard]] double unit_of_depth() const {
        if (failed_.stage.limits.in_metres || !found_.contact || found_.contact->master_facet < 0) return 1;
        return pair(found_.contact->pair)->surface().facet_size(found_.contact->master_facet);
    }

    void unseen() {
        if (failed_.decision.intrusion) return inside(*failed_.decision.intrusion);
        by_nodes(*failed_.last.contact[static_cast<std::size_t>(failed_.decision.pair)].pair);
    }
    void by_nodes(const model::ContactPair& pair) {
        change(key_of(pair) + ".discretisation", "node",
               "node: averages over facets see neither edges against edges nor vertices");
    }

    /// Overrides that make the master of a pair its slave, where sets of the scene are these surfaces.
    [[nodiscard]] std::vector<std::string> sides_swapped(const model::ContactPair& pair) const {
        const auto named = [&](std::vector<Index> nodes) {
            std::ranges::sort(nodes);
            nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
            const auto at = std::ranges::find(failed_.model.sets, nodes,
                                              [](const model::Set& set) { return mesh::nodes_of(set.facets); });
            return at == failed_.model.sets.end() ? std::string() : at->name;
        };
        const std::string slave = named(pair.slaves().node), master = named(pair.master_nodes());
        if (slave.empty() || master.empty()) return {};
        const std::string key = "contact." + pair.name();
        return {key + ".slave=" + master, key + ".master.set=" + slave};
    }

    /// What the audit found.
    void inside(const contact::Intrusion& intrusion) {
        const model::Model& model = failed_.model;
        const auto name = [&](Index body) { return model.bodies[static_cast<std::size_t>(body)].name; };
        const std::string &body = name(intrusion.body), &other = name(intrusion.other);
        const auto joins = [&](const auto& pair) {
            const std::string &slave = body_of(model, pair->slaves().node.front())->name,
                              &master = body_of(model, pair->master_nodes().front())->name;
            return (slave == body && master == other) || (slave == other && master == body);
        };
        const auto pair = std::ranges::find_if(model.pairs, joins);
        const bool general = model.general && model.general->meet(intrusion.body, intrusion.other);
        if (!general && (intrusion.body == intrusion.other || pair == model.pairs.end())) {
            const std::string who = intrusion.body == intrusion.other
                                        ? "'" + body + "' from going through itself where its mesh resolves the folds"
                                        : "'" + body + "' and '" + other + "' apart";
            add("contact.general", "{}, which keeps " + who + ": no pair does", {"contact.general={}"});
        } else if (pair == model.pairs.end()) {
            found_.no_remedy = "general contact sees nodes against facets, and no node of '" + body + "' or '" + other +
                               "' met one here; a finer mesh of either may help";
        } else {
            const model::ContactPair& one = **pair;
            const std::vector<Index>& slaves = one.slaves().node;
            const bool known = std::ranges::count(slaves, intrusion.node) > 0;
            if (averages(one.options().discretisation)) by_nodes(one);
            if (intrusion.edge || intrusion.facet)
                edges_cross(one, intrusion);
            else if (!known)
                add("contact." + one.name() + ".slave",
                    "the other side, or a surface that contains node " + std::to_string(found_.node) + " of body '" +
                        found_.body +
                        "', which is not a slave node: contact keeps only slave nodes out of the other body",
                    std::ranges::count(one.master_nodes(), intrusion.node) > 0 ? sides_swapped(one)
                                                                               : std::vector<std::string>{});
            constexpr double in_dynamics = 0.05; // the default there
            if (const time::StepLimits& limits = failed_.stage.limits;
                known && (limits.in_metres || limits.allowed_interpenetration > in_dynamics))
                change(in_stage("control.allowed_interpenetration"), number(in_dynamics),
                       number(in_dynamics) + ", so that no node passes through a surface");
        }
    }

    /// Contact knows nodes against facets, so that one of them must come to lie on a facet soon enough.
    void edges_cross(const model::ContactPair& pair, const contact::Intrusion& intrusion) {
        const std::string &slave = body_of(failed_.model, pair.slaves().node.front())->name,
                          &master = body_of(failed_.model, pair.master_nodes().front())->name;
        // two edges at right angles: one that is d deep lies inside the other's body over a length of about 2 d
        const double apart = 2 * failed_.stage.limits.audited_depth * intrusion.length;
        add("bodies." + slave + ".mesh",
            "slave nodes at most " + rounded(apart) + " m apart along its edges, and the mesh of '" + master +
                "' unchanged: contact sees nodes against facets, not edges against edges between their nodes, and with "
                "this spacing a node meets a facet before the edge is too deep");
    }

    void far() {
        const model::ContactPair& pair = *failed_.last.contact[static_cast<std::size_t>(failed_.decision.pair)].pair;
        smaller_steps("nodes then move over fewer facets in a step");
        change(surface_key(pair), "facets", "facets, whose gaps are those of the mesh itself");
        if (averages(pair.options().discretisation))
            change(key_of(pair) + ".discretisation", "node", "node: the force then acts where the gap is");
    }

    void time_error() {
        const std::string key = in_stage("control.error_tolerance");
        change(key, rounded(margin * failed_.decision.value) + " m",
               "above " + number(failed_.decision.value) + " m instead of " +
                   number(failed_.stage.limits.error_tolerance) + " m");
        constexpr double least = 1e-3; // the error is there in every step
        steps_smaller_by(std::cbrt(failed_.stage.limits.error_tolerance / failed_.decision.value), least,
                         "the error falls with the third power of the step");
    }

    void energy() {
        const std::string key = in_stage("control.energy_tolerance");
        change(key, rounded(margin * failed_.decision.value),
               "above " + number(failed_.decision.value) + " instead of " +
                   number(failed_.stage.limits.energy_tolerance));
        if (massless())
            change(in_stage("analysis.dynamic.contact_mass"), "kept",
                   "kept: contact nodes with mass lose energy when they touch, and contact adds less when it opens");
        constexpr double least = 1e-4;
        steps_smaller_by(failed_.stage.limits.energy_tolerance / failed_.decision.value, least,
                         "with smaller steps, contact adds less energy when it opens");
    }

    /// Whether there are contact nodes without mass.
    [[nodiscard]] bool massless() const {
        const linear::BlockMatrix& M = failed_.model.mass(failed_.stage.dynamics->lumped_mass);
        if (M.empty()) return false;
        const Field diagonal = M.diagonal();
        const auto none = [&](Index node) { // nodes of skins have no mass of their own, and no row
            return model::material_node(failed_.model, node) == node &&
                   diagonal[static_cast<std::size_t>(node)].x() == 0;
        };
        return std::ranges::any_of(failed_.last.contact, [&](const model::ContactHistory& one) {
            return std::ranges::any_of(one.pair->slaves().node, none);
        });
    }

    PostMortem& found_;
    const FailedAttempt& failed_;
    std::string stage_;
};

/// Of a load or a motion without a value.
void advise_on_load(PostMortem& found) {
    const auto& [course, elapsed, duration] = *found.missing_load;
    std::string key = course; // components of a body force have no key of their own
    for (const char* vector : {"body_force.", "nodal_force.", "force.", "moment."})
        if (key.starts_with(vector)) key = key.substr(0, key.rfind('.'));
    found.advice.push_back({"stages." + found.stage + "." + key,
                            "give it a finite value at every time from 0 to " + number(duration) +
                                " s after the stage's start; at " + number(elapsed) +
                                " s it has none. Move a pole of the expression out of the stage, or use a table"});
}

} // namespace

PostMortem advised(PostMortem found, const time::FailedIterate* iterate) {
    const WithoutTraps nan; // values of failed solves are compared
    if (iterate != nullptr)
        Adviser(found, iterate->attempt).advise();
    else if (found.missing_load)
        advise_on_load(found);
    return found;
}

} // namespace osculate::app
