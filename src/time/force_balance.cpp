#include "osculate/time/force_balance.hpp"

#include "osculate/core/field.hpp"

#include <algorithm>

namespace osculate::time {

namespace {

/// Adds a pair's contact forces on nodes to f; their sum.
Vec3 add_contact(const model::ContactEvaluation& evaluation, const std::vector<Vec3>& lambda, Field& f) {
    Vec3 sum = Vec3::Zero();
    const auto add = [&](Index node, const Vec3& force) {
        f[static_cast<std::size_t>(node)] += force;
        sum += force;
    };
    for (Index j = 0; j < evaluation.pair().size(); ++j)
        if (const Vec3& force = lambda[static_cast<std::size_t>(j)]; !force.isZero(0))
            evaluation.for_each_force(j, force, add);
    return sum;
}

} // namespace

ForceBalance force_balance(const model::Model& model, const equilibrium::Equilibrium& equilibrium,
                           const model::State& state) {
    ForceBalance balance;
    Field contact(state.u.size());
    for (std::size_t p = 0; p < state.contact.size(); ++p) {
        const Vec3 sum = add_contact(equilibrium.contact()[p], state.contact[p].lambda, contact);
        if (!state.contact[p].pair->mirrored()) balance.left_over = std::max(balance.left_over, sum.norm());
    }
    for (const model::SkinNode& one : model.skin) // of the same body, and of its carriers together
        contact[static_cast<std::size_t>(one.host)] += contact[static_cast<std::size_t>(one.node)];
    const Field outer = equilibrium.bodies().outer_forces(state);
    const Field &load = equilibrium.external_force(), &unbalanced = equilibrium.unbalanced();
    std::vector<Vec3> reaction_of(model.bodies.size(), Vec3::Zero()); // at reference points
    for (std::size_t k = 0; k < model.rigid.size(); ++k) {
        const auto r = static_cast<std::size_t>(model.rigid[k].reference);
        const Vec3 inertia = equilibrium.rigid()->inertia_force(k),
                   reaction = equilibrium.constraints().reaction(model.rigid[k].reference, unbalanced[r]);
        reaction_of[static_cast<std::size_t>(model.rigid[k].body)] += reaction + load[r] - inertia;
        balance.acting += reaction.norm() + load[r].norm() + inertia.norm();
    }
    const std::vector<Index> group = model::tied_groups(model);
    std::vector<Vec3> sum_of(model.bodies.size(), Vec3::Zero()); // of a group
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const model::Body& body = model.bodies[b];
        Vec3& sum = sum_of[static_cast<std::size_t>(group[b])];
        sum += reaction_of[b];
        if (equilibrium.rigid() != nullptr && !equilibrium.rigid()->led_force().empty()) {
            sum += equilibrium.rigid()->led_force()[b];
            balance.acting += equilibrium.rigid()->led_force()[b].norm();
        }
        for (Index node = body.first_node; node < body.first_node + body.nodes(); ++node) {
            const auto i = static_cast<std::size_t>(node);
            const Vec3 reaction = equilibrium.constraints().reaction(node, unbalanced[i]);
            const Vec3 other = outer.empty() ? Vec3(Vec3::Zero()) : outer[i];
            sum += reaction + load[i] + other + contact[i];
            balance.acting += reaction.norm() + load[i].norm() + other.norm() + contact[i].norm();
        }
    }
    for (const model::CyclicSymmetry& ring :
         model.cyclic) { // neighbours press on the ends: what is along the axis balances
        Vec3& sum = sum_of[static_cast<std::size_t>(group[static_cast<std::size_t>(ring.body)])];
        sum = ring.axis * ring.axis.dot(sum);
    }
    for (const Vec3& sum : sum_of) balance.left_over = std::max(balance.left_over, sum.norm());
    balance.acting = std::max(balance.acting, equilibrium.reference_force());
    return balance;
}

} // namespace osculate::time
