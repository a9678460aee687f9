#pragma once
/// The condensed tangent of a stage, and the nodes on which it is condensed.

#include "osculate/equilibrium/tangent_choice.hpp"
#include "osculate/linear/condensed_tangent.hpp"

#include <memory>
#include <span>
#include <vector>

namespace osculate::equilibrium {

/// Condenses on all nodes that contact may reach where the choice names them. With general contact these are many more than
/// those that bear: then on the nodes that bear or have borne and, once contact moves on, their neighbours on the surface, as
/// long as that pays off.
class Condensation {
public:
    /// @param K       stiffness of the bodies, as linear::CondensedTangent wants it
    /// @param bodies  of the model
    /// @param slaves  (couplings) global nodes
    /// Arguments other than `bodies`, `slaves` and `choice` must outlive this object.
    Condensation(const model::Model& model, const linear::Constraints& constraints, const linear::BlockMatrix& K,
                 std::vector<linear::CondensedBody> bodies, std::vector<Index> slaves, const TangentChoice& choice,
                 int threads);

    /// Opens an attempt, see linear::CondensedTangent::begin().
    void begin(double mass_factor, bool changed);
    /// Ends an attempt: keeps or discards what it has added.
    void commit();
    void rollback();
    /// Whether these contacts can be condensed at a cost that pays off.
    [[nodiscard]] bool serves(const std::vector<linear::BearingContact>& contacts) const;
    /// The tangent for these contacts, which must outlive its use. @pre serves()
    [[nodiscard]] linear::CondensedTangent& tangent_for(const std::vector<linear::BearingContact>& contacts);
    [[nodiscard]] int factorisations() const { return factorisations_ + (now_ ? now_->factorisations() : 0); }

    /// Of the last commit(): contact laws, null if there are none; and nodes, empty where the choice names them.
    [[nodiscard]] const linear::ContactLaws* kept_laws() const { return kept_ ? kept_->kept() : nullptr; }
    [[nodiscard]] std::vector<Index> kept_nodes() const;
    /// Restores these.
    void recall(const std::vector<Index>& nodes, const linear::ContactLaws* laws);
    [[nodiscard]] std::shared_ptr<const linear::CondensedTangent> kept() const { return grows_ ? kept_ : nullptr; }
    /// Starts on the nodes of another's with the same stiffness of the bodies, and with its inverses.
    void go_on_from(const linear::CondensedTangent& last) {
        if (grows_) now_ = kept_ = condensed_on(last.nodes(), &last);
    }

private:
    using Nodes = std::vector<Index>;
    /// Nodes to condense on for these contacts; empty: it does not pay off.
    [[nodiscard]] Nodes nodes_for(const std::vector<linear::BearingContact>& contacts) const;
    [[nodiscard]] std::shared_ptr<linear::CondensedTangent> condensed_on(const Nodes& nodes,
                                                                         const linear::CondensedTangent* before) const;

    const model::Model& model_;
    const linear::Constraints& constraints_;
    const linear::BlockMatrix* K_;
    std::vector<linear::CondensedBody> bodies_;
    std::vector<Index> slaves_;
    bool grows_, at_any_cost_;
    int threads_;
    std::vector<char> outside_;                            ///< (nodes) on a surface of general contact
    Nodes anchors_;                                        ///< ends of springs of bodies that nothing else holds
    std::shared_ptr<linear::CondensedTangent> now_, kept_; ///< null: not made yet
    double mass_factor_ = 0;
    int factorisations_ = 0; ///< of those that are no more
};

} // namespace osculate::equilibrium
