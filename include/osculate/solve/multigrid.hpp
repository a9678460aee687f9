#pragma once
/// Algebraic multigrid for the stiffness of elastic bodies.

#include "osculate/solve/direct_solver.hpp"
#include "osculate/solve/nodal_matrix.hpp"

#include <array>
#include <memory>
#include <vector>

namespace osculate::solve {

/// What multigrid needs to know of the unknowns.
struct NodalUnknowns {
    std::vector<Index> node;           ///< (n) those with a free component, ascending
    std::vector<Index> body;           ///< (n) the body of each
    std::vector<SparseIndex> equation; ///< (3 n) of each local component; -1: held
    std::vector<Index> frame_number;   ///< (n) of each in frames
    /// Columns: the axes of the local components. The first are those of most nodes.
    std::vector<Mat3> frames{Mat3::Identity()};
    std::vector<Vec3> arm;      ///< (n) from the middle of its body, over the body's size; only to choose grids
    std::vector<int> owner;     ///< (n) the process of each, see Share; empty: there is one process
    std::vector<Index> coupled; ///< nodes that may be coupled, ascending; of several processes alone

    /// A node of no body that many nodes follow, as those of rigid bodies.
    struct Hub {
        Index node = -1;
        std::array<SparseIndex, 3> equation{-1, -1, -1}; ///< of each local component; -1: held
        Mat3 frame = Mat3::Identity();
    };
    std::vector<Hub> hubs; ///< with a free component, ascending by node

    [[nodiscard]] const Mat3& frame(Index place) const {
        return frames[static_cast<std::size_t>(frame_number[static_cast<std::size_t>(place)])];
    }
    /// (3 x 6) displacements of a node by motions of its body without strain, in global components, held ones included.
    [[nodiscard]] Eigen::Matrix<double, 3, 6> motions(Index place) const {
        Eigen::Matrix<double, 3, 6> rows;
        for (int k = 0; k < 3; ++k) {
            const Vec3 along = Vec3::Unit(k);
            rows.row(k) << along.transpose(), arm[static_cast<std::size_t>(place)].cross(along).transpose();
        }
        return rows;
    }
};

/// V-cycles of smoothed aggregation. Grids are chosen once, for bodies without their coupling, so that no coarse unknown
/// joins two bodies; the coupling enters only the matrices.
class Multigrid {
public:
    virtual ~Multigrid() = default;
    /// Chooses the grids, and takes the values of the bodies.
    /// @param undeformed  stiffness; always the same, so that a solution does not depend on the time of the call
    virtual void coarsen(const NodalMatrix& undeformed) = 0;
    /// Takes other values in the pattern of coarsen().
    virtual void take(const NodalMatrix& bodies) = 0;
    /// Whether this process reads the coupling's blocks in the row of a node. @pre coarsen()
    [[nodiscard]] virtual bool reads_row(Index node) const = 0;
    /// Makes the matrices for the sum of bodies and coupling.
    /// @param coupling  rows that are not read may be missing
    /// @returns  singular: some motion of bodies without strain is not held
    [[nodiscard]] virtual FactorStatus couple(std::span<const NodalBlock> coupling) = 0;
    /// x approximates A^-1 b: linear and symmetric in b; b and x (equations) must not overlap. Where several processes share it, it
    /// reads and sets the equations of one's own nodes, and of hubs.
    virtual void cycle(const double* b, double* x) = 0;
    /// Cycles that the last couple() took, for hubs.
    [[nodiscard]] virtual Index cycles_to_couple() const = 0;
};

/// Loads PETSc at the first call.
/// @param threads  share the work on the finest grid and the matrix below it; a cycle's bits do not depend on them
/// @throws RunFailure if the module cannot be loaded
[[nodiscard]] std::unique_ptr<Multigrid> make_multigrid(NodalUnknowns unknowns, int threads = 1);

} // namespace osculate::solve
