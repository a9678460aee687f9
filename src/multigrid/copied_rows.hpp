#pragma once
/// Rows of interpolations that other processes own.

#include "multigrid/exchange.hpp"

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace osculate::solve {

/// (rows) blocks by numbers of aggregates
template <class Block> using InterpolationRows = std::vector<std::vector<std::pair<Index, Block>>>;

/// Takes the rows of copies from their owners.
/// @param rows  of one's own, then of copies, which are empty
template <class Block> void add_copied_rows(const Exchange& exchange, InterpolationRows<Block>& rows) {
    if (exchange.alone()) return;
    constexpr int height = Block::RowsAtCompileTime, width = Block::ColsAtCompileTime;
    using Sent = Eigen::Matrix<double, height, width, Eigen::RowMajor>;
    static_assert(Block::IsRowMajor);
    constexpr std::size_t entries = height * width;
    std::vector<std::vector<double>> lists(exchange.ranks());
    for (std::size_t r = 0; r < lists.size(); ++r)
        for (const Index i : exchange.sent_to(r)) {
            lists[r].push_back(static_cast<double>(rows[i].size()));
            for (const auto& [number, block] : rows[i]) {
                lists[r].push_back(number);
                lists[r].insert(lists[r].end(), block.data(), block.data() + entries);
            }
        }
    const auto received = send_to_each(lists);
    for (std::size_t r = 0; r < received.size(); ++r) {
        const double* from = received[r].data();
        for (Index i = exchange.first_from(r); i < exchange.end_from(r); ++i)
            for (auto left = static_cast<Index>(*from++); left > 0; --left, from += 1 + entries)
                rows[i].emplace_back(static_cast<Index>(from[0]),
                                     Eigen::Map<const Sent>(from + 1).template cast<typename Block::Scalar>());
    }
}

} // namespace osculate::solve
