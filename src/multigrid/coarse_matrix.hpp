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
    CoarseMatrix(const FreeNodes& nodes, const Prolongation& P, const NodalMatrix& bodies, int threads);
    /// Takes the values of the bodies.
    void take(const NodalMatrix& bodies);
    /// Sum of the bodies' last values and a coupling.
    /// @returns  whether the pattern has grown
    bool couple(const Coupling& coupling);
    /// Whether some motion of bodies without strain costs no energy. Only such a motion can: the energy of the bodies and that of
    /// their coupling are never negative.
    [[nodiscard]] bool loose() const;

    /// Of one's own aggregates; columns are numbered over those of all processes.
    [[nodiscard]] PetscInt rows() const { return Prolongation::modes * P_.aggregates(); }
    [[nodiscard]] PetscInt* row_start() { return row_start_.data(); }
    [[nodiscard]] PetscInt* column() { return column_.data(); }
    [[nodiscard]] double* value() { return value_.data(); }
    /// Forgets the values of the last couple(), once they are copied.
    void drop_values() { std::vector<double>().swap(value_); }

private:
    using Square = Eigen::Matrix<double, Prolongation::modes, Prolongation::modes, Eigen::RowMajor>;
    /// (A P)_i: the aggregates that a node's row reaches, and their blocks.
    struct Row {
        std::vector<Index> reached;
        std::vector<Prolongation::Block> product;
    };
    using Neighbours = std::vector<std::vector<Index>>; ///< numbers for each aggregate here, ascending

    /// @param neighbours  also of copied aggregates; one's own get what other processes have for them
    void lay_out(Neighbours& neighbours);
    /// Adds what other processes have for one's own rows.
    void take_from_others(std::vector<double>& values) const;
    /// Position of a block among all.
    [[nodiscard]] std::size_t slot(Index row, Index column) const;
    void add(Index row, std::size_t slot, const Square& block, std::vector<double>& to) const;
    /// Unknowns without stiffness, of aggregates with fewer motions than six, get a diagonal for smoothers to divide by.
    void mend();

    const FreeNodes& nodes_;
    const Prolongation& P_;
    int threads_;
    std::vector<std::size_t> start_;    ///< (aggregates here + 1) of blocks
    std::vector<Neighbours> of_others_; ///< (ranks) what each has for the rows that it copies
    std::vector<Index> neighbour_;      ///< (blocks) ascending in a row
    std::vector<PetscInt> row_start_, column_;
    std::vector<double> value_, bodies_;
};

} // namespace osculate::solve
