#pragma once
/// One state, in the form for fields and tables.

#include "osculate/contact/surface_audit.hpp"
#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"
#include "osculate/output/nodal_contact.hpp"
#include "osculate/output/piece.hpp"
#include "osculate/output/reactions.hpp"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace osculate::output {

/// Model, state and contact must outlive this object.
class Snapshot {
public:
    using Stress = Eigen::Matrix<double, Eigen::Dynamic, 6>;

    /// @param contact         at the state; empty if no contact data is needed
    /// @param reactions       of the step; what they refer to must outlive this object, too
    /// @param out_of_balance  (nodes) unbalanced forces, N, of an iterate that is no equilibrium; empty: none
    /// @param dt              of the step that ended in the state, s; 0: no step
    /// @param audit           of the state; null: none
    Snapshot(const model::Model& model, const model::State& state, const model::ContactEvaluations& contact,
             Reactions reactions, std::vector<Vec3> out_of_balance = {}, double dt = 0,
             const contact::AuditResult* audit = nullptr);

    /// The same for one process of several: fields of bodies have values at the points of their pieces alone. Pieces
    /// must outlive it. @param pieces  (bodies)
    [[nodiscard]] Snapshot of_pieces(const std::vector<Piece>& pieces) const;
    /// Piece of a body that fields are of; null: the whole body.
    [[nodiscard]] const Piece* piece(Index body) const {
        return pieces_ == nullptr ? nullptr : &(*pieces_)[static_cast<std::size_t>(body)];
    }
    /// The same for means over elements.
    [[nodiscard]] std::optional<model::BodyPart> part(Index body) const {
        return pieces_ == nullptr ? std::nullopt : std::optional(piece(body)->part());
    }

    [[nodiscard]] const model::Model& model() const { return model_; }
    [[nodiscard]] const model::State& state() const { return state_; }
    [[nodiscard]] const Reactions& reactions() const { return reactions_; }
    /// Empty if the state is an equilibrium.
    [[nodiscard]] const std::vector<Vec3>& out_of_balance() const { return *out_of_balance_; }
    [[nodiscard]] double dt() const { return dt_; }
    [[nodiscard]] const contact::AuditResult* audit() const { return audit_; }
    /// Current position x = X + u of a node, m.
    [[nodiscard]] Vec3 x(Index node) const {
        const auto i = static_cast<std::size_t>(node);
        return model_.X[i] + state_.u[i];
    }
    /// Nodal stress of a body or its piece (points x 6), Pa; computed at the first call.
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
    Reactions reactions_;
    std::shared_ptr<const std::vector<Vec3>> out_of_balance_; ///< that of pieces is the same
    double dt_;
    const contact::AuditResult* audit_;
    const std::vector<Piece>* pieces_ = nullptr; ///< null: whole bodies
    mutable std::map<Index, Stress> stress_;
    mutable std::optional<NodalContact> nodal_contact_;
};

} // namespace osculate::output
