#pragma once
/// How Newton's linear systems are solved, and when by which way.

#include "osculate/linear/linear_solver.hpp"
#include "osculate/model/model.hpp"

namespace osculate::equilibrium {

/// Estimates of what condensation takes, in floating-point operations, and of the memory for its dense matrices.
struct CondensationCost {
    double condensed = 0;   ///< inverses on the contact nodes and the dense laws of contact, made a few times
    double factorising = 0; ///< one sparse factorisation of all bodies
    double bytes = 0;
    /// Whether what it costs once is made up for within a few iterations, and fits.
    [[nodiscard]] bool pays() const;
};
[[nodiscard]] CondensationCost condensation_cost(const model::Model& model);

/// Whether the preconditioner is multigrid.
[[nodiscard]] bool goes_by_multigrid(const model::Model& model, linear::LinearSolver solver);
/// Whether the tangent goes by what it does to a vector, without a matrix: not where LU wants one, nor, without
/// multigrid, with so many slave nodes that their derivatives, held one by one, would take more memory.
[[nodiscard]] bool goes_by_products(const model::Model& model, linear::LinearSolver solver);
/// Whether the whole tangent may be factorised where GMRES gets nowhere: it fits into memory, or multigrid is not in use.
[[nodiscard]] bool may_factorise(const model::Model& model, linear::LinearSolver solver);
/// Whether contact is condensed. @param follows  whether a pressure follows its facets
[[nodiscard]] bool condenses(const model::Model& model, linear::LinearSolver solver, bool follows);

} // namespace osculate::equilibrium
