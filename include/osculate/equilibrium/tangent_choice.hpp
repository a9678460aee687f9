#pragma once
/// How Newton's linear systems are solved, and when by which way.

#include "osculate/core/choices.hpp"
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

/// How the tangent of a stage is solved with.
struct TangentChoice {
    bool products = false;       ///< it goes by what it does to a vector, without a matrix
    bool preconditioned = false; ///< GMRES with linear::ContactPreconditioner
    bool multigrid = false;      ///< whose inverse is by multigrid
    bool condensed = false;      ///< linear::CondensedTangent first
    bool factorisable = true;    ///< the whole tangent may be factorised where GMRES gets nowhere

    [[nodiscard]] bool operator==(const TangentChoice&) const = default;
};

/// Made once for a stage, from what there is and what is asked for.
/// @param follows  whether a pressure follows its facets
[[nodiscard]] TangentChoice choose_tangent(const model::Model& model, LinearSolver asked, bool dynamic, bool follows);

} // namespace osculate::equilibrium
