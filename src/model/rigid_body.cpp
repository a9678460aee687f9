#include "osculate/model/rigid_body.hpp"

#include "osculate/core/dense_algebra.hpp"
#include "osculate/model/model.hpp"

#include <algorithm>
#include <numeric>

namespace osculate::model {

Vec3 spin(const RigidMotion& motion) {
    return motion.orientation * motion.angular_velocity;
}

Vec3 angular_momentum(const RigidBody& body, const RigidMotion& motion) {
    return motion.orientation * (body.inertia * motion.angular_velocity);
}

Vec3 centre_now(const Model& model, const RigidBody& body, const State& state) {
    const Vec3 &X = model.X[static_cast<std::size_t>(body.reference)],
               &u = state.u[static_cast<std::size_t>(body.reference)];
    const auto k = static_cast<std::size_t>(&body - model.rigid.data());
    return body.centre + u + turned_by(state.rigid[k].orientation, body.centre - X);
}

RigidMomenta rigid_momenta(const Model& model, const State& state) {
    RigidMomenta sum;
    for (std::size_t k = 0; k < model.rigid.size(); ++k) {
        const RigidBody& body = model.rigid[k];
        const RigidMotion& motion = state.rigid[k];
        const Vec3 p = body.mass * motion.velocity, &W = motion.angular_velocity;
        sum.kinetic += (motion.velocity.dot(p) + W.dot(body.inertia * W)) / 2;
        sum.linear += p;
        sum.angular += centre_now(model, body, state).cross(p) + angular_momentum(body, motion);
    }
    return sum;
}

void spread_velocities(const Model& model, const RigidBody& body, const RigidMotion& motion, State& state) {
    const Vec3 w = spin(motion), rate = motion.orientation * motion.angular_rate;
    const auto r = static_cast<std::size_t>(body.reference);
    const auto set = [&](std::size_t node, const Vec3& X) {
        const Vec3 arm = motion.orientation * (X - body.centre); // from the centre
        state.v[node] = motion.velocity + w.cross(arm);
        state.a[node] = motion.acceleration + rate.cross(arm) + w.cross(w.cross(arm));
    };
    if (!body.coupling) // whose nodes have mass, and velocities of their own
        for (const Index i : body.nodes) set(static_cast<std::size_t>(i), model.X[static_cast<std::size_t>(i)]);
    set(r, model.X[r]);
    state.v[r + 1] = body.radius * w;
    state.a[r + 1] = body.radius * rate;
}

void spread_displacements(const Model& model, const RigidBody& body, const Quaternion& orientation, Field& u) {
    const auto r = static_cast<std::size_t>(body.reference);
    for (const Index i : body.nodes) {
        const auto node = static_cast<std::size_t>(i);
        u[node] = u[r] + turned_by(orientation, model.X[node] - model.X[r]);
    }
}

const RigidBody* rigid_body_of(const Model& model, Index node) {
    const auto owns = [&](const RigidBody& body) {
        return (node >= body.reference && node <= body.rotation()) || std::ranges::binary_search(body.nodes, node);
    };
    const auto at = std::ranges::find_if(model.rigid, owns);
    return at == model.rigid.end() ? nullptr : &*at;
}

std::vector<double> weights_about(const std::vector<Vec3>& nodes, const Vec3& point) {
    const auto n = static_cast<Index>(nodes.size());
    Vec3 mean = Vec3::Zero();
    for (const Vec3& X : nodes) mean += X / static_cast<double>(n);
    double size = 0;
    for (const Vec3& X : nodes) size = std::max(size, (X - mean).norm());
    if (!(size > 0)) size = 1;
    // w_i = 1/n + b . (X_i - mean), sum_i w_i (X_i - mean) = point - mean
    Mat3 second = Mat3::Zero();
    for (const Vec3& X : nodes) second += (X - mean) * (X - mean).transpose() / (size * size);
    const Vec3 wanted = (point - mean) / size;
    const Vec3 b = least_squares(second, wanted);
    constexpr double fit = 1e-9;
    if ((second * b - wanted).norm() > fit) return {};
    std::vector<double> weights;
    for (const Vec3& X : nodes) weights.push_back(1.0 / static_cast<double>(n) + b.dot(X - mean) / size);
    return weights;
}

} // namespace osculate::model
