#pragma once
/// Stiffness of the bodies with springs between slave nodes and points of their masters: symmetric, for preconditioning.

#include "osculate/linear/block_matrix.hpp"
#include "osculate/linear/constraints.hpp"
#include "osculate/solve/sparse_matrix.hpp"

#include <optional>
#include <vector>

namespace osculate::linear {

/// Spring of stiffness S (3 x 3, N/m, symmetric) between a slave node and a point that follows master nodes,
///     energy 1/2 w^T S w,   w = u_slave - sum_i N_i u_i
struct Spring {
    Index slave = -1;
    std::vector<Index> masters; ///< global nodes; one may occur more than once
    std::vector<Mat3> follow;   ///< N_i, shape function times image
    Mat3 stiffness = Mat3::Zero();
};

/// Calls each(row, column, block) for the blocks S, -S N_i, N_i^T S N_k of a spring.
void for_each_block(const Spring& spring, auto&& each) {
    each(spring.slave, spring.slave, spring.stiffness);
    for (std::size_t i = 0; i < spring.masters.size(); ++i) {
        const Mat3 by_master = -spring.stiffness * spring.follow[i];
        each(spring.slave, spring.masters[i], by_master);
        each(spring.masters[i], spring.slave, Mat3(by_master.transpose()));
        for (std::size_t k = 0; k < spring.masters.size(); ++k)
            each(spring.masters[k], spring.masters[i], Mat3(-spring.follow[k].transpose() * by_master));
    }
}

class PenaltyStiffness {
public:
    PenaltyStiffness(const Constraints& constraints, const BlockMatrix& K);
    /// Takes over new values of K; they apply from the next set_springs() on.
    void stiffness_changed();
    /// Uses another matrix of the same pattern instead of K; it must outlive this object.
    void use(const BlockMatrix& K) {
        K_ = &K;
        stiffness_changed();
    }
    /// Rewrites the matrix for other springs; the pattern grows if necessary.
    void set_springs(const std::vector<Spring>& springs);
    /// Keeps the current pattern, or restores the one last kept: the order of elimination, and therefore the last digit
    /// of a solution, depends on the pattern.
    void keep_pattern() { kept_ = pattern_springs_; }
    void restore_pattern();
    /// Springs (connected nodes only) for which the kept pattern was made; no value before the first. restore_pattern()
    /// builds and keeps the pattern for such springs.
    [[nodiscard]] std::optional<std::vector<Spring>> kept_pattern() const {
        if (block_row_start_.empty()) return std::nullopt;
        return kept_;
    }
    void restore_pattern(const std::vector<Spring>& springs) {
        build_pattern(springs);
        fill_base();
        keep_pattern();
    }
    /// The matrix over the free components, by equation number.
    [[nodiscard]] const solve::SparseMatrix& matrix() const { return matrix_; }
    /// (nonzeros of matrix()) values of another matrix with the pattern of K, without springs.
    [[nodiscard]] std::vector<double> values_of(const BlockMatrix& K) const;

private:
    void build_pattern(const std::vector<Spring>& springs);
    void fill_base() { base_ = values_of(*K_); }
    [[nodiscard]] bool covers(const std::vector<Spring>& springs) const;
    /// Position of block (row, column) among the blocks of its row, -1 if there is none.
    [[nodiscard]] Index slot(Index row, Index column) const;
    void add(Index row, Index column, const Mat3& global, std::vector<double>& into) const;

    const Constraints& constraints_;
    const BlockMatrix* K_;
    std::vector<Index> block_row_start_, block_column_, block_offset_; ///< offset of a block's columns within a row
    std::vector<double> base_;
    std::vector<Spring> pattern_springs_, kept_; ///< springs of the pattern; only their nodes matter
    std::uint64_t patterns_ = 0;
    solve::SparseMatrix matrix_;
};

} // namespace osculate::linear
