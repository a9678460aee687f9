#pragma once
/// Choice of the method for Newton's linear systems.

#include "osculate/core/choices.hpp"
#include "osculate/model/model.hpp"

#include <vector>

namespace osculate::equilibrium {

/// Estimates of the cost of condensation, in floating-point operations, and of the memory for its dense matrices.
struct CondensationCost {
    double condensed = 0;   ///< inverses on the contact nodes and dense contact laws, made a few times
    double factorising = 0; ///< one sparse factorisation of all bodies
    double bytes = 0;
    /// Whether condensation pays off within a few iterations and its matrices fit into memory.
    /// @param as_fast  operations that take as long as one of a factorisation: dense ones are some three times quicker, and a
    ///                 few factorisations are usual
    [[nodiscard]] bool pays(double as_fast = 6) const;
};
/// @param scope  of the pairs that general contact has found; null: there are none, or nothing is known about them
[[nodiscard]] CondensationCost condensation_cost(const model::Model& model, const model::ContactPairs& pairs,
                                                 const model::ContactScope* scope = nullptr);
/// The same on these nodes, global, with so many contacts.
[[nodiscard]] CondensationCost condensation_cost(const model::Model& model, const std::vector<Index>& nodes,
                                                 std::size_t contacts);
/// Nodes that contact may reach, global, ascending: slaves and masters, of pairs of general contact only as far as the scope goes.
[[nodiscard]] std::vector<Index> contact_nodes(const model::Model& model, const model::ContactPairs& pairs,
                                               const model::ContactScope* scope = nullptr);

/// How to solve linear systems with the tangent of a stage.
struct TangentChoice {
    bool products = false;       ///< products of the tangent with vectors, without its matrix
    bool preconditioned = false; ///< GMRES with linear::ContactPreconditioner
    bool reduced = false;        ///< and linear::ReducedGmres where contact is linearised as products
    bool multigrid = false;      ///< multigrid inverts this preconditioner
    bool condensed = false;      ///< linear::CondensedTangent first
    bool factorisable = true;    ///< the whole tangent may be factorised if GMRES fails
    bool grows = false;          ///< condensed on the nodes that bear, see Condensation
    bool at_any_cost = false;    ///< and even where this does not pay off
    std::vector<Index> nodes{};  ///< contact_nodes() where condensed and not on those that bear

    [[nodiscard]] bool operator==(const TangentChoice&) const = default;
};

/// Why multigrid is not to be taken, however many nodes there are; null: nothing bars it.
[[nodiscard]] const char* bars_multigrid(const model::Model& model, LinearSolver asked);

/// On what GMRES with multigrid does not converge, in words; null: on nothing of the model. Processes that share it leave factors to
/// the first.
[[nodiscard]] const char* needs_factors(const model::Model& model);

/// Made for a stage, from the model, the pairs in force and the user's request; with general contact again for other pairs.
/// @param follows  whether a pressure follows its faces
/// @param scope    see condensation_cost()
[[nodiscard]] TangentChoice choose_tangent(const model::Model& model, const model::ContactPairs& pairs,
                                           LinearSolver asked, bool dynamic, bool follows,
                                           const model::ContactScope* scope = nullptr);

} // namespace osculate::equilibrium
