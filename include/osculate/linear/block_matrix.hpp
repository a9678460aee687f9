#pragma once
/// Sparse matrix of 3 x 3 blocks over the nodes of all bodies.

#include "osculate/core/field.hpp"
#include "osculate/solve/nodal_matrix.hpp"

#include <vector>

namespace osculate::linear {

/// Compressed block rows, columns ascending; blocks are column-major 3 x 3.
class BlockMatrix {
public:
    BlockMatrix() = default;
    /// Pattern of all node pairs that share an element: `elements` lists the node numbers of each element. Cost
    /// O(nonzeros log(neighbours)).
    BlockMatrix(Index nodes, const std::vector<std::vector<Index>>& elements);
    /// Pattern of given rows.
    /// @param columns  of each row, ascending
    explicit BlockMatrix(const std::vector<std::vector<Index>>& columns);

    [[nodiscard]] Index rows() const { return static_cast<Index>(row_start_.size()) - 1; }
    [[nodiscard]] Index row_begin(Index row) const { return row_start_[row]; }
    [[nodiscard]] Index row_end(Index row) const { return row_start_[row + 1]; }
    [[nodiscard]] Index column(Index slot) const { return column_[slot]; }
    [[nodiscard]] const Mat3& block(Index slot) const { return block_[slot]; }
    [[nodiscard]] Mat3& block(Index slot) { return block_[slot]; }
    /// Position of the block of a pair of nodes. @pre the pattern has it
    [[nodiscard]] Index slot(Index row, Index column) const;
    /// Adds an element matrix (3n x 3n) at its nodes.
    void add(const std::vector<Index>& nodes, const Matrix& element);
    /// *this = a A + b B, where B has the same pattern or is empty.
    void set_combination(double a, const BlockMatrix& A, double b, const BlockMatrix& B);
    void set_zero();
    [[nodiscard]] bool empty() const { return block_.empty(); }
    [[nodiscard]] solve::NodalMatrix view() const { return {row_start_, column_, block_}; }
    /// y += A x over 3-vectors per node.
    void multiply_add(const Field& x, Field& y, int threads) const;
    /// y_i += A_ij (x_j - x_i), which is A x if the blocks of each row sum to zero, as in a stiffness: a translation of
    /// all nodes causes no further loss of digits than in x itself.
    void multiply_add_relative(const Field& x, Field& y, int threads) const;

private:
    std::vector<Index> row_start_{0};
    std::vector<Index> column_;
    std::vector<Mat3> block_;
};

} // namespace osculate::linear
