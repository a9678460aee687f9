#include "multigrid/prolongation.hpp"

#include "osculate/core/parallel.hpp"

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
                           const NodalUnknowns& unknowns, int threads)
    : nodes_(nodes), threads_(threads) {
    constexpr Index width = 1 + 3 * modes; // number of its aggregate, and motions
    const Aggregates aggregates = solve::aggregate(nodes, A);
    aggregates_ = aggregates.count;
    std::vector<Index> first_of_rank{0, aggregates_};
    if (!nodes.exchange().alone()) {
        int rank = 0;
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        std::vector<double> counts(nodes.exchange().ranks(), 0.0);
        counts[static_cast<std::size_t>(rank)] = aggregates_;
        first_of_rank.assign(1, 0);
        for (const double count : sum_over_ranks(counts))
            first_of_rank.push_back(first_of_rank.back() + static_cast<Index>(count));
        first_number_ = first_of_rank[static_cast<std::size_t>(rank)];
    }
    std::vector<std::vector<Index>> members(static_cast<std::size_t>(aggregates_));
    for (Index i = 0; i < nodes.size(); ++i) members[aggregates.of[i]].push_back(i);
    Matrix motions(modes * aggregates_, modes);
    std::vector<Index> body(static_cast<std::size_t>(aggregates_));
    Matrix tentative(width, nodes.with_copies());
    for (Index a = 0; a < aggregates_; ++a) {
        Matrix B(3 * static_cast<Index>(members[a].size()), modes);
        for (std::size_t m = 0; m < members[a].size(); ++m)
            B.middleRows<3>(3 * static_cast<Index>(m)) =
                nodes.projection(members[a][m]) * unknowns.motions(nodes.place(members[a][m]));
        body[a] = unknowns.body[nodes.place(members[a].front())];
        orthonormalise(B, motions.middleRows<modes>(modes * a));
        for (std::size_t m = 0; m < members[a].size(); ++m) {
            auto column = tentative.col(members[a][m]);
            column(0) = first_number_ + a;
            Eigen::Map<Block>(&column(1)) = B.middleRows<3>(3 * static_cast<Index>(m));
        }
    }
    nodes.exchange().fill(tentative.data(), width);
    const auto aggregate_of = [&](Index i) { return static_cast<Index>(tentative(0, i)); };
    const auto tentative_of = [&](Index i) { return Eigen::Map<const Block>(&tentative(1, i)); };

    const double w = 4.0 / 3.0 / grid.largest_eigenvalue();
    Rows rows(static_cast<std::size_t>(nodes.with_copies()));
    parallel_for(threads, nodes.size(), [&](Index begin, Index end) {
        std::vector<Index> reached;
        std::vector<Block> row;
        for (Index i = begin; i < end; ++i) {
            reached.assign(1, aggregate_of(i));
            nodes.for_row(A, i, [&](Index j, const Mat3&) { reached.push_back(aggregate_of(j)); });
            make_unique(reached);
            const auto place = [&](Index a) { return std::ranges::lower_bound(reached, a) - reached.begin(); };
            row.assign(reached.size(), Block::Zero());
            const Mat3 D = w * grid.inverse_diagonal(i);
            row[place(aggregate_of(i))] = tentative_of(i);
            nodes.for_row(A, i, [&](Index j, const Mat3& block) {
                row[place(aggregate_of(j))].noalias() -= D * (block * tentative_of(j));
            });
            for (std::size_t k = 0; k < reached.size(); ++k) rows[i].emplace_back(reached[k], row[k].cast<float>());
        }
    });
    add_copied_rows(nodes.exchange(), rows);
    store(rows, first_of_rank);
    gather_motions(motions, body);
}

void Prolongation::store(const Rows& rows, const std::vector<Index>& first_of_rank) {
    const auto own = [&](Index number) { return number >= first_number_ && number < first_number_ + aggregates_; };
    std::vector<Index> copied;
    for (const auto& row : rows)
        for (const auto& entry : row)
            if (!own(entry.first)) copied.push_back(entry.first);
    make_unique(copied);
    for (Index a = 0; a < aggregates_; ++a) number_.push_back(first_number_ + a);
    if (!nodes_.exchange().alone()) {
        std::vector<int> owner;
        for (const Index number : copied)
            owner.push_back(static_cast<int>(std::ranges::upper_bound(first_of_rank, number) - first_of_rank.begin()) -
                            1);
        exchange_ = Exchange(number_, copied, owner);
    }
    number_.insert(number_.end(), copied.begin(), copied.end());
    std::size_t entries = 0;
    for (const auto& row : rows) entries += row.size();
    start_.reserve(rows.size() + 1);
    aggregate_.reserve(entries);
    value_.reserve(stored * entries);
    for (const auto& row : rows) {
        for (const auto& [number, block] : row) {
            aggregate_.push_back(
                own(number)
                    ? number - first_number_
                    : aggregates_ + static_cast<Index>(std::ranges::lower_bound(copied, number) - copied.begin()));
            value_.insert(value_.end(), block.data(), block.data() + stored);
        }
        start_.push_back(static_cast<Index>(aggregate_.size()));
    }
}

void Prolongation::gather_motions(const Matrix& own, const std::vector<Index>& body) {
    near_kernel_ = own;
    body_ = body;
    if (nodes_.exchange().alone()) return;
    constexpr Index width = 1 + modes * modes;
    std::vector<double> list;
    for (Index a = 0; a < aggregates_; ++a) {
        list.push_back(body[a]);
        for (Index k = 0; k < modes; ++k)
            for (Index c = 0; c < modes; ++c) list.push_back(own(modes * a + k, c));
    }
    body_.clear();
    std::vector<double> all;
    for (const auto& one : send_to_each(std::vector<std::vector<double>>(nodes_.exchange().ranks(), list)))
        all.insert(all.end(), one.begin(), one.end());
    near_kernel_.resize(modes * static_cast<Index>(all.size()) / width, modes);
    for (std::size_t a = 0; a < all.size() / width; ++a) {
        body_.push_back(static_cast<Index>(all[width * a]));
        near_kernel_.middleRows<modes>(modes * static_cast<Index>(a)) =
            Eigen::Map<const Eigen::Matrix<double, modes, modes, Eigen::RowMajor>>(&all[width * a + 1]);
    }
}

void Prolongation::add_to_fine(double* c, double* x) const {
    exchange_.fill(c, modes);
    parallel_for(threads_, nodes_.size(), [&](Index begin, Index end) {
        const float* value = value_.data() + stored * static_cast<std::size_t>(start_[begin]);
        for (Index i = begin; i < end; ++i) {
            Vec3 sum = Vec3::Zero();
            for (Index k = start_[i]; k < start_[i + 1]; ++k) {
                const double* from = c + modes * static_cast<std::size_t>(aggregate_[k]);
                for (Index r = 0; r < 3; ++r)
                    for (Index m = 0; m < modes; ++m) sum(r) += static_cast<double>(*value++) * from[m];
            }
            Eigen::Map<Vec3>(x + 3 * static_cast<std::size_t>(i)) +=
                nodes_.whole(i) ? sum : Vec3(nodes_.projection(i) * sum);
        }
    });
}

void Prolongation::to_coarse(const double* x, double* c) const {
    std::fill_n(c, modes * number_.size(), 0.0);
    // each thread adds up for some of the aggregates, in the order of nodes
    parallel_for(threads_, with_copies(), [&](Index first, Index end) {
        for (Index i = 0; i < nodes_.size(); ++i) {
            Vec3 from = Eigen::Map<const Vec3>(x + 3 * static_cast<std::size_t>(i));
            if (!nodes_.whole(i)) from = (nodes_.projection(i) * from).eval();
            for (Index k = start_[i]; k < start_[i + 1]; ++k) {
                if (aggregate_[k] < first || aggregate_[k] >= end) continue;
                double* to = c + modes * static_cast<std::size_t>(aggregate_[k]);
                const float* value = value_.data() + stored * static_cast<std::size_t>(k);
                for (Index r = 0; r < 3; ++r)
                    for (Index m = 0; m < modes; ++m) to[m] += static_cast<double>(*value++) * from(r);
            }
        }
    });
    exchange_.add(c, modes);
}

} // namespace osculate::solve
