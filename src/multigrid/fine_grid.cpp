#include "multigrid/fine_grid.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace osculate::solve {
namespace {

using Four [[gnu::vector_size(32)]] = double;
using FourSingle [[gnu::vector_size(16)]] = float;

} // namespace

FineGrid::FineGrid(const FreeNodes& nodes, const NodalMatrix& bodies) : nodes_(nodes), start_{0} {
    for (Index i = 0; i < nodes_.size(); ++i) {
        nodes_.for_row(bodies, i, [&](Index j, const Mat3&) { node_.push_back(j); });
        start_.push_back(static_cast<Index>(node_.size()));
    }
    value_.resize(9 * node_.size() + 1); // columns are read four values at a time
    diagonal_.resize(static_cast<std::size_t>(nodes_.size()));
    take(bodies);
}

void FineGrid::take(const NodalMatrix& bodies) {
    float* to = value_.data();
    for (Index i = 0; i < nodes_.size(); ++i)
        nodes_.for_row(bodies, i, [&](Index j, Mat3 block) {
            if (i == j) {
                const double scale = block.trace() > 0 ? block.trace() : 1;
                block += scale * (Mat3::Identity() - nodes_.projection(i));
                diagonal_[i] = block;
            }
            for (Index k = 0; k < 9; ++k) *to++ = static_cast<float>(block(k));
        });
    couple({});
    std::vector<Index> all(static_cast<std::size_t>(size()));
    std::iota(all.begin(), all.end(), 0);
    largest_of_bodies_ = estimate(all);
}

void FineGrid::couple(std::span<const NodalBlock> coupling) {
    coupling_.clear();
    inverse_ = diagonal_;
    for (const NodalBlock& b : coupling) {
        const Index i = nodes_.number(b.row), j = nodes_.number(b.column);
        if (i < 0 || j < 0) continue;
        coupling_.push_back({i, j, nodes_.projected(i, j, b.value)});
        if (i == j) inverse_[i] += coupling_.back().value;
    }
    for (Mat3& D : inverse_) D = D.inverse().eval();

    std::vector<Index> near; // stiff springs show in their nodes and next to them
    for (const NodalBlock& b : coupling_)
        near.insert(near.end(), node_.begin() + start_[b.row], node_.begin() + start_[b.row + 1]);
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    largest_of_coupled_ = near.empty() ? 0 : estimate(near);
}

namespace {

/// The next row of a matrix times x; `value` goes on to the row after it.
[[gnu::always_inline]] inline void multiply_row(std::span<const Index> nodes, const float*& value, const double* x,
                                                double* y) {
    Four sum{};
    for (const Index node : nodes) {
        const double* from = x + 3 * static_cast<std::size_t>(node);
        for (std::size_t k = 0; k < 3; ++k, value += 3) {
            FourSingle column;
            std::memcpy(&column, value, sizeof column); // the fourth is the next column's
            sum += __builtin_convertvector(column, Four) * from[k];
        }
    }
    for (std::size_t k = 0; k < 3; ++k) y[k] = sum[k];
}

} // namespace

[[gnu::target_clones("avx2", "default")]] void FineGrid::multiply(const double* x, double* y) const {
    const float* value = value_.data();
    for (std::size_t i = 0; i + 1 < start_.size(); ++i)
        multiply_row({node_.data() + start_[i], node_.data() + start_[i + 1]}, value, x, y + 3 * i);
    add_coupling(x, y);
}

void FineGrid::multiply_rows(std::span<const Index> rows, const double* x, double* y) const {
    for (const Index i : rows) {
        const float* value = value_.data() + 9 * static_cast<std::size_t>(start_[i]);
        multiply_row({node_.data() + start_[i], node_.data() + start_[i + 1]}, value, x,
                     y + 3 * static_cast<std::size_t>(i));
    }
}

void FineGrid::add_coupling(const double* x, double* y) const {
    for (const NodalBlock& b : coupling_)
        Eigen::Map<Vec3>(y + 3 * static_cast<std::size_t>(b.row)) +=
            b.value * Eigen::Map<const Vec3>(x + 3 * static_cast<std::size_t>(b.column));
}

void FineGrid::scale(const double* x, double* y) const {
    for (std::size_t i = 0; i < inverse_.size(); ++i)
        Eigen::Map<Vec3>(y + 3 * i) = inverse_[i] * Eigen::Map<const Vec3>(x + 3 * i);
}

double FineGrid::estimate(std::span<const Index> rows) const {
    constexpr int iterations = 12;
    constexpr double short_of_it = 1.1; // what these iterations lack
    Vector x = Vector::Zero(3 * size()), y(x.size());
    const auto at = [](Vector& v, Index i) { return v.segment<3>(3 * i); };
    for (const Index i : rows)
        for (Index k = 0; k < 3; ++k) at(x, i)(k) = std::sin(1.0 + 7.0 * (3 * i + k)); // rich in all frequencies
    double largest = 0;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        double squares = 0;
        for (const Index i : rows) squares += at(x, i).squaredNorm();
        largest = std::sqrt(squares);
        for (const Index i : rows) at(x, i) /= largest;
        multiply_rows(rows, x.data(), y.data());
        add_coupling(x.data(), y.data());
        for (const Index i : rows) at(x, i) = inverse_[i] * at(y, i);
    }
    return short_of_it * largest;
}

} // namespace osculate::solve
