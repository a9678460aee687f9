#pragma once
/// Choice of the method for Newton's linear systems.

#include "osculate/core/choices.hpp"
#include "osculate/model/model.hpp"

namespace osculate::equilibrium {

/// Estimates of the cost of condensation, in floating-point operations, and of the memory for its dense matrices.
struct CondensationCost {
    double condensed = 0;   ///< inverses on the contact nodes and dense contact laws, made a few times
    double factorising = 0; ///< one sparse factorisation of all bodies
    double bytes = 0;
    /// Whether condensation pays off within a few iterations and its matrices fit into memory.
    [[nodiscard]] bool pays() const;
};
[[nodiscard]] CondensationCost condensation_cost(const model::Model& model, const model::ContactPairs& pairs);

/// How to solve linear systems with the tangent of a stage.
struct TangentChoice {
    bool products = false;       ///< products of the tangent with vectors, without its matrix
    bool preconditioned = false; ///< GMRES with linear::ContactPreconditioner
    bool multigrid = false;      ///< multigrid inverts this preconditioner
    bool condensed = false;      ///< linear::CondensedTangent first
    bool factorisable = true;    ///< the whole tangent may be factorised if GMRES fails

    [[nodiscard]] bool operator==(const TangentChoice&) const = default;
};

/// Made once for a stage, from the model, the pairs in force and the user's request.
/// @param follows  whether a pressure follows its faces
[[nodiscard]] TangentChoice choose_tangent(const model::Model& model, const model::ContactPairs& pairs,
                                           LinearSolver asked, bool dynamic, bool follows);

} // namespace osculate::equilibrium
