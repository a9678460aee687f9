#include "multigrid/single_blocks.hpp"

#include <algorithm>
#include <cstring>

namespace osculate::solve {
namespace {

using Four [[gnu::vector_size(32)]] = double;
using FourSingle [[gnu::vector_size(16)]] = float;

} // namespace

SingleBlocks::SingleBlocks(const std::vector<PetscInt>& row_start, const std::vector<PetscInt>& column) : start_{0} {
    std::vector<PetscInt> nodes;
    for (std::size_t row = 0; row + 1 < row_start.size(); row += 3) {
        nodes.clear();
        for (PetscInt k = row_start[row]; k < row_start[row + 3]; ++k)
            if (nodes.empty() || nodes.back() != column[k] / 3) nodes.push_back(column[k] / 3);
        std::ranges::sort(nodes);
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        node_.insert(node_.end(), nodes.begin(), nodes.end());
        start_.push_back(static_cast<PetscInt>(node_.size()));
    }
    value_.resize(9 * node_.size() + 1); // columns are read four values at a time
}

void SingleBlocks::set(const std::vector<PetscInt>& row_start, const std::vector<PetscInt>& column,
                       const std::vector<double>& value) {
    std::ranges::fill(value_, 0.0F); // components that are held have no entries
    for (std::size_t node = 0; node + 1 < start_.size(); ++node)
        for (std::size_t i = 0; i < 3; ++i) {
            PetscInt block = start_[node];
            for (PetscInt k = row_start[3 * node + i]; k < row_start[3 * node + i + 1]; ++k) {
                while (node_[block] < column[k] / 3) ++block;
                value_[9 * static_cast<std::size_t>(block) + 3 * static_cast<std::size_t>(column[k] % 3) + i] =
                    static_cast<float>(value[k]);
            }
        }
}

[[gnu::target_clones("avx2", "default")]] void SingleBlocks::multiply(const double* x, double* y) const {
    const float* value = value_.data();
    for (std::size_t node = 0; node + 1 < start_.size(); ++node) {
        Four sum{};
        for (PetscInt block = start_[node]; block < start_[node + 1]; ++block) {
            const double* from = x + 3 * static_cast<std::size_t>(node_[block]);
            for (std::size_t k = 0; k < 3; ++k, value += 3) {
                FourSingle column;
                std::memcpy(&column, value, sizeof column); // the fourth is the next column's
                sum += __builtin_convertvector(column, Four) * from[k];
            }
        }
        for (std::size_t k = 0; k < 3; ++k) y[3 * node + k] = sum[k];
    }
}

} // namespace osculate::solve
