#include "osculate/equilibrium/coupling_start.hpp"

#include "osculate/core/dense_algebra.hpp"

#include <algorithm>

namespace osculate::equilibrium {

using model::cross_matrix;
using model::RigidBody;

namespace {
std::size_t place_of(Index node) {
    return static_cast<std::size_t>(node);
}

/// Calls f(coupling, its motion) for every coupling of a state.
template <class State, class F> void for_each_coupling(const model::Model& model, State& state, F&& f) {
    for (std::size_t k = 0; k < model.rigid.size(); ++k)
        if (model.rigid[k].coupling) f(model.rigid[k], state.rigid[k]);
}

/// Arm of a node now, from the reference point.
Vec3 arm(const model::Model& model, const RigidBody& body, const model::RigidMotion& motion, Index node) {
    return motion.orientation * (model.X[place_of(node)] - model.X[place_of(body.reference)]);
}
} // namespace

linear::Dependence coupled_nodes(const model::Model& model, const model::State& state) {
    linear::Dependence dependence(model.nodes());
    for_each_coupling(model, state, [&](const RigidBody& body, const model::RigidMotion& motion) {
        for (const Index node : body.nodes) {
            const Mat3 rho = cross_matrix(arm(model, body, motion, node)) / body.radius;
            dependence.set(node, {{body.reference}, {body.rotation(), -rho, rho}});
        }
    });
    add_ties(model, dependence);
    return dependence;
}

namespace {
void add_equations(const model::Model& model, linear::Dependence& dependence) {
    std::vector<model::LedNode> led = model.led;
    std::ranges::stable_sort(led, {}, &model::LedNode::node);
    for (std::size_t first = 0, end = 0; first < led.size(); first = end) {
        const Index node = led[first].node;
        std::vector<linear::Dependence::Carrier> carriers;
        Mat3 keeps = Mat3::Identity();
        for (end = first; end < led.size() && led[end].node == node; ++end) {
            const Vec3& d = led[end].direction;
            keeps -= d * d.transpose();
            for (const auto& [other, by] : led[end].by) {
                const auto at = std::ranges::find(carriers, other, &linear::Dependence::Carrier::node);
                linear::Dependence::Carrier& carrier =
                    at != carriers.end()
                        ? *at
                        : carriers.emplace_back(linear::Dependence::Carrier{other, Mat3::Zero(), Mat3::Zero()});
                carrier.moves += d * by.transpose();
                carrier.loads += by * d.transpose();
            }
        }
        constexpr double round_off = 1e-9;
        if (end - first == 3 || keeps.norm() < round_off) keeps.setZero();
        dependence.set(node, std::move(carriers), Mat3::Zero(), keeps);
    }
}
} // namespace

void add_ties(const model::Model& model, linear::Dependence& dependence) {
    add_equations(model, dependence);
    using Carriers = std::vector<linear::Dependence::Carrier>;
    const auto add_one = [](Carriers& carriers, Index node, const Mat3& share) {
        const auto at = std::ranges::find(carriers, node, &linear::Dependence::Carrier::node);
        linear::Dependence::Carrier& carrier =
            at != carriers.end() ? *at
                                 : carriers.emplace_back(linear::Dependence::Carrier{node, Mat3::Zero(), Mat3::Zero()});
        carrier.moves += share;
        carrier.loads += share.transpose();
    };
    // what is at an end of a sector follows what is at the other, what an equation leads what leads it
    const auto add = [&](Carriers& carriers, Index node, const Mat3& share) {
        if (dependence.owns(node)) add_one(carriers, node, share * dependence.keeps(node));
        if (!dependence.depends(node)) return;
        for (const linear::Dependence::Carrier& like : dependence.carriers(node))
            add_one(carriers, like.node, share * like.moves);
    };
    for (const model::CyclicSymmetry& ring : model.cyclic)
        for (const model::LikeNode& one : ring.nodes) {
            Carriers carriers;
            add(carriers, one.like, one.free * ring.turn);
            dependence.set(one.node, std::move(carriers), Mat3::Identity() - one.free);
        }
    for (const model::Tie& tie : model.ties)
        for (const model::TiedNode& tied : tie.nodes) {
            Carriers carriers;
            for (const auto& [node, weight] : tied.carriers) add(carriers, node, weight * tied.free);
            dependence.set(tied.node, std::move(carriers), Mat3::Identity() - tied.free);
        }
    for (const model::SkinNode& one : model.skin) {
        Carriers carriers;
        for (const auto& [node, weight] : one.carriers)
            add(carriers, node,
                node == one.host ? Mat3(weight * one.free + Mat3::Identity() - one.free) : Mat3(weight * one.free));
        dependence.set(one.node, std::move(carriers));
    }
}

void start_couplings(const model::Model& model, const linear::Constraints& constraints, model::State& state) {
    for_each_coupling(model, state, [&](const RigidBody& body, model::RigidMotion& motion) {
        // v_i = v_r + w x rho_i, w in units of 1/radius
        Matrix rows(3 * static_cast<Index>(body.nodes.size()), 6);
        Vector v(rows.rows());
        for (std::size_t i = 0; i < body.nodes.size(); ++i) {
            const auto at = 3 * static_cast<Index>(i);
            rows.middleRows<3>(at) << Mat3::Identity(),
                -cross_matrix(arm(model, body, motion, body.nodes[i])) / body.radius;
            v.segment<3>(at) = state.v[place_of(body.nodes[i])];
        }
        const Vector fit = least_squares(rows, v); // the smallest
        const auto less_held = [&](Index node, const Vec3& free) {
            Vec3 local = constraints.to_local(node, free);
            for (int k = 0; k < 3; ++k)
                if (const auto* c = constraints.constraint(node, k); c != nullptr && !c->driven) local(k) = 0;
            return constraints.to_global(node, local);
        };
        motion.velocity = less_held(body.reference, fit.head<3>());
        const Vec3 spin = less_held(body.rotation(), fit.tail<3>()) / body.radius;
        motion.angular_velocity = motion.orientation.inverse() * spin;
        for (const Index node : body.nodes)
            state.v[place_of(node)] = motion.velocity + spin.cross(arm(model, body, motion, node));
        state.v[place_of(body.reference)] = motion.velocity;
        state.v[place_of(body.rotation())] = body.radius * spin;
    });
}

Field centripetal(const model::Model& model, const model::State& state) {
    Field a(model.X.size());
    for_each_coupling(model, state, [&](const RigidBody& body, const model::RigidMotion& motion) {
        const Vec3 w = model::spin(motion);
        for (const Index node : body.nodes) a[place_of(node)] = w.cross(w.cross(arm(model, body, motion, node)));
    });
    return a;
}

void take_accelerations(const model::Model& model, model::State& state) {
    for_each_coupling(model, state, [&](const RigidBody& body, model::RigidMotion& motion) {
        motion.acceleration = state.a[place_of(body.reference)];
        motion.angular_rate = motion.orientation.inverse() * Vec3(state.a[place_of(body.rotation())] / body.radius);
    });
}

} // namespace osculate::equilibrium
