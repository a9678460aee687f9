#pragma once
/// One state, in the form for fields and tables.

#include "osculate/contact/surface_audit.hpp"
#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"
#include "osculate/output/nodal_contact.hpp"
#include "osculate/output/piece.hpp"

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace osculate::output {

/// Model, state and contact must outlive this object.
class Snapshot {
public:
    using Stress = Eigen::Matrix<double, Eigen::Dynamic, 6>;

    /// @param contact         at the state; empty if no contact data is needed
    /// @param reactions       (nodes) forces of supports and driven motions on each node, N; empty: not needed
    /// @param out_of_balance  (nodes) unbalanced forces, N, of an iterate that is no equilibrium; empty: none
    /// @param dt              of the step that ended in the state, s; 0: no step
    /// @param audit           of the state; null: none
    Snapshot(const model::Model& model, const model::State& state, const model::ContactEvaluations& contact,
             std::vector<Vec3> reactions, std::vector<Vec3> out_of_balance = {}, double dt = 0,
             const contact::AuditResult* audit = nullptr);

    /// The same for one process of several: what means over elements give is right at the nodes of its pieces alone. Pieces
    /// must outlive it. @param pieces  (bodies)
    [[nodiscard]] Snapshot of_pieces(const std::vector<Piece>& pieces) const;
    /// (elements of the body) Whether means at nodes are to be taken of it; empty: of all.
    [[nodiscard]] std::span<const char> elements(Index body) const;

    [[nodiscard]] const model::Model& model() const { return model_; }
    [[nodiscard]] const model::State& state() const { return state_; }
    [[nodiscard]] const std::vector<Vec3>& reactions() const { return *reactions_; }
    /// Empty if the state is an equilibrium.
    [[nodiscard]] const std::vector<Vec3>& out_of_balance() const { return *out_of_balance_; }
    [[nodiscard]] double dt() const { return dt_; }
    [[nodiscard]] const contact::AuditResult* audit() const { return audit_; }
    /// Current positions x = X + u of all nodes, m; computed at the first call.
    [[nodiscard]] const Field& x() const;
    /// Nodal stress of a body (nodes x 6), Pa; computed at the first call.
    [[nodiscard]] const Stress& stress(Index body) const;
    /// Frees the stress of all bodies.
    void forget_stress() const { stress_.clear(); }
    /// Contact of all pairs, node by node; computed at the first call.
    [[nodiscard]] const NodalContact& nodal_contact() const;
    /// Contact evaluation of a pair.
    [[nodiscard]] const model::ContactEvaluation& evaluation(Index pair) const { return contact_[pair]; }
    /// Contact state of a slave node at x: gap, normal, force; without drift.
    [[nodiscard]] contact::ContactState contact(Index pair, Index slave) const;
    /// Displacement of a slave node relative to the master during the step, m.
    [[nodiscard]] Vec3 drift(Index pair, Index slave) const { return contact_[pair].drift(slave); }
    /// Whether the master has a point that the slave node can touch, or has passed.
    [[nodiscard]] bool has_partner(Index pair, Index slave) const;

private:
    const model::Model& model_;
    const model::State& state_;
    const model::ContactEvaluations& contact_;
    std::shared_ptr<const std::vector<Vec3>> reactions_, out_of_balance_; ///< those of pieces are the same
    double dt_;
    const contact::AuditResult* audit_;
    const std::vector<Piece>* pieces_ = nullptr; ///< null: whole bodies
    mutable Field x_;
    mutable std::map<Index, Stress> stress_;
    mutable std::optional<NodalContact> nodal_contact_;
};

} // namespace osculate::output
