#include "time/body_hold.hpp"

#include "osculate/core/timing.hpp"
#include "osculate/model/rigid_motion.hpp"

#include <algorithm>
#include <limits>

namespace osculate::time {

using contact::Status;
using model::Body;
using model::body_of;
using model::ContactPair;

namespace {

bool takes_part(const model::Model& model, const ContactPair& pair, const Body& body) {
    return body_of(model, pair.slaves().node.front()) == &body || body_of(model, pair.master_nodes().front()) == &body;
}

/// Whether the loads of the attempt push a body against what it touched at the last accepted state.
bool is_pushed(const FailedAttempt& failed, const equilibrium::Equilibrium& equilibrium, const Body& body) {
    constexpr double mostly = 0.5; // cosine
    Vec3 load = Vec3::Zero(), contact = Vec3::Zero();
    const Field& external = equilibrium.external_force();
    for (Index node = 0; node < failed.model.nodes() && !external.empty(); ++node)
        if (body_of(failed.model, node) == &body) load += external[node];
    for (const model::RigidBody& rigid : failed.model.rigid)
        if (&failed.model.bodies[static_cast<std::size_t>(rigid.body)] == &body && !external.empty())
            load += external[rigid.reference];
    for (const model::ContactHistory& history : failed.last.contact) {
        const bool slave = body_of(failed.model, history.pair->slaves().node.front()) == &body,
                   master = body_of(failed.model, history.pair->master_nodes().front()) == &body;
        if (slave == master) continue;
        for (const Vec3& lambda : history.lambda) contact += slave ? lambda : Vec3(-lambda);
    }
    return load.dot(contact) < -mostly * load.norm() * contact.norm();
}

/// Whether a body that supports leave free in statics, where inertia holds nothing, is not held by contact either.
bool is_loose(const FailedAttempt& failed, const BodyHold& hold) {
    if (failed.stage.dynamics || hold.free_by_supports == 0) return false;
    if (hold.touching == 0) return !thrown_off(hold);
    switch (failed.result.outcome) {
    case solve::KinsolOutcome::singular:
    case solve::KinsolOutcome::unsolved: return hold.free_with_contact > 0;
    // at rest but for contact that would have to pull
    case solve::KinsolOutcome::stopped: return hold.pressed == 0 && failed.result.residual <= failed.ladder.tolerance;
    default: return false;
    }
}

} // namespace

std::vector<BodyHold> holds_before(const FailedAttempt& failed) {
    const model::Model& model = failed.model;
    Timings unused;
    const Field x = sum(model.X, failed.last.u);
    model::ContactEvaluations contact = model::contact_evaluations(model::pairs_of(failed.last.contact));
    for (std::size_t p = 0; p < contact.size(); ++p) {
        contact[p].begin_step(x, failed.last.contact[p], unused, 1);
        contact[p].evaluate(x, unused, 1);
    }
    std::vector<BodyHold> holds;
    for (const Body& body : model.bodies) {
        BodyHold& one = holds.emplace_back();
        one.body = body.name;
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < contact.size(); ++p) {
            const ContactPair& pair = contact[p].pair();
            if (!takes_part(model, pair, body)) continue;
            one.in_pair = true;
            one.touched += std::ranges::count_if(failed.last.contact[p].status, contact::is_closed);
            for (Index j = 0; j < pair.size(); ++j) {
                const contact::ContactPoint& point = contact[p].point(j);
                if (!point.found || point.gap >= nearest) continue;
                nearest = point.gap;
                one.nearest_pair = pair.name();
                one.nearest_gap = point.gap;
                one.facet = pair.surface().facet_size(point.facet);
            }
        }
    }
    return holds;
}

void hold_now(const FailedAttempt& failed, const equilibrium::Equilibrium& equilibrium, const model::State& state,
              std::vector<BodyHold>& holds) {
    const model::Model& model = failed.model;
    const linear::Constraints& constraints = equilibrium.constraints();
    const Field x = sum(model.X, state.u);
    const double round_off = failed.ladder.tolerance * failed.ladder.reference_force;
    std::vector<linear::NodeConstraint> all;
    for (Index node = 0; node < model.nodes() && !model.led.empty(); ++node)
        for (int k = 0; k < 3; ++k)
            if (const auto* c = constraints.constraint(node, k)) all.push_back(*c);
    const std::vector<char> joined = model::held_by_equations(model, all);
    for (std::size_t b = 0; b < holds.size(); ++b) {
        const Body& body = model.bodies[b];
        BodyHold& one = holds[b];
        model::RigidHold hold(body, x);
        for (Index node = body.first_node; node < body.first_node + body.nodes(); ++node)
            for (int k = 0; k < 3; ++k)
                if (constraints.constraint(node, k) != nullptr) hold.hold(x[node], constraints.frame(node).col(k));
        for (const model::RigidBody& rigid : model.rigid)
            if (rigid.body == static_cast<Index>(b))
                for (const Index node : {rigid.reference, rigid.rotation()})
                    for (int k = 0; k < 3; ++k)
                        if (const auto* c = constraints.constraint(node, k)) hold.hold(rigid, *c, x);
        one.free_by_supports = hold.free();
        one.pushed = is_pushed(failed, equilibrium, body);
        for (std::size_t p = 0; p < state.contact.size(); ++p) {
            const model::ContactEvaluation& evaluation = equilibrium.contact()[p];
            const ContactPair& pair = evaluation.pair();
            if (!takes_part(model, pair, body)) continue;
            for (Index j = 0; j < pair.size(); ++j) {
                const Status status = state.contact[p].status[j];
                if (!contact::is_closed(status) || !evaluation.point(j).found) continue;
                ++one.touching;
                one.pressed += state.contact[p].lambda[j].dot(evaluation.point(j).normal) >= -round_off;
                const Vec3& s = x[pair.slaves().node[j]];
                hold.hold(s, evaluation.point(j).normal);
                if (status == Status::stick)
                    for (int k = 0; k < 3; ++k) hold.hold(s, Vec3::Unit(k));
            }
        }
        one.free_with_contact = hold.free();
        one.free_motions = hold.free_motions();
        if (joined[b] != 0) {
            one.free_by_supports = one.free_with_contact = 0;
            one.free_motions.clear();
        }
    }
}

bool thrown_off(const BodyHold& hold) {
    return hold.free_by_supports > 0 && hold.touching == 0 && hold.touched > 0 && hold.pushed;
}

const BodyHold* loose_body(const FailedAttempt& failed, const PostMortem& found) {
    const BodyHold* loose = nullptr;
    for (const BodyHold& hold : found.bodies)
        if (is_loose(failed, hold) && (loose == nullptr || hold.free_with_contact > loose->free_with_contact))
            loose = &hold;
    return loose;
}

} // namespace osculate::time
