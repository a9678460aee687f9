#include "osculate/linear/block_matrix.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/parallel.hpp"

#include <algorithm>

namespace osculate::linear {

BlockMatrix::BlockMatrix(Index nodes, const std::vector<std::vector<Index>>& elements) {
    std::vector<std::vector<Index>> neighbours(static_cast<std::size_t>(nodes));
    for (const auto& element : elements)
        for (const Index i : element) neighbours[i].insert(neighbours[i].end(), element.begin(), element.end());
    row_start_.assign(1, 0);
    row_start_.reserve(static_cast<std::size_t>(nodes) + 1);
    for (auto& row : neighbours) {
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        column_.insert(column_.end(), row.begin(), row.end());
        row_start_.push_back(static_cast<Index>(column_.size()));
        std::vector<Index>().swap(row);
    }
    block_.assign(column_.size(), Mat3::Zero());
}

BlockMatrix::BlockMatrix(const std::vector<std::vector<Index>>& columns) {
    for (const std::vector<Index>& row : columns) {
        column_.insert(column_.end(), row.begin(), row.end());
        row_start_.push_back(static_cast<Index>(column_.size()));
    }
    set_zero();
}

void BlockMatrix::set_zero() {
    block_.assign(column_.size(), Mat3::Zero());
}

Index BlockMatrix::slot(Index row, Index column) const {
    const auto end = column_.begin() + row_start_[row + 1];
    const auto found = std::lower_bound(column_.begin() + row_start_[row], end, column);
    require(found != end && *found == column, "a block matrix was asked for a block that its pattern lacks");
    return static_cast<Index>(found - column_.begin());
}

void BlockMatrix::add(const std::vector<Index>& nodes, const Matrix& element) {
    const auto n = static_cast<Index>(nodes.size());
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) block_[slot(nodes[i], nodes[j])] += element.block<3, 3>(3 * i, 3 * j);
}

void BlockMatrix::set_combination(double a, const BlockMatrix& A, double b, const BlockMatrix& B) {
    if (row_start_ != A.row_start_ || column_ != A.column_) {
        row_start_ = A.row_start_;
        column_ = A.column_;
        block_.resize(column_.size());
    }
    if (B.empty()) {
        for (std::size_t k = 0; k < block_.size(); ++k) block_[k] = a * A.block_[k];
        return;
    }
    require(B.column_.size() == column_.size(), "set_combination: patterns differ");
    for (std::size_t k = 0; k < block_.size(); ++k) block_[k] = a * A.block_[k] + b * B.block_[k];
}

void BlockMatrix::multiply_add(const Field& x, Field& y, int threads) const {
    parallel_for(threads, rows(), [&](Index begin, Index end) {
        for (Index row = begin; row < end; ++row) {
            Vec3 sum = Vec3::Zero();
            for (Index k = row_start_[row]; k < row_start_[row + 1]; ++k) sum.noalias() += block_[k] * x[column_[k]];
            y[row] += sum;
        }
    });
}

void BlockMatrix::multiply_add_relative(const Field& x, Field& y, int threads) const {
    parallel_for(threads, rows(), [&](Index begin, Index end) {
        for (Index row = begin; row < end; ++row) {
            Vec3 sum = Vec3::Zero();
            for (Index k = row_start_[row]; k < row_start_[row + 1]; ++k)
                sum.noalias() += block_[k] * (x[column_[k]] - x[row]);
            y[row] += sum;
        }
    });
}

} // namespace osculate::linear
