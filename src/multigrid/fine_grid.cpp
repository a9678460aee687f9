#include "multigrid/fine_grid.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>

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
    estimate();
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
}

[[gnu::target_clones("avx2", "default")]] void FineGrid::multiply(const double* x, double* y) const {
    const float* value = value_.data();
    for (std::size_t i = 0; i + 1 < start_.size(); ++i) {
        Four sum{};
        for (Index block = start_[i]; block < start_[i + 1]; ++block) {
            const double* from = x + 3 * static_cast<std::size_t>(node_[block]);
            for (std::size_t k = 0; k < 3; ++k, value += 3) {
                FourSingle column;
                std::memcpy(&column, value, sizeof column); // the fourth is the next column's
                sum += __builtin_convertvector(column, Four) * from[k];
            }
        }
        for (std::size_t k = 0; k < 3; ++k) y[3 * i + k] = sum[k];
    }
    for (const NodalBlock& b : coupling_)
        Eigen::Map<Vec3>(y + 3 * static_cast<std::size_t>(b.row)) +=
            b.value * Eigen::Map<const Vec3>(x + 3 * static_cast<std::size_t>(b.column));
}

void FineGrid::scale(const double* x, double* y) const {
    for (std::size_t i = 0; i < inverse_.size(); ++i)
        Eigen::Map<Vec3>(y + 3 * i) = inverse_[i] * Eigen::Map<const Vec3>(x + 3 * i);
}

void FineGrid::estimate() {
    constexpr int iterations = 12;
    constexpr double short_of_it = 1.1; // what these iterations lack
    Vector x(3 * size()), y(x.size());
    for (Index i = 0; i < x.size(); ++i) x(i) = std::sin(1.0 + 7.0 * i); // rich in all frequencies
    for (int k = 0; k < iterations; ++k) {
        x /= x.norm();
        multiply(x.data(), y.data());
        scale(y.data(), x.data());
        largest_of_bodies_ = short_of_it * x.norm();
    }
}

double FineGrid::largest(Index most_nodes) const {
    double part = 0; // of a node's stiffness that belongs to springs
    for (const NodalBlock& b : coupling_)
        if (b.row == b.column) // D^-1 (D - D_K): its eigenvalues are in [0, 1], its trace is at most their sum
            part = std::max(part, std::min(1.0, 3 - (inverse_[b.row] * diagonal_[b.row]).trace()));
    return std::max(largest_of_bodies_, largest_of_bodies_ + part * (most_nodes - largest_of_bodies_));
}

} // namespace osculate::solve
