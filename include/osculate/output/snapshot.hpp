#pragma once
/// One state, as fields and tables look at it.

#include "osculate/contact/surface_audit.hpp"
#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"

#include <map>
#include <vector>

namespace osculate::output {

/// Model, state and contact must outlive it.
class Snapshot {
public:
    using Stress = Eigen::Matrix<double, Eigen::Dynamic, 6>;

    /// @param contact         at the state; empty where nothing of contact is asked for
    /// @param reactions       (nodes) what supports and driven motions exert on each node, N; empty: nobody asks for them
    /// @param out_of_balance  (nodes) forces that nothing balances, N, of an iterate that is no equilibrium; empty: none
    /// @param dt              of the step that ended in the state, s; 0: none has
    /// @param audit           of the state; null: there was none
    Snapshot(const model::Model& model, const model::State& state, const model::ContactEvaluations& contact,
             std::vector<Vec3> reactions, std::vector<Vec3> out_of_balance = {}, double dt = 0,
             const contact::AuditResult* audit = nullptr);

    [[nodiscard]] const model::Model& model() const { return model_; }
    [[nodiscard]] const model::State& state() const { return state_; }
    [[nodiscard]] const std::vector<Vec3>& reactions() const { return reactions_; }
    /// Empty where the state is an equilibrium.
    [[nodiscard]] const std::vector<Vec3>& out_of_balance() const { return out_of_balance_; }
    [[nodiscard]] double dt() const { return dt_; }
    [[nodiscard]] const contact::AuditResult* audit() const { return audit_; }
    /// Current positions x = X + u of all nodes, m; computed when first asked for.
    [[nodiscard]] const Field& x() const;
    /// Nodal stress of a body (nodes x 6), Pa; computed when first asked for.
    [[nodiscard]] const Stress& stress(Index body) const;
    /// What contact found for a pair.
    [[nodiscard]] const model::ContactEvaluation& evaluation(Index pair) const { return contact_[pair]; }
    /// Contact state of a slave node at x: gap, normal, force; no drift.
    [[nodiscard]] contact::ContactState contact(Index pair, Index slave) const;
    /// Displacement of a slave node relative to the master within the step, m.
    [[nodiscard]] Vec3 drift(Index pair, Index slave) const { return contact_[pair].drift(slave); }
    /// Whether the master has a point that the slave node can touch, or has passed.
    [[nodiscard]] bool has_partner(Index pair, Index slave) const;

private:
    const model::Model& model_;
    const model::State& state_;
    const model::ContactEvaluations& contact_;
    std::vector<Vec3> reactions_, out_of_balance_;
    double dt_;
    const contact::AuditResult* audit_;
    mutable Field x_;
    mutable std::map<Index, Stress> stress_;
};

} // namespace osculate::output
