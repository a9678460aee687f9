#pragma once
/// P^T A P below the finest grid.

#include "multigrid/prolongation.hpp"

#include <petscsystypes.h>

namespace osculate::solve {

/// Of bodies and of their coupling, by rows of single entries, as PETSc works on them in place. Blocks of 6 x 6 are added up
/// node by node, so that A P is held nowhere.
class CoarseMatrix {
public:
    /// @param nodes, P  must outlive this object
    CoarseMatrix(const FreeNodes& nodes, const Prolongation& P, const NodalMatrix& bodies);
    /// Takes the values of the bodies.
    void take(const NodalMatrix& bodies);
    /// Sum of the bodies' last values and a coupling.
    /// @returns  whether the pattern has grown
    bool couple(const Coupling& coupling);
    /// Whether some motion of bodies without strain costs no energy. Only such a motion can: the energy of the bodies and that of
    /// their coupling are never negative.
    [[nodiscard]] bool loose() const;

    [[nodiscard]] PetscInt rows() const { return static_cast<PetscInt>(row_start_.size()) - 1; }
    [[nodiscard]] PetscInt* row_start() { return row_start_.data(); }
    [[nodiscard]] PetscInt* column() { return column_.data(); }
    [[nodiscard]] double* value() { return value_.data(); }

private:
    using Square = Eigen::Matrix<double, Prolongation::modes, Prolongation::modes, Eigen::RowMajor>;
    using Neighbours = std::vector<std::vector<Index>>; ///< of each aggregate, ascending

    void lay_out(const Neighbours& neighbours);
    /// Position of a block among all.
    [[nodiscard]] std::size_t slot(Index row, Index column) const;
    void add(Index row, std::size_t slot, const Square& block, std::vector<double>& to) const;
    /// Unknowns without stiffness, of aggregates with fewer motions than six, get a diagonal for smoothers to divide by.
    void mend();

    const FreeNodes& nodes_;
    const Prolongation& P_;
    std::vector<Index> body_;        ///< (aggregates)
    std::vector<std::size_t> start_; ///< (aggregates + 1) of blocks
    std::vector<Index> neighbour_;   ///< (blocks) ascending in a row
    std::vector<PetscInt> row_start_, column_;
    std::vector<double> value_, bodies_;
};

} // namespace osculate::solve
