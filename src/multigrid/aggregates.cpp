#include "multigrid/aggregates.hpp"

namespace osculate::solve {

Aggregates aggregate(const FreeNodes& nodes, const NodalMatrix& A) {
    constexpr Index none = -1;
    Aggregates result;
    result.of.assign(static_cast<std::size_t>(nodes.size()), none);
    std::vector<Index> neighbours;
    for (Index i = 0; i < nodes.size(); ++i) {
        if (result.of[i] != none) continue;
        neighbours.assign(1, i);
        bool all_left = true;
        nodes.for_row(A, i, [&](Index j, const Mat3&) {
            if (j >= nodes.size()) return;
            neighbours.push_back(j);
            all_left = all_left && result.of[j] == none;
        });
        if (!all_left) continue;
        for (const Index j : neighbours) result.of[j] = result.count;
        ++result.count;
    }
    const std::vector<Index> first = result.of;
    for (Index i = 0; i < nodes.size(); ++i) {
        if (first[i] != none) continue;
        double most = -1;
        nodes.for_row(A, i, [&](Index j, const Mat3& block) {
            if (j >= nodes.size() || first[j] == none || block.squaredNorm() <= most) return;
            most = block.squaredNorm();
            result.of[i] = first[j];
        });
        if (result.of[i] == none) result.of[i] = result.count++; // without neighbours
    }
    return result;
}

} // namespace osculate::solve
