#pragma once
/// P^T A P in blocks.

#include "multigrid/block_rows.hpp"
#include "osculate/core/parallel.hpp"

namespace osculate::solve {

/// Aggregates that meet in P^T A P: those of a row with those of its neighbours.
/// @param A  size(), for_row(i, each(j, block)) of one's own rows
/// @param P  of rows here and of copies, see Prolongation
template <class Rows, class Interpolation>
[[nodiscard]] BlockRows::Neighbours neighbours_of_product(const Rows& A, const Interpolation& P) {
    BlockRows::Neighbours neighbours(static_cast<std::size_t>(P.with_copies()));
    std::vector<Index> reached;
    for (Index i = 0; i < A.size(); ++i) {
        reached.clear();
        A.for_row(i, [&](Index j, const auto&) {
            for (Index k = P.row_begin(j); k < P.row_end(j); ++k) reached.push_back(P.number(P.aggregate(k)));
        });
        make_unique(reached);
        for (Index k = P.row_begin(i); k < P.row_end(i); ++k) {
            std::vector<Index>& list = neighbours[P.aggregate(k)];
            if (std::ranges::includes(list, reached)) continue;
            list.insert(list.end(), reached.begin(), reached.end());
            make_unique(list);
        }
    }
    return neighbours;
}

/// to += one's own rows' part of P^T A P, node by node, so that A P is held nowhere. Bits do not depend on the threads.
template <class Rows, class Interpolation>
void add_product(const Rows& A, const Interpolation& P, int threads, const BlockRows& pattern, BlockRows::Values& to) {
    /// (A P)_i: the aggregates that a row reaches, and their blocks.
    struct Product {
        std::vector<Index> reached;
        std::vector<typename Interpolation::Block> block;
    };
    const Index at_once = 256 * threads; // rows of A P that are held
    std::vector<Product> rows(static_cast<std::size_t>(std::min(at_once, A.size())));
    for (Index first = 0; first < A.size(); first += at_once) {
        const Index count = std::min(at_once, A.size() - first);
        parallel_for(threads, count, [&](Index begin, Index end) {
            std::vector<Index> place(static_cast<std::size_t>(P.with_copies()), -1);
            for (Index n = begin; n < end; ++n) {
                auto& [reached, product] = rows[n];
                reached.clear();
                product.clear();
                A.for_row(first + n, [&](Index j, const auto& block) {
                    for (Index k = P.row_begin(j); k < P.row_end(j); ++k) {
                        Index& at = place[P.aggregate(k)];
                        if (at < 0) {
                            at = static_cast<Index>(reached.size());
                            reached.push_back(P.aggregate(k));
                            product.emplace_back(Interpolation::Block::Zero());
                        }
                        product[at].noalias() += block * P.block(j, k);
                    }
                });
                for (const Index a : reached) place[a] = -1;
            }
        });
        parallel_lanes(threads, [&](Lane lane) {
            for (Index n = 0; n < count; ++n) {
                const Index i = first + n;
                for (Index k = P.row_begin(i); k < P.row_end(i); ++k) {
                    const Index row = P.aggregate(k);
                    if (!lane.owns(row)) continue;
                    const auto transposed = P.block(i, k).transpose().eval();
                    for (std::size_t m = 0; m < rows[n].reached.size(); ++m)
                        pattern.add(row, P.number(rows[n].reached[m]), transposed * rows[n].block[m], to);
                }
            }
        });
    }
}

} // namespace osculate::solve
