#include "time/step_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::time {

using linear::Constraints;

CentreMasses::CentreMasses(const model::Model& model, const equilibrium::Dynamics& dynamics,
                           const linear::Constraints& constraints, int threads)
    : mass(model.bodies.size(), 0.0), free(model.bodies.size(), Eigen::Array<bool, 3, 1>::Constant(true)) {
    Field sums(model.X.size());
    model.mass(dynamics.lumped_mass).multiply_add(Field(sums.size(), Vec3::UnitX()), sums, threads);
    constexpr double across = 1e-6; // of a unit vector: round-off of a support's axes
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
        for (Index n = 0; n < model.bodies[b].nodes(); ++n) {
            const Index node = model.bodies[b].first_node + n;
            mass[b] += sums[node].x();
            for (int k = 0; k < 3; ++k)
                if (constraints.constraint(node, k) != nullptr)
                    free[b] = free[b] && constraints.frame(node).col(k).array().abs() < across;
        }
    for (const model::RigidBody& body : model.rigid) {
        const auto b = static_cast<std::size_t>(body.body);
        if (!body.coupling) mass[b] = body.mass;
        for (int k = 0; k < 3; ++k)
            if (constraints.constraint(body.reference, k) != nullptr)
                free[b] = free[b] && constraints.frame(body.reference).col(k).array().abs() < across;
    }
}

bool touches(const model::State& state) {
    return std::ranges::any_of(state.contact, [](const model::ContactHistory& pair) {
        return std::ranges::any_of(pair.status, contact::is_closed);
    });
}

double energy_from_nowhere(const Ledger& before, const Ledger& after) {
    const auto free = [](const Ledger& ledger) { return ledger.kinetic + ledger.strain - ledger.external; };
    const double energy = before.kinetic + before.strain;
    return energy > 0 ? std::max({0.0, free(after) - free(before), after.contact - before.contact}) / energy : 0;
}

double energy_so_far(const Ledger& ledger) {
    return ledger.kinetic + ledger.strain + ledger.friction + ledger.damping + std::max(0.0, ledger.algorithmic) +
           std::max(0.0, -ledger.contact);
}

double closing_energy(const Ledger& before, const Ledger& after) {
    const double energy = std::max(energy_so_far(before), energy_so_far(after));
    return energy > 0 ? std::max(0.0, before.contact - after.contact) / energy : 0;
}

double velocity_error(const model::Model& model, const equilibrium::Dynamics& dynamics, const CentreMasses& masses,
                      const model::ContactEvaluations& contact, const model::State& from, const model::State& to,
                      double dt, double energy) {
    if (!(energy > 0)) return 0;
    std::vector<Vec3> change(model.bodies.size(), Vec3::Zero()); // of the force on each body, N
    for (std::size_t p = 0; p < to.contact.size(); ++p) {
        Vec3 sum = Vec3::Zero();
        for (std::size_t j = 0; j < to.contact[p].lambda.size(); ++j)
            sum += contact[p].whole(static_cast<Index>(j)) * (to.contact[p].lambda[j] - from.contact[p].lambda[j]);
        const model::ContactPair& pair = *to.contact[p].pair;
        change[static_cast<std::size_t>(model::body_index(model, pair.slaves().node.front()))] += sum;
        change[static_cast<std::size_t>(model::body_index(model, pair.master_nodes().front()))] -= sum;
    }
    double twice = 0;
    for (std::size_t b = 0; b < change.size(); ++b)
        for (int k = 0; k < 3; ++k)
            if (masses.free[b](k) && masses.mass[b] > 0) twice += change[b](k) * change[b](k) / masses.mass[b];
    return dynamics.integrator.error * dt * std::sqrt(twice / (2 * energy));
}

AtNode local_error(const model::Model& model, const equilibrium::Dynamics& dynamics,
                   const linear::Constraints& constraints, const model::State& from, const model::State& to,
                   double dt) {
    const linear::BlockMatrix& M = model.mass(dynamics.lumped_mass);
    // nothing ties down the acceleration of a node without mass; that of a held direction is given
    constexpr double nothing = -1;
    const auto error_of = [&](Index i) {
        bool massless = true;
        for (Index k = M.row_begin(i); k < M.row_end(i) && massless; ++k) massless = M.block(k).isZero(0);
        if (massless) return nothing;
        Vec3 change = constraints.to_local(i, to.a[i] - from.a[i]);
        for (int k = 0; k < 3; ++k)
            if (constraints.constraint(i, k) != nullptr) change(k) = 0;
        return dynamics.integrator.local_error(change, Vec3::Zero(), dt);
    };
    AtNode largest = largest_over(model.nodes(), error_of, nothing);
    for (std::size_t k = 0; k < model.rigid.size(); ++k) {
        const model::RigidBody& body = model.rigid[k];
        if (body.coupling || constraints.free_components(body.reference) == 0) continue;
        const Vec3 change = to.rigid[k].acceleration - from.rigid[k].acceleration;
        if (const double error = dynamics.integrator.local_error(change, Vec3::Zero(), dt); error > largest.value)
            largest = {error, body.reference};
    }
    return {std::max(0.0, largest.value), largest.node};
}

/// StepEvidence::unseen.
GapEvidence deepest_unseen(const model::ContactEvaluations& contact) {
    GapEvidence deepest;
    for (std::size_t p = 0; p < contact.size(); ++p) {
        const model::ContactPair& pair = contact[p].pair();
        for (Index j = 0; j < pair.size(); ++j) {
            const double gap = contact[p].unseen_gap(j);
            if (!(gap < 0)) continue;
            const double length = pair.surface().facet_size(contact[p].facets()[j]);
            if (deepest.pair >= 0 && gap / length >= deepest.g1 / deepest.length) continue;
            deepest = {0, gap, static_cast<Index>(p), j, length};
        }
    }
    return deepest;
}

} // namespace osculate::time
