#include "multigrid/free_nodes.hpp"

#include <algorithm>
#include <utility>

namespace osculate::solve {

FreeNodes::FreeNodes(const NodalUnknowns& unknowns, const NodalMatrix& A) {
    const auto n = static_cast<Index>(unknowns.node.size());
    number_.assign(n == 0 ? 0 : static_cast<std::size_t>(unknowns.node.back()) + 1, -1);
    if (unknowns.owner.empty()) {
        for (Index place = 0; place < n; ++place) add(unknowns, place);
        own_ = n;
        return;
    }
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    for (Index place = 0; place < n; ++place)
        if (unknowns.owner[place] == rank) add(unknowns, place);
    own_ = static_cast<Index>(node_.size());
    std::vector<Index> copied, place_of(number_.size(), -1); // of nodes of other processes, until one is wanted
    for (Index place = 0; place < n; ++place)
        if (unknowns.owner[place] != rank) place_of[unknowns.node[place]] = place;
    const auto want = [&](Index node) {
        if (node >= static_cast<Index>(place_of.size())) return; // held
        if (const Index place = std::exchange(place_of[node], -1); place >= 0) copied.push_back(place);
    };
    for (Index i = 0; i < own_; ++i)
        for (Index k = A.row_start[node_[i]]; k < A.row_start[node_[i] + 1]; ++k) want(A.column[k]);
    for (const Index node : unknowns.coupled) want(node);
    std::ranges::sort(copied, {}, [&](Index place) { return std::pair(unknowns.owner[place], place); });
    std::vector<int> owner;
    for (const Index place : copied) {
        add(unknowns, place);
        owner.push_back(unknowns.owner[place]);
    }
    exchange_ = Exchange({place_.begin(), place_.begin() + own_}, copied, owner);
}

NodalUnknowns FreeNodes::own(NodalUnknowns all) const {
    NodalUnknowns own;
    own.equation.reserve(3 * static_cast<std::size_t>(own_));
    own.frame_number.reserve(static_cast<std::size_t>(own_));
    for (Index i = 0; i < own_; ++i) {
        const auto place = static_cast<std::size_t>(place_[i]);
        for (std::size_t k = 0; k < 3; ++k) own.equation.push_back(all.equation[3 * place + k]);
        own.frame_number.push_back(all.frame_number[place]);
    }
    own.frames = std::move(all.frames);
    own.hubs = std::move(all.hubs);
    return own;
}

void FreeNodes::add(const NodalUnknowns& unknowns, Index place) {
    number_[unknowns.node[place]] = static_cast<Index>(node_.size());
    node_.push_back(unknowns.node[place]);
    place_.push_back(place);
    Mat3 projection = Mat3::Zero();
    bool whole = true;
    for (Index k = 0; k < 3; ++k)
        if (unknowns.equation[3 * static_cast<std::size_t>(place) + static_cast<std::size_t>(k)] >= 0) {
            const Vec3 axis = unknowns.frame(place).col(k);
            projection += axis * axis.transpose();
        } else
            whole = false;
    if (!whole && (projections_.size() == 1 || projections_.back() != projection)) projections_.push_back(projection);
    projection_number_.push_back(whole ? 0 : static_cast<Index>(projections_.size()) - 1);
}

} // namespace osculate::solve
