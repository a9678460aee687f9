#pragma once
/// Nodes that many others follow, eliminated beside the grids.

#include "multigrid/free_nodes.hpp"

#include <Eigen/Eigenvalues>
#include <functional>

namespace osculate::solve {

/// The rows of a hub reach over a whole surface, so that no smoother and no aggregate suits them. With A of all other nodes, B
/// of their coupling with hubs, C of hubs, and W = A^-1 B by conjugate gradients on cycles,
///     z_h = E^-1 (r_h - W^T r),   z = M r - W z_h,   E = C - W^T B - B^T W + W^T A W,
/// where M r is a cycle. E errs by the square of the error of W. A tangent that is not symmetric counts as its columns B, and
/// the symmetric part of C.
class Hubs {
public:
    /// Of vectors over free nodes, (3 n) with copies, in global components.
    using Operation = std::function<void(const Vector&, Vector&)>;

    /// @param nodes  must outlive this object, like the unknowns
    Hubs(const FreeNodes& nodes, const NodalUnknowns& unknowns);
    /// Takes the values of the bodies.
    void take(const NodalMatrix& bodies);
    /// Eliminates hubs from the bodies and their coupling.
    /// @param multiply, cycle  A x and M r; they may overwrite copies in what they are given
    /// @returns singular: some motion of hubs costs no energy
    [[nodiscard]] FactorStatus eliminate(std::span<const NodalBlock> coupling, const Operation& multiply,
                                         const Operation& cycle);
    /// Whether a node is one.
    [[nodiscard]] bool has(Index node) const { return hub(node) >= 0; }
    /// Cycles that the last eliminate() took.
    [[nodiscard]] Index cycles() const { return cycles_; }
    /// Sets the hubs' part of an answer x (equations), from that of a right-hand side b, and takes W z_h from z = M r.
    void correct(const double* b, double* x, const Vector& r, Vector& z) const;

private:
    /// A block of a free node's row at a hub: times the free components of that.
    struct Entry {
        Index node = -1, hub = -1;
        Mat3 block;
    };

    [[nodiscard]] Index hub(Index node) const; ///< -1: it is none
    void add(const NodalBlock& block, std::vector<Entry>& B, Matrix& C) const;
    [[nodiscard]] Matrix columns(const std::vector<Entry>& B) const;
    /// (columns) products of one's own parts with those of other processes added up.
    [[nodiscard]] Vector dots(const Eigen::Ref<const Matrix>& columns, const Eigen::Ref<const Vector>& x) const;
    /// Solves A w = b until the energy of the column's hub, `energy` less that of w, is known.
    void solve(const Vector& b, double energy, const Operation& multiply, const Operation& cycle, Vector& w);

    const FreeNodes& nodes_;
    const std::vector<NodalUnknowns::Hub>& hubs_;
    std::vector<Index> column_; ///< (3 hubs) of each local component among the free ones, -1: held
    std::vector<SparseIndex> equation_;
    Index size_ = 0, cycles_ = 0;
    std::vector<Entry> bodies_;
    Matrix C_bodies_, W_; ///< (free components)^2, (3 n x free components)
    Vector scale_;        ///< (free components) those of E are scaled to 1
    Eigen::SelfAdjointEigenSolver<Matrix> E_;
};

} // namespace osculate::solve
