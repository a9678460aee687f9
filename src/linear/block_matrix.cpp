#include "osculate/linear/block_matrix.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/parallel.hpp"

#include <algorithm>
#include <utility>

namespace osculate::linear {

Lists neighbours(Index nodes, const Lists& elements) {
    std::vector<Index> element_of(elements.number.size());
    for (std::size_t e = 0; e < elements.size(); ++e)
        std::fill(element_of.begin() + elements.start[e], element_of.begin() + elements.start[e + 1],
                  static_cast<Index>(e));
    const Lists places = places_of(elements.number, static_cast<std::size_t>(nodes));
    std::vector<Index> met(static_cast<std::size_t>(nodes), -1); // the last node, or its complement, that met each
    const auto each = [&](std::size_t node, Index mark, const auto& f) {
        for (const Index place : places[node])
            for (const Index other : elements[static_cast<std::size_t>(element_of[place])])
                if (std::exchange(met[other], mark) != mark) f(other);
    };
    Lists rows;
    rows.start.reserve(places.size() + 1);
    Index length = 0;
    for (std::size_t node = 0; node < places.size(); ++node) {
        each(node, static_cast<Index>(node), [&](Index) { ++length; });
        rows.start.push_back(length);
    }
    rows.number.reserve(static_cast<std::size_t>(length));
    for (std::size_t node = 0; node < places.size(); ++node) {
        each(node, -2 - static_cast<Index>(node), [&](Index other) { rows.number.push_back(other); });
        std::sort(rows.number.begin() + rows.start[node], rows.number.end());
    }
    return rows;
}

BlockMatrix::BlockMatrix(Index nodes, const std::vector<std::vector<Index>>& elements)
    : BlockMatrix(neighbours(nodes, elements)) {}

BlockMatrix::BlockMatrix(Lists columns, std::shared_ptr<const Share> share) : share_(std::move(share)) {
    if (share_ == nullptr) {
        row_start_ = std::move(columns.start);
        column_ = std::move(columns.number);
    } else {
        row_start_.reserve(columns.size() + 1);
        for (std::size_t row = 0; row < columns.size(); ++row) {
            if (has_row(static_cast<Index>(row)))
                column_.insert(column_.end(), columns[row].begin(), columns[row].end());
            row_start_.push_back(static_cast<Index>(column_.size()));
        }
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
        for (Index j = 0; j < n && row_begin(nodes[i]) < row_end(nodes[i]); ++j)
            block_[slot(nodes[i], nodes[j])] += element.block<3, 3>(3 * i, 3 * j);
}

void BlockMatrix::set_combination(double a, const BlockMatrix& A, double b, const BlockMatrix& B) {
    if (row_start_ != A.row_start_ || column_ != A.column_) {
        row_start_ = A.row_start_;
        column_ = A.column_;
        block_.resize(column_.size());
        share_ = A.share_;
    }
    if (B.empty()) {
        for (std::size_t k = 0; k < block_.size(); ++k) block_[k] = a * A.block_[k];
        return;
    }
    require(B.column_.size() == column_.size(), "set_combination: patterns differ");
    for (std::size_t k = 0; k < block_.size(); ++k) block_[k] = a * A.block_[k] + b * B.block_[k];
}

Field BlockMatrix::diagonal() const {
    Field result(static_cast<std::size_t>(rows()));
    for (Index i = 0; i < rows(); ++i)
        if (row_begin(i) < row_end(i)) result[static_cast<std::size_t>(i)] = block(slot(i, i)).diagonal();
    if (share_ != nullptr) share_->replicate(result);
    return result;
}

template <class Row> void BlockMatrix::add_rows(Field& y, int threads, Row&& row) const {
    if (share_ == nullptr)
        return parallel_for(threads, rows(), [&](Index begin, Index end) {
            for (Index i = begin; i < end; ++i) y[i] += row(i);
        });
    const std::span<const Index> own = share_->nodes_of(share_->ranks().rank());
    std::vector<Vec3> product(own.size(), Vec3::Zero());
    parallel_for(threads, static_cast<Index>(own.size()), [&](Index begin, Index end) {
        for (Index k = begin; k < end; ++k) product[k] += row(own[k]);
    });
    share_->add(product, y);
}

Vec3 BlockMatrix::product(Index row, const Field& x) const {
    Vec3 sum = Vec3::Zero();
    for (Index k = row_start_[row]; k < row_start_[row + 1]; ++k) sum.noalias() += block_[k] * x[column_[k]];
    return sum;
}

void BlockMatrix::multiply_add(const Field& x, Field& y, int threads) const {
    add_rows(y, threads, [&](Index row) { return product(row, x); });
}

void BlockMatrix::multiply_add(std::span<const Index> rows, const Field& x, Field& y, int threads) const {
    parallel_for(threads, static_cast<Index>(rows.size()), [&](Index begin, Index end) {
        for (Index k = begin; k < end; ++k) y[rows[k]] += product(rows[k], x);
    });
}

void BlockMatrix::multiply_add_relative(const Field& x, Field& y, int threads) const {
    add_rows(y, threads, [&](Index row) {
        Vec3 sum = Vec3::Zero();
        for (Index k = row_start_[row]; k < row_start_[row + 1]; ++k)
            sum.noalias() += block_[k] * (x[column_[k]] - x[row]);
        return sum;
    });
}

} // namespace osculate::linear
