/// What to change after a failure. Every piece names a key of the scene.

#include "osculate/time/post_mortem.hpp"
#include "time/body_hold.hpp"
#include "time/number.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::time {

namespace {

/// Gathers advice for one failure.
class Adviser {
public:
    Adviser(const PostMortem& found, const FailedAttempt& failed)
        : found_(found), failed_(failed), stage_("stages." + failed.stage.name) {}

    std::vector<Advice> take() {
        switch (found_.cause) {
        case Cause::unsupported_body: unsupported(); break;
        case Cause::singular_tangent: contradiction(); break;
        case Cause::linear_system:
            add("solver.linear_solver",
                "iterative instead of multigrid, where there is memory for the bodies' factors");
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
        case Cause::time_error: time_error(); break;
        case Cause::energy: energy(); break;
        case Cause::load_not_finite: break;
        }
        return std::move(list_);
    }

private:
    void add(std::string key, std::string text) { list_.push_back({std::move(key), std::move(text)}); }
    [[nodiscard]] std::string in_stage(const std::string& key) const { return stage_ + "." + key; }
    [[nodiscard]] const model::ContactTerm* pair(const std::string& name) const {
        for (const auto& one : failed_.model.pairs)
            if (one->name() == name) return one.get();
        return nullptr;
    }
    [[nodiscard]] double whole_step() const { return failed_.stage.duration / failed_.stage.steps; }

    /// More cuts, where that is what was missing; more steps otherwise.
    void smaller_steps(const std::string& why) {
        const double smallest = found_.smallest_dt / whole_step();
        if (found_.dt <= found_.smallest_dt * (1 + 1e-6))
            add("solver.smallest_step", number(smallest / 100) + " instead of " + number(smallest) +
                                            ", so that the step may be cut further: " + why);
        add(in_stage("steps"), number(4 * failed_.stage.steps) + " instead of " + number(failed_.stage.steps) +
                                   ", so that every step asks for less");
    }

    static std::string listed(const std::vector<std::string>& words) {
        std::string text;
        for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
        return text;
    }

    void unsupported() {
        const auto at = std::ranges::find(found_.bodies, found_.body, &BodyHold::body);
        if (at == found_.bodies.end()) return;
        const BodyHold& loose = *at;
        const std::string ways = loose.free_motions.empty()
                                     ? "free in " + std::to_string(loose.free_by_supports) + " ways but for contact"
                                     : "free " + listed(loose.free_motions);
        add("supports",
            "hold body '" + loose.body + "', which is " + ways + ": a set of it with fix, or a symmetry plane");
        const bool adrift = failed_.result.adrift >= 0;
        if (loose.in_pair && loose.pressed == 0 && (loose.touching + loose.touched > 0 || adrift)) {
            const std::string how = loose.touching > 0
                                        ? "contact would have to pull at " + std::to_string(loose.touching) + " nodes"
                                    : loose.touched > 0 ? "it touched at " + std::to_string(loose.touched) +
                                                              " nodes at the last good time, and contact cannot pull"
                                                        : "no support lies on its way";
            add(stage_, "what is done to body '" + loose.body + "' here pulls it off (" + how +
                            "): reverse or reduce the load, or lead the body by a displacement instead of a load");
        }
        constexpr double apart = 1e-6; // facets
        if (loose.in_pair && loose.touching + loose.touched == 0 && !loose.nearest_pair.empty() &&
            loose.nearest_gap > apart * loose.facet) {
            add(in_stage("displacement"),
                "lead the body until it touches, instead of loading it: its nearest slave node "
                "is " +
                    number(loose.nearest_gap) + " m away");
            if (failed_.ladder.stabilisation.share == nullptr)
                add("solver.stabilisation", "true, so that the body's load may lead it until it meets something");
            else if (loose.nearest_gap < loose.facet && !adrift) // else the load does not lead there
                add("contact." + loose.nearest_pair + ".closing_tolerance",
                    "above " + number(loose.nearest_gap / loose.facet) +
                        ", so that nodes this close count as touching in the first solve");
        }
        if (loose.pressed > 0)
            for (const auto& one : failed_.model.pairs)
                if (one->name() == loose.nearest_pair && one->options().friction == 0)
                    add("contact." + one->name() + ".friction",
                        "above 0 where the surfaces are not smooth: without friction contact holds the body along its "
                        "normals only");
        add(in_stage("analysis"),
            "dynamic, if body '" + loose.body +
                "' is really meant to move freely: inertia carries it then, and every body needs a "
                "density");
    }

    void contradiction() {
        add("supports",
            "look for parts that are held or driven on both sides of a contact: where neither side can move, "
            "no force and no gap is determined");
        add(in_stage("displacement"),
            "drive a part of the body that is not itself in contact, so that what touches can "
            "deform");
        if (found_.contact)
            add("contact." + found_.contact->pair + ".slave", "leave out nodes that are held or driven");
    }

    void diverged() {
        smaller_steps("Newton starts nearer to the solution");
        add(stage_,
            "less load than at " + number(found_.last_time) +
                " s, the last equilibrium, or a displacement instead of the load: a body that gives way under a "
                "load can be led past that point");
        if (!failed_.stage.dynamics)
            add(in_stage("analysis"),
                "dynamic: inertia carries the bodies from one equilibrium to the next, and every body needs a density");
        if (!found_.body.empty() && !failed_.model.finite_strain)
            add("bodies." + found_.body + ".material", "neo_hookean, which stiffens as it is compressed: under loads "
                                                       "near its modulus a linear one is not true");
    }

    /// Where the residual is so near the tolerance that round-off rather than the contact may hold it there.
    void larger_tolerance() {
        constexpr double near = 100; // times the tolerance
        if (found_.residual < near * failed_.ladder.tolerance)
            add("solver.tolerance", "above " + number(found_.residual) + " instead of " +
                                        number(failed_.ladder.tolerance) + ": the residual rests at round-off there");
    }

    void cycle() {
        larger_tolerance();
        smaller_steps("fewer nodes change their status at once");
        const model::ContactTerm* const one = found_.contact ? pair(found_.contact->pair) : nullptr;
        if (one == nullptr) return;
        if (one->options().friction > 0.3)
            add("contact." + one->name() + ".friction",
                "below " + number(one->options().friction) +
                    ", if only for a test: high friction makes stick and slip alternate");
        add("contact." + one->name() + ".master.surface",
            "blend, where it is facets or rpim: normals that jump at edges send nodes to and fro");
        add("bodies." + found_.body + ".mesh",
            "finer where the nodes listed lie: few nodes decide over all of the contact");
    }

    void iterations() {
        const std::size_t n = found_.iterations.size();
        const double last = found_.residual, before = n > 1 ? found_.iterations[n - 2].residual : last;
        const double now = n > 0 ? found_.iterations[n - 1].residual : last;
        const int most = failed_.ladder.max_iterations;
        constexpr double near = 100; // times the tolerance: round-off rather than a lack of iterations
        constexpr int usual = 30;
        if (last < near * failed_.ladder.tolerance && !(now < 0.5 * before))
            add("solver.tolerance", "above " + number(last) + " instead of " + number(failed_.ladder.tolerance) +
                                        ": the residual rests at round-off there");
        if (now < 0.5 * before || most < usual)
            add("solver.max_iterations", number(std::max(usual, 2 * most)) + " instead of " + number(most) +
                                             (now < 0.5 * before ? ": the residual was still falling" : ""));
        else
            smaller_steps("the residual did not fall any more, so that iterations alone would not help");
        if (most < usual) return;
        if (found_.contact)
            add("contact." + found_.contact->pair + ".master.surface",
                "blend, where it is facets or rpim: Newton likes normals that do not jump");
    }

    void stall() {
        smaller_steps("Newton starts nearer to the solution");
        larger_tolerance();
        if (found_.contact)
            add("contact." + found_.contact->pair + ".friction",
                "lower, if only for a test whether friction is to blame");
    }

    void not_finite() {
        add(stage_, "loads and motions of an ordinary size: forces or displacements overflow");
        smaller_steps("a number overflowed within the step");
    }

    void inside_out() {
        if (!found_.element) return;
        smaller_steps("elements bear a little compression at a time");
        add("bodies." + found_.element->body + ".material",
            "neo_hookean, if it is saint_venant_kirchhoff, which gives way under strong compression");
        add(stage_,
            "a smaller load or motion on body '" + found_.element->body + "', if it cannot stand this one at all");
        add("bodies." + found_.element->body + ".mesh", "a mesh without thin or skewed elements there");
    }

    void too_deep() {
        const StepLimits& limits = failed_.stage.limits;
        smaller_steps("the node moves a shorter way in it");
        if (found_.cause == Cause::interpenetration) {
            const std::string unit = limits.in_metres ? " m" : " (of the facet size)";
            add(in_stage("control.allowed_interpenetration"), "more than " + number(limits.allowed_interpenetration) +
                                                                  unit + ", if a trial gap of " +
                                                                  number(failed_.decision.value) + " m does no harm");
        }
    }

    void unseen() {
        if (failed_.decision.intrusion) return inside(*failed_.decision.intrusion);
        const model::ContactTerm& one = *failed_.model.pairs[static_cast<std::size_t>(failed_.decision.pair)];
        add("contact." + one.name() + ".discretisation",
            "node: averages over facets know neither edges against edges nor vertices");
        add("contact." + one.name() + ".slave",
            "the side with the finer mesh, if only an edge of the coarser one is unseen");
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
        if (intrusion.body == intrusion.other) {
            add("contact", "body '" + body +
                               "' meets itself, and no contact of a body with itself is modelled: loads and "
                               "motions must stop before");
        } else if (pair == model.pairs.end()) {
            add("contact", "a pair of surfaces of '" + body + "' and '" + other +
                               "' that hold the place: no pair keeps these bodies apart");
        } else {
            const model::ContactTerm& one = **pair;
            const std::vector<Index>& slaves = one.slaves().node;
            const bool known = std::ranges::count(slaves, intrusion.node) > 0;
            if (one.options().discretisation == model::Discretisation::mortar)
                add("contact." + one.name() + ".discretisation",
                    "node: averages over facets know neither edges against edges nor vertices");
            if (!known)
                add("contact." + one.name() + ".slave",
                    "the other side, or surfaces that hold node " + std::to_string(found_.node) + " of body '" +
                        found_.body + "', which is no slave node: only slave nodes are kept out of the other body");
            if (intrusion.edge)
                add("bodies." + body + ".mesh",
                    "nodes where the edges meet: contact knows nodes against facets, not edges "
                    "against edges between their nodes");
            if (failed_.stage.limits.allowed_interpenetration > 0.05)
                add(in_stage("control.allowed_interpenetration"), "0.05, so that no node is carried past a surface");
        }
        add("solver.audit", "off, if the bodies may lie inside one another there: the summary says that nobody looked");
    }

    void time_error() {
        add(in_stage("control.error_tolerance"), "above " + number(failed_.decision.value) + " m instead of " +
                                                     number(failed_.stage.limits.error_tolerance) + " m");
        smaller_steps("the error falls with the third power of the step");
    }

    void energy() {
        add(in_stage("control.energy_tolerance"),
            "above " + number(failed_.decision.value) + " instead of " + number(failed_.stage.limits.energy_tolerance));
        add(in_stage("analysis.dynamic.contact_mass"),
            "redistributed, if it is kept: contact nodes without mass neither add nor eat energy");
        smaller_steps("what a release feeds into the energy falls with the step");
    }

    const PostMortem& found_;
    const FailedAttempt& failed_;
    std::string stage_;
    std::vector<Advice> list_;
};

} // namespace

std::vector<Advice> advise(const PostMortem& found, const FailedAttempt& failed) {
    return Adviser(found, failed).take();
}

} // namespace osculate::time
