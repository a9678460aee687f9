#pragma once
/// P^T A P below the finest grid.

#include "multigrid/block_rows.hpp"
#include "multigrid/prolongation.hpp"

namespace osculate::solve {

/// Of bodies and of their coupling.
class CoarseMatrix {
public:
    /// @param nodes, P  must outlive this object
    CoarseMatrix(const FreeNodes& nodes, const Prolongation& P, const NodalMatrix& bodies, int threads);
    /// Takes the values of the bodies.
    void take(const NodalMatrix& bodies);
    /// Sum of the bodies' last values and a coupling.
    /// @returns  whether the pattern has changed
    bool couple(const Coupling& coupling);
    /// Whether some motion of bodies without strain costs no energy. Only such a motion can: the energy of the bodies and that of
    /// their coupling are never negative.
    [[nodiscard]] bool loose() const;

    [[nodiscard]] BlockRows& rows() { return rows_; }
    /// Of the last couple(), in the same place until the pattern changes.
    [[nodiscard]] BlockRows::Values& values() { return values_; }

private:
    const FreeNodes& nodes_;
    const Prolongation& P_;
    int threads_;
    BlockRows rows_, of_bodies_; ///< of the last couple(), of the bodies alone
    BlockRows::Neighbours more_; ///< what the coupling here adds to the second
    BlockRows::Values bodies_, values_;
};

} // namespace osculate::solve
