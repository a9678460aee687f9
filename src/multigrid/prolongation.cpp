#include "multigrid/prolongation.hpp"

#include <algorithm>

namespace osculate::solve {
namespace {

/// Orthonormal columns by Gram and Schmidt: Q R = B. A column that depends on those before it gets zeros in Q and in its row of
/// R, as aggregates of one or two nodes have fewer motions than six.
void orthonormalise(Matrix& B, Eigen::Ref<Matrix> R) {
    constexpr double dependent = 1e-8;
    R.setZero();
    for (Index c = 0; c < B.cols(); ++c) {
        const double before = B.col(c).norm();
        for (int twice = 0; twice < 2; ++twice)
            for (Index k = 0; k < c; ++k) {
                const double part = B.col(k).dot(B.col(c));
                R(k, c) += part;
                B.col(c) -= part * B.col(k);
            }
        const double left = B.col(c).norm();
        if (left <= dependent * before || before == 0) {
            B.col(c).setZero();
            continue;
        }
        R(c, c) = left;
        B.col(c) /= left;
    }
}

} // namespace

Prolongation::Prolongation(const FreeNodes& nodes, const NodalMatrix& A, const FineGrid& grid,
                           const Matrix& near_kernel)
    : nodes_(nodes) {
    const Aggregates aggregates = solve::aggregate(nodes, A);
    aggregates_ = aggregates.count;
    std::vector<std::vector<Index>> members(static_cast<std::size_t>(aggregates_));
    for (Index i = 0; i < nodes.size(); ++i) members[aggregates.of[i]].push_back(i);
    near_kernel_.resize(modes * aggregates_, near_kernel.cols());
    std::vector<Block> tentative(static_cast<std::size_t>(nodes.size()));
    for (Index a = 0; a < aggregates_; ++a) {
        Matrix B(3 * static_cast<Index>(members[a].size()), modes);
        for (std::size_t m = 0; m < members[a].size(); ++m)
            B.middleRows<3>(3 * static_cast<Index>(m)) =
                nodes.projection(members[a][m]) * near_kernel.middleRows<3>(3 * members[a][m]);
        orthonormalise(B, near_kernel_.middleRows<modes>(modes * a));
        for (std::size_t m = 0; m < members[a].size(); ++m)
            tentative[members[a][m]] = B.middleRows<3>(3 * static_cast<Index>(m));
    }

    const double w = 4.0 / 3.0 / grid.largest_eigenvalue();
    std::vector<Index> reached;
    std::vector<Block> row;
    for (Index i = 0; i < nodes.size(); ++i) {
        reached.assign(1, aggregates.of[i]);
        nodes.for_row(A, i, [&](Index j, const Mat3&) { reached.push_back(aggregates.of[j]); });
        std::ranges::sort(reached);
        reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
        const auto place = [&](Index a) { return std::ranges::lower_bound(reached, a) - reached.begin(); };
        row.assign(reached.size(), Block::Zero());
        const Mat3 D = w * grid.inverse_diagonal(i);
        row[place(aggregates.of[i])] = tentative[i];
        nodes.for_row(A, i, [&](Index j, const Mat3& block) {
            row[place(aggregates.of[j])].noalias() -= D * (block * tentative[j]);
        });
        for (std::size_t k = 0; k < reached.size(); ++k) {
            aggregate_.push_back(reached[k]);
            for (Index e = 0; e < row[k].size(); ++e) value_.push_back(static_cast<float>(row[k].data()[e]));
        }
        start_.push_back(static_cast<Index>(aggregate_.size()));
    }
}

void Prolongation::add_to_fine(const double* c, double* x) const {
    const float* value = value_.data();
    for (Index i = 0; i < nodes_.size(); ++i) {
        Vec3 sum = Vec3::Zero();
        for (Index k = start_[i]; k < start_[i + 1]; ++k) {
            const double* from = c + modes * static_cast<std::size_t>(aggregate_[k]);
            for (Index r = 0; r < 3; ++r)
                for (Index m = 0; m < modes; ++m) sum(r) += static_cast<double>(*value++) * from[m];
        }
        Eigen::Map<Vec3>(x + 3 * static_cast<std::size_t>(i)) +=
            nodes_.whole(i) ? sum : Vec3(nodes_.projection(i) * sum);
    }
}

void Prolongation::to_coarse(const double* x, double* c) const {
    std::fill_n(c, modes * static_cast<std::size_t>(aggregates_), 0.0);
    const float* value = value_.data();
    for (Index i = 0; i < nodes_.size(); ++i) {
        Vec3 from = Eigen::Map<const Vec3>(x + 3 * static_cast<std::size_t>(i));
        if (!nodes_.whole(i)) from = (nodes_.projection(i) * from).eval();
        for (Index k = start_[i]; k < start_[i + 1]; ++k) {
            double* to = c + modes * static_cast<std::size_t>(aggregate_[k]);
            for (Index r = 0; r < 3; ++r)
                for (Index m = 0; m < modes; ++m) to[m] += static_cast<double>(*value++) * from(r);
        }
    }
}

} // namespace osculate::solve
