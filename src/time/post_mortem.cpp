#include "osculate/time/post_mortem.hpp"

#include "time/body_hold.hpp"
#include "time/number.hpp"

#include <algorithm>
#include <functional>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>

namespace osculate::time {

using contact::Status;
using model::Body;
using model::body_of;
using model::ContactPair;

namespace {

/// First pair of which a node is a slave, and as which; -1 none.
std::pair<Index, Index> slave_of(const std::vector<model::ContactHistory>& contact, Index node) {
    for (std::size_t p = 0; p < contact.size(); ++p) {
        const std::vector<Index>& slaves = contact[p].pair->slaves().node;
        if (const auto at = std::ranges::find(slaves, node); at != slaves.end())
            return {static_cast<Index>(p), static_cast<Index>(at - slaves.begin())};
    }
    return {-1, -1};
}

ContactPlace place(const model::Model& model, const model::ContactEvaluation& evaluation, Index j, Status status) {
    const ContactPair& pair = evaluation.pair();
    ContactPlace where;
    where.pair = pair.name();
    where.status = status;
    const Body* const master = body_of(model, pair.master_nodes().front());
    where.master_body = master->name;
    const contact::ContactPoint& point = evaluation.point(j);
    if (!point.found && !point.behind) return where;
    where.gap = point.gap;
    where.master_facet = point.found ? point.facet : evaluation.facets()[j];
    if (where.master_facet < 0) return where;
    const mesh::Facet& facet = pair.surface().facets()[where.master_facet];
    for (int c = 0; c < facet.count; ++c)
        if (facet.nodes[c] < model.nodes())
            where.facet_nodes.push_back(material_node(model, facet.nodes[c]) - master->first_node);
    return where;
}

/// Nodes whose statuses changed, those that did most often first.
std::vector<StatusChanges> changes_of(const model::Model& model, const std::vector<model::ContactHistory>& contact,
                                      const std::vector<equilibrium::Statuses>& recent) {
    std::vector<StatusChanges> all;
    for (std::size_t p = 0; p < contact.size() && !recent.empty(); ++p) {
        const ContactPair& pair = *contact[p].pair;
        for (Index j = 0; j < pair.size(); ++j) {
            StatusChanges one;
            for (const equilibrium::Statuses& statuses : recent)
                if (one.sequence.empty() || one.sequence.back() != statuses[p][j])
                    one.sequence.push_back(statuses[p][j]);
            if (one.sequence.size() < 2) continue;
            const Index node = pair.slaves().node[j];
            const Body& body = *body_of(model, node);
            one.pair = pair.name();
            one.body = body.name;
            one.node = material_node(model, node) - body.first_node;
            all.push_back(std::move(one));
        }
    }
    std::ranges::stable_sort(all, std::greater{}, [](const StatusChanges& one) { return one.sequence.size(); });
    return all;
}

Cause cause_of_solve(const FailedAttempt& failed, const PostMortem& found) {
    if (found.element) return Cause::inside_out;
    using solve::KinsolOutcome;
    if (failed.result.outcome == KinsolOutcome::not_finite) return Cause::not_finite;
    if (failed.result.adrift >= 0) return Cause::unsupported_body;
    // contact at an iterate that ran away says nothing of what holds the bodies
    if (failed.result.astray) return Cause::diverged;
    if (loose_body(failed, found) != nullptr) return Cause::unsupported_body;
    if (std::ranges::any_of(found.bodies, thrown_off)) return Cause::diverged;
    switch (failed.result.outcome) {
    case KinsolOutcome::singular: return Cause::singular_tangent;
    case KinsolOutcome::unsolved: return Cause::linear_system;
    case KinsolOutcome::stopped: return found.changing > 0 ? Cause::status_cycle : Cause::stalled;
    case KinsolOutcome::no_descent: return Cause::no_descent;
    case KinsolOutcome::not_evaluable: return Cause::not_evaluable;
    default: return Cause::iterations_exhausted;
    }
}

Cause cause_of_decision(const FailedAttempt& failed, const PostMortem& found) {
    switch (failed.decision.reason) {
    case Reason::interpenetration: return failed.decision.unseen ? Cause::unseen_contact : Cause::interpenetration;
    case Reason::collision: return Cause::collision;
    case Reason::audit: return Cause::unseen_contact;
    case Reason::distance: return Cause::far_contact;
    case Reason::error: return Cause::time_error;
    case Reason::energy: return Cause::energy;
    default: return cause_of_solve(failed, found);
    }
}

/// Body and node: those of the attempt, else of what changed in the contact, else where forces are least in balance.
void find_place(const FailedAttempt& failed, const equilibrium::Equilibrium& equilibrium, PostMortem& found) {
    const Attempt& attempt = failed.attempts.back();
    found.body = attempt.body;
    found.node = attempt.node;
    if (found.body.empty() && !found.changes.empty()) {
        found.body = found.changes.front().body;
        found.node = found.changes.front().node;
    } else if (found.body.empty()) {
        Attempt worst;
        name_node(failed.model, equilibrium.worst_node(), worst);
        found.body = worst.body;
        found.node = worst.node;
    }
    if (failed.result.adrift >= 0) return;
    const BodyHold* loose = nullptr;
    if (found.cause == Cause::unsupported_body) loose = loose_body(failed, found);
    if (const auto thrown = std::ranges::find_if(found.bodies, thrown_off);
        found.cause == Cause::diverged && thrown != found.bodies.end())
        loose = &*thrown;
    if (loose != nullptr && loose->body != found.body) {
        found.body = loose->body;
        found.node = -1;
    }
}

Index global_node(const model::Model& model, const std::string& body, Index node) {
    for (const Body& one : model.bodies)
        if (one.name == body && node >= 0) return one.first_node + node;
    return -1;
}

} // namespace

void name_node(const model::Model& model, Index node, Attempt& attempt) {
    if (const Body* const body = body_of(model, node); body != nullptr) {
        attempt.body = body->name;
        attempt.node = material_node(model, node) - body->first_node;
    } else if (const model::RigidBody* rigid =
                   model::rigid_body_of(model, node)) { // of no mesh: the first that follows
        attempt.body = model.bodies[static_cast<std::size_t>(rigid->body)].name;
        attempt.node = rigid->nodes.front() - model.bodies[static_cast<std::size_t>(rigid->body)].first_node;
    }
}

std::string explain(const model::Model& model, const LadderResult& result, const equilibrium::Equilibrium& equilibrium,
                    Attempt& attempt) {
    Index node = result.adrift >= 0 ? result.adrift : equilibrium.worst_node();
    if (result.failing_equation >= 0 && result.adrift < 0)
        for (Index i = 0; i < model.nodes(); ++i)
            for (int k = 0; k < 3; ++k)
                if (equilibrium.constraints().equation(i, k) == result.failing_equation) node = i;
    std::ostringstream text;
    if (const model::WorstElement& worst = result.worst_element; !worst.admissible()) {
        const Body& body = model.bodies[static_cast<std::size_t>(worst.body)];
        attempt.body = body.name;
        attempt.value = worst.J;
        text << result.rung << ": element " << worst.element << " of body '" << body.name
             << "' is turned inside out, det F = " << worst.J
             << "; smaller steps, a finer mesh or a material that resists compression (neo_hookean) may help";
        return text.str();
    }
    name_node(model, node, attempt);
    attempt.value = result.residual;
    if (result.adrift >= 0) {
        text << "body '" << attempt.body << "' is held by nothing: its loads moved node " << attempt.node << " by "
             << result.travelled << " m and it met no support";
        return text.str();
    }
    text << result.rung << ": " << solve::describe(result.outcome) << " after " << result.iterations
         << " iterations, relative residual " << result.residual;
    if (!attempt.body.empty()) text << ", worst at node " << attempt.node << " of body '" << attempt.body << "'";
    switch (result.outcome) {
    case solve::KinsolOutcome::singular:
        text << (result.astray ? "; the iterates ran away"
                               : "; a body is held by nothing: add a support, or check that it touches another at "
                                 "the start. Or both sides of a contact are held");
        break;
    case solve::KinsolOutcome::unsolved:
        text << "; a body is almost free to move, or far stiffer than what it touches, and the tangent is too large to "
                "be factorised instead";
        break;
    case solve::KinsolOutcome::stopped:
        text << (equilibrium.contact().empty()
                     ? "; the residual does not fall any more: smaller steps, or a smaller load, may help"
                     : "; contact statuses repeat in a cycle: smaller steps, or a finer master, may break it");
        break;
    case solve::KinsolOutcome::max_iterations:
        text << "; raise solver.max_iterations, or raise solver.tolerance if round-off keeps the residual where it is";
        break;
    default: break;
    }
    return text.str();
}

PostMortem examine(const FailedAttempt& failed, equilibrium::Equilibrium& equilibrium) {
    constexpr std::size_t most_changes = 12; // nodes listed
    const model::Model& model = failed.model;
    const Attempt& attempt = failed.attempts.back();
    const StepLimits& limits = failed.stage.limits;
    PostMortem found;
    found.stage = failed.stage.name;
    found.time = attempt.time;
    found.last_time = failed.last.time;
    found.dt = attempt.dt;
    found.smallest_dt = limits.dt_min;
    const bool hopeless = failed.result.adrift >= 0;
    found.limit = hopeless ? "no smaller step would help"
                  : attempt.dt <= limits.dt_min * (1 + same_step)
                      ? "the smallest step allowed"
                      : "repeated " + std::to_string(limits.most_repeats) + " times, the most allowed";
    found.attempts = failed.attempts;
    found.residual = failed.result.residual;
    found.rung = failed.result.rung;
    found.reference_force = failed.ladder.reference_force;
    found.iterations = equilibrium.records();
    std::vector<StatusChanges> changes = changes_of(model, failed.last.contact, equilibrium.recent_statuses());
    found.changing = static_cast<Index>(changes.size());
    changes.resize(std::min(changes.size(), most_changes));
    found.changes = std::move(changes);
    if (const model::WorstElement& worst = failed.result.worst_element;
        failed.decision.reason == Reason::solver && !worst.admissible())
        found.element = {model.bodies[static_cast<std::size_t>(worst.body)].name, worst.element, worst.J};

    const model::State state = equilibrium.state(failed.z);
    if (failed.z.allFinite()) { // contact points and forces at z: the last residual may have been beside it
        found.bodies = holds_before(failed);
        Vector F(failed.z.size());
        equilibrium.set_statuses(equilibrium.statuses(), equilibrium::StatusRule::frozen, false);
        (void)equilibrium.residual(failed.z, F);
        hold_now(failed, equilibrium, state, found.bodies);
    }
    found.cause = cause_of_decision(failed, found);
    find_place(failed, equilibrium, found);
    const Index node = global_node(model, found.body, found.node);
    if (node >= 0) {
        found.X = model.X[node] + model.origin;
        found.x = found.X + state.u[node];
        const Vec3& force = equilibrium.unbalanced()[node];
        found.out_of_balance = force - equilibrium.constraints().reaction(node, force);
    }
    auto [p, j] = slave_of(state.contact, node);
    if (failed.decision.pair >= 0) {
        p = failed.decision.pair;
        j = failed.decision.slave;
    } else if (p < 0 && found.cause == Cause::status_cycle) {
        const StatusChanges& first = found.changes.front();
        std::tie(p, j) = slave_of(state.contact, global_node(model, first.body, first.node));
    }
    if (p >= 0) found.contact = place(model, equilibrium.contact()[p], j, state.contact[p].status[j]);
    return found;
}

PostMortem examine(const LoadNotFinite& failure, const model::Model& model, const Stage& stage, double t_start,
                   double last_time) {
    PostMortem found;
    found.cause = Cause::load_not_finite;
    found.message = failure.what();
    found.stage = stage.name;
    found.time = t_start + failure.elapsed();
    found.last_time = last_time;
    found.dt = found.time - last_time;
    found.smallest_dt = stage.limits.dt_min;
    found.limit = "not cut: the value is missing at a time that must be reached";
    std::string key = failure.course(); // components of a body force have no key of their own
    bool of_body = key.starts_with("motion.");
    for (const char* vector : {"body_force.", "force.", "moment."})
        if (key.starts_with(vector)) {
            key = key.substr(0, key.rfind('.'));
            of_body = true;
        }
    const std::size_t from = key.find('.') + 1; // kind.set or kind.set.component, set or body
    const std::string loaded = key.substr(from, key.find('.', from) - from);
    for (const Body& body : model.bodies)
        if (body.name == loaded) found.body = body.name;
    for (const model::Set& set : model.sets)
        if (set.name == loaded && !of_body) found.body = model.bodies[static_cast<std::size_t>(set.body)].name;
    found.missing_load = {failure.course(), failure.elapsed(), stage.duration};
    return found;
}

} // namespace osculate::time
