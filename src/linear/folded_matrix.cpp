#include "osculate/linear/folded_matrix.hpp"

#include "osculate/core/error.hpp"

#include <algorithm>

namespace osculate::linear {

FoldedMatrix::FoldedMatrix(const Dependence& dependence, const BlockMatrix& pattern)
    : dependence_(dependence), plain_(static_cast<std::size_t>(pattern.rows()), 1) {
    std::vector<std::vector<Index>> columns(plain_.size());
    std::vector<Index> row;
    for (Index i = 0; i < pattern.rows(); ++i) {
        row.clear();
        char& plain = plain_[static_cast<std::size_t>(i)];
        plain = dependence.depends(i) ? 0 : 1;
        for (Index k = pattern.row_begin(i); k < pattern.row_end(i); ++k) {
            const Index j = pattern.column(k);
            if (!dependence.depends(j)) {
                row.push_back(j);
                continue;
            }
            plain = 0;
            if (dependence.owns(j)) row.push_back(j);
            for (const Dependence::Carrier& carrier : dependence.carriers(j)) row.push_back(carrier.node);
        }
        const auto add_to = [&](Index node) {
            auto& list = columns[static_cast<std::size_t>(node)];
            list.insert(list.end(), row.begin(), row.end());
        };
        if (!dependence.depends(i)) {
            add_to(i);
            continue;
        }
        columns[static_cast<std::size_t>(i)].push_back(i);
        if (row.empty()) continue; // of a node without elements, or of another process
        if (dependence.owns(i)) add_to(i);
        for (const Dependence::Carrier& carrier : dependence.carriers(i)) {
            require(pattern.has_row(carrier.node), "a node and one that it follows belong to different processes");
            add_to(carrier.node);
        }
    }
    for (std::vector<Index>& list : columns) {
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    // a carrier may get blocks into its rows that were plain
    for (std::size_t i = 0; i < plain_.size(); ++i)
        if (static_cast<Index>(columns[i].size()) !=
            pattern.row_end(static_cast<Index>(i)) - pattern.row_begin(static_cast<Index>(i)))
            plain_[i] = 0;
    folded_ = BlockMatrix(columns, pattern.shared());
}

BlockMatrix FoldedMatrix::folded(const BlockMatrix& A) const {
    BlockMatrix result = folded_;
    fold(A, result);
    return result;
}

void FoldedMatrix::fold(const BlockMatrix& A, BlockMatrix& into) const {
    into.set_zero();
    const auto add_row = [&](Index node, Index i, const auto& loads) {
        for (Index k = A.row_begin(i); k < A.row_end(i); ++k) {
            const Index j = A.column(k);
            if (!dependence_.depends(j)) {
                into.block(into.slot(node, j)) += loads(A.block(k));
                continue;
            }
            if (dependence_.owns(j)) into.block(into.slot(node, j)) += loads(Mat3(A.block(k) * dependence_.keeps(j)));
            for (const Dependence::Carrier& carrier : dependence_.carriers(j))
                into.block(into.slot(node, carrier.node)) += loads(Mat3(A.block(k) * carrier.moves));
        }
    };
    for (Index i = 0; i < A.rows(); ++i) {
        if (plain_[static_cast<std::size_t>(i)] != 0) {
            for (Index k = A.row_begin(i), to = into.row_begin(i); k < A.row_end(i); ++k, ++to)
                into.block(to) += A.block(k);
        } else if (!dependence_.depends(i)) {
            add_row(i, i, [](const Mat3& block) { return block; });
        } else {
            if (dependence_.owns(i))
                add_row(i, i, [keeps = dependence_.keeps(i)](const Mat3& block) { return Mat3(keeps * block); });
            for (const Dependence::Carrier& carrier : dependence_.carriers(i))
                add_row(carrier.node, i, [&](const Mat3& block) { return Mat3(carrier.loads * block); });
        }
    }
}

bool needs_folding(const Dependence& dependence, const BlockMatrix& pattern) {
    if (pattern.share() != nullptr) return !dependence.nodes().empty(); // the rows of others are not known here
    return std::ranges::any_of(dependence.nodes(),
                               [&](Index node) { return pattern.row_end(node) - pattern.row_begin(node) > 1; });
}

} // namespace osculate::linear
