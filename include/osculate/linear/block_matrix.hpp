#pragma once
/// Sparse matrix of 3 x 3 blocks over the nodes of all bodies.

#include "osculate/core/lists.hpp"
#include "osculate/core/ranks.hpp"
#include "osculate/solve/nodal_matrix.hpp"

#include <span>
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
    /// @param share    rows of others' nodes stay empty; null: there is one process. Products are of all rows on all processes,
    ///                 but for those of given rows
    explicit BlockMatrix(Lists columns, std::shared_ptr<const Share> share = nullptr);

    [[nodiscard]] Index rows() const { return static_cast<Index>(row_start_.size()) - 1; }
    [[nodiscard]] Index row_begin(Index row) const { return row_start_[row]; }
    [[nodiscard]] Index row_end(Index row) const { return row_start_[row + 1]; }
    [[nodiscard]] Index column(Index slot) const { return column_[slot]; }
    [[nodiscard]] const Mat3& block(Index slot) const { return block_[slot]; }
    [[nodiscard]] Mat3& block(Index slot) { return block_[slot]; }
    /// Position of the block of a pair of nodes. @pre the pattern has it
    [[nodiscard]] Index slot(Index row, Index column) const;
    /// Adds an element matrix (3n x 3n) at its nodes, where they have rows.
    void add(const std::vector<Index>& nodes, const Matrix& element);
    /// *this = a A + b B, where B has the same pattern or is empty.
    void set_combination(double a, const BlockMatrix& A, double b, const BlockMatrix& B);
    void set_zero();
    [[nodiscard]] bool empty() const { return block_.empty(); }
    [[nodiscard]] solve::NodalMatrix view() const { return {row_start_, column_, block_}; }
    /// y += A x over 3-vectors per node.
    void multiply_add(const Field& x, Field& y, int threads) const;
    /// The same at some rows alone, which this process has; on no other process.
    void multiply_add(std::span<const Index> rows, const Field& x, Field& y, int threads) const;
    /// y_i += A_ij (x_j - x_i), which is A x if the blocks of each row sum to zero, as in a stiffness: a translation of
    /// all nodes causes no further loss of digits than in x itself.
    void multiply_add_relative(const Field& x, Field& y, int threads) const;

    /// (rows) of the diagonal blocks, on all processes; 0 where a row is empty.
    [[nodiscard]] Field diagonal() const;

    /// Who has which rows; null: there is one process.
    [[nodiscard]] const Share* share() const { return share_.get(); }
    [[nodiscard]] const std::shared_ptr<const Share>& shared() const { return share_; }
    /// Whether this process has the row of a node.
    [[nodiscard]] bool has_row(Index node) const { return share_ == nullptr || share_->owns(node); }

private:
    [[nodiscard]] Vec3 product(Index row, const Field& x) const;
    /// y += the product whose row is row(i), y_i for those that it has.
    template <class Row> void add_rows(Field& y, int threads, Row&& row) const;

    std::vector<Index> row_start_{0};
    std::vector<Index> column_;
    std::vector<Mat3> block_;
    std::shared_ptr<const Share> share_;
};

/// Nodes that share an element with each node, itself included, ascending; none for nodes without elements.
[[nodiscard]] Lists neighbours(Index nodes, const Lists& elements);

} // namespace osculate::linear
