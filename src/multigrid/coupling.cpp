#include "multigrid/coupling.hpp"

namespace osculate::solve {

Coupling::Coupling(const FreeNodes& nodes, std::span<const NodalBlock> blocks) {
    // blocks of a row one after the other, in their order
    std::vector<std::size_t> begin(static_cast<std::size_t>(nodes.size()) + 1, 0);
    const auto counts = [&](const NodalBlock& b) {
        const Index row = nodes.number(b.row);
        return row >= 0 && row < nodes.size() && nodes.number(b.column) >= 0;
    };
    for (const NodalBlock& b : blocks)
        if (counts(b)) ++begin[nodes.number(b.row) + 1];
    for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
    std::vector<const NodalBlock*> by_row(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (const NodalBlock& b : blocks)
        if (counts(b)) by_row[next[nodes.number(b.row)]++] = &b;

    std::vector<Index> place(static_cast<std::size_t>(nodes.with_copies()), -1);
    for (Index i = 0; i < nodes.size(); ++i) {
        if (begin[i] == begin[i + 1]) continue;
        for (std::size_t k = begin[i]; k < begin[i + 1]; ++k) {
            const Index j = nodes.number(by_row[k]->column);
            if (place[j] < start_.back()) {
                place[j] = static_cast<Index>(column_.size());
                column_.push_back(j);
                block_.emplace_back(Mat3::Zero());
            }
            block_[place[j]] += nodes.projected(i, j, by_row[k]->value);
        }
        row_.push_back(i);
        start_.push_back(static_cast<Index>(column_.size()));
    }
}

} // namespace osculate::solve
