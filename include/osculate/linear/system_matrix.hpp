#pragma once
/// The tangent of a step as one sparse matrix over free displacements and contact forces, written through a slot map.

#include "osculate/core/parallel.hpp"
#include "osculate/linear/block_matrix.hpp"
#include "osculate/linear/constraints.hpp"
#include "osculate/linear/unknowns.hpp"
#include "osculate/solve/sparse_matrix.hpp"

#include <array>
#include <span>
#include <vector>

namespace osculate::linear {

/// One slave node and the master nodes that its contact may reach during the lifetime of the pattern.
struct Coupling {
    Index slave = -1;           ///< global node
    std::vector<Index> masters; ///< global nodes, ascending; empty: an open node without contact forces
};

/// Rows and columns are numbered by Unknowns.
class SystemMatrix {
public:
    /// Without couplings the matrix is the symmetric stiffness of the free components.
    SystemMatrix(const Constraints& constraints, const BlockMatrix& K, std::vector<Coupling> couplings);

    [[nodiscard]] Index size() const { return unknowns_.size(); }
    [[nodiscard]] const solve::SparseMatrix& matrix() const { return matrix_; }
    /// Whether every node of `masters` (global) is in the pattern of coupling j.
    [[nodiscard]] bool covers(Index j, std::span<const Index> masters) const;
    [[nodiscard]] const std::vector<Coupling>& couplings() const { return couplings_; }

    [[nodiscard]] const Unknowns& unknowns() const { return unknowns_; }

    /// Says that K may lose its positive definiteness.
    void expect_buckling() { matrix_.may_turn_indefinite = true; }
    /// Says that K is not symmetric.
    void expect_unsymmetric() { matrix_.symmetric_positive_definite = false; }
    /// Takes over new values of K.
    void stiffness_changed();
    /// Uses another matrix of the same pattern instead of K; it must outlive this object.
    void use(const BlockMatrix& K) {
        K_ = &K;
        stiffness_changed();
    }
    /// Sets the values to the stiffness and the unit columns of the contact forces.
    void reset();
    /// Adds the contact tangent of coupling j in global components. Contact rows: derivatives A (3 x 3+3n) by (slave,
    /// masters) and D (3 x 3) by the contact force. Equilibrium rows of the first m masters: derivatives E (3m x 3) by
    /// the contact force and G (3m x 3+3n) by (slave, masters). Writes only rows of nodes that `lane` owns.
    void add_contact(Index j, std::span<const Index> masters, const Eigen::Ref<const Matrix>& A, const Mat3& D,
                     const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3>>& E,
                     const Eigen::Ref<const Matrix>& G, Lane lane = {});
    /// Adds the contact tangent of an open coupling without partner: D only.
    void add_contact(Index j, const Mat3& D, Lane lane = {});
    /// Declares the values complete.
    void finish() { ++matrix_.revision; }

private:
    // Block rows and columns are nodes 0 .. N-1 and multipliers N .. N+M-1.
    [[nodiscard]] Index first_unknown(Index block) const;
    [[nodiscard]] Index width(Index block) const;
    [[nodiscard]] Index offset(Index row_block, Index column_block) const;
    [[nodiscard]] Index equilibrium_block(Index node) const;
    [[nodiscard]] const Mat3& frame(Index block) const;
    void build_pattern();
    void fill_base();
    /// Adds a 3 x 3 block, already in local frames, at scalar rows (or held) and a block column.
    void add(const std::array<Index, 3>& rows, Index offset_in_row, Index column_block, const Mat3& value,
             std::vector<double>& into) const;
    [[nodiscard]] std::array<Index, 3> equilibrium_rows(Index node) const;
    [[nodiscard]] std::array<Index, 3> contact_rows(Index j) const;
    /// Offsets of the blocks (slave, masters, multiplier) in every row block that coupling j writes.
    void map_slots();

    const Constraints* constraints_;
    const BlockMatrix* K_;
    std::vector<Coupling> couplings_;
    Unknowns unknowns_;
    std::vector<Index> first_;              ///< (blocks + 1) first unknown of each block
    std::vector<Index> block_row_start_{0}; ///< (blocks + 1)
    std::vector<Index> block_column_, block_offset_;
    std::vector<std::vector<Index>> slots_; ///< per coupling, (masters + 1) x (masters + 2) offsets
    std::vector<char> plain_;               ///< (nodes) all three components free, in global axes
    std::vector<double> base_;
    solve::SparseMatrix matrix_;
};

} // namespace osculate::linear
