#pragma once
/// How Newton's linear systems are solved.

namespace osculate::linear {

enum class LinearSolver {
    automatic, ///< multigrid for many nodes, else condensed where that costs less, else iterative
    condensed, ///< CondensedTangent, where bodies are linear and nothing follows; else iterative
    iterative, ///< GMRES with the whole tangent and ContactPreconditioner, factorised
    multigrid, ///< the same, the preconditioner by multigrid
    direct     ///< the tangent factorised in every iteration
};

} // namespace osculate::linear
