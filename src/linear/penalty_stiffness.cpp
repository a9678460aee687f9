#include "osculate/linear/penalty_stiffness.hpp"

#include <algorithm>

namespace osculate::linear {

PenaltyStiffness::PenaltyStiffness(const Constraints& constraints, const BlockMatrix& K)
    : constraints_(constraints), K_(&K) {
    matrix_.symmetric_positive_definite = true;
}

Index PenaltyStiffness::slot(Index row, Index column) const {
    const auto begin = block_column_.begin() + block_row_start_[row],
               end = block_column_.begin() + block_row_start_[row + 1];
    const auto found = std::lower_bound(begin, end, column);
    return found == end || *found != column ? -1 : static_cast<Index>(found - block_column_.begin());
}

bool PenaltyStiffness::covers(const std::vector<Spring>& springs) const {
    if (block_row_start_.empty()) return false;
    // rows of the slave alone: pairs of masters belong to one facet, so to one element
    return std::all_of(springs.begin(), springs.end(), [&](const Spring& s) {
        return std::all_of(s.masters.begin(), s.masters.end(), [&](Index i) {
            return slot(s.slave, i) >= 0 &&
                   std::all_of(s.masters.begin(), s.masters.end(), [&](Index k) { return slot(i, k) >= 0; });
        });
    });
}

void PenaltyStiffness::build_pattern(const std::vector<Spring>& springs) {
    const Index nodes = constraints_.nodes();
    std::vector<std::vector<Index>> columns(static_cast<std::size_t>(nodes));
    for (Index node = 0; node < nodes; ++node)
        for (Index k = K_->row_begin(node); k < K_->row_end(node); ++k) columns[node].push_back(K_->column(k));
    for (const Spring& s : springs) {
        std::vector<Index> reached = s.masters;
        reached.push_back(s.slave);
        for (const Index i : reached) columns[i].insert(columns[i].end(), reached.begin(), reached.end());
    }
    block_row_start_.assign(1, 0);
    block_column_.clear();
    block_offset_.clear();
    matrix_.row_start.assign(1, 0);
    matrix_.column.clear();
    for (Index node = 0; node < nodes; ++node) {
        auto& row = columns[node];
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        Index offset = 0;
        for (const Index column : row) {
            block_column_.push_back(column);
            block_offset_.push_back(offset);
            offset += constraints_.free_components(column);
        }
        block_row_start_.push_back(static_cast<Index>(block_column_.size()));
        for (int r = 0; r < constraints_.free_components(node); ++r) {
            for (const Index column : row)
                for (int c = 0; c < 3; ++c)
                    if (const Index e = constraints_.equation(column, c); e != Constraints::held)
                        matrix_.column.push_back(e);
            matrix_.row_start.push_back(static_cast<solve::SparseIndex>(matrix_.column.size()));
        }
    }
    matrix_.pattern = ++patterns_;
    pattern_springs_ = springs;
}

void PenaltyStiffness::restore_pattern() {
    const auto same = [](const Spring& a, const Spring& b) { return a.slave == b.slave && a.masters == b.masters; };
    if (block_row_start_.empty() || std::ranges::equal(pattern_springs_, kept_, same)) return;
    build_pattern(std::vector<Spring>(kept_));
    fill_base();
}

void PenaltyStiffness::add(Index row, Index column, const Mat3& global, std::vector<double>& into) const {
    Mat3 value = global;
    if (constraints_.turned(row)) value = constraints_.frame(row).transpose() * value;
    if (constraints_.turned(column)) value = value * constraints_.frame(column);
    Index offset = block_offset_[slot(row, column)];
    for (int c = 0; c < 3; ++c) {
        if (constraints_.equation(column, c) == Constraints::held) continue;
        for (int r = 0; r < 3; ++r)
            if (const Index e = constraints_.equation(row, r); e != Constraints::held)
                into[matrix_.row_start[e] + offset] += value(r, c);
        ++offset;
    }
}

std::vector<double> PenaltyStiffness::values_of(const BlockMatrix& K) const {
    std::vector<double> values(matrix_.column.size(), 0.0);
    for (Index node = 0; node < constraints_.nodes(); ++node)
        for (Index k = K.row_begin(node); k < K.row_end(node); ++k) add(node, K.column(k), K.block(k), values);
    return values;
}

void PenaltyStiffness::stiffness_changed() {
    if (!block_row_start_.empty()) fill_base();
}

void PenaltyStiffness::set_springs(const std::vector<Spring>& springs) {
    if (!covers(springs)) {
        build_pattern(springs);
        fill_base();
    }
    matrix_.value = base_;
    for (const Spring& s : springs)
        for_each_block(s, [&](Index row, Index column, const Mat3& block) { add(row, column, block, matrix_.value); });
    ++matrix_.revision;
}

} // namespace osculate::linear
