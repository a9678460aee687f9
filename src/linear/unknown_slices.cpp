#include "osculate/linear/unknown_slices.hpp"

#include <algorithm>

namespace osculate::linear {

template <class Each> void UnknownSlices::for_each(int rank, Each&& each) const {
    for (const Index node : share_.nodes_of(rank))
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held) each(e);
    for (Index j = 0; j < unknowns_.couplings(); ++j)
        if (share_.owner()[static_cast<std::size_t>(unknowns_.slave(j))] == rank)
            for (int k = 0; k < 3; ++k) each(unknowns_.multiplier(j) + k);
}

UnknownSlices::UnknownSlices(const Share& share, const Constraints& constraints, const Unknowns& unknowns,
                             const std::vector<Index>& read, const std::vector<Index>& hubs)
    : share_(share), constraints_(constraints), unknowns_(unknowns) {
    Ranks& ranks = share.ranks();
    for (int r = 0; r < ranks.count(); ++r) {
        int length = 0;
        for_each(r, [&](Index) { ++length; });
        lengths_.push_back(length);
    }
    own_.reserve(static_cast<std::size_t>(lengths_[static_cast<std::size_t>(ranks.rank())]));
    for_each(ranks.rank(), [&](Index place) { own_.push_back(place); });
    for (const Index node : read)
        if (!share.owns(node)) ghosts_.push_back(node);
    std::ranges::sort(ghosts_);
    ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());

    std::vector<std::vector<Index>> of_unknowns(lengths_.size()), of_rows(lengths_.size());
    const auto owner = [&](Index node) {
        return static_cast<std::size_t>(share.owner()[static_cast<std::size_t>(node)]);
    };
    for (const Index node : ghosts_)
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints.equation(node, k); e != Constraints::held)
                of_unknowns[owner(node)].push_back(e);
    for (Index j = 0; j < unknowns.couplings(); ++j) {
        if (share.owns(unknowns.slave(j))) continue;
        for (int k = 0; k < 3; ++k) {
            of_unknowns[owner(unknowns.slave(j))].push_back(unknowns.multiplier(j) + k);
            of_rows[owner(unknowns.slave(j))].push_back(unknowns.contact_row(j, k));
        }
    }
    for (const Index node : hubs)
        for (int k = 0; k < 3 && !share.owns(node); ++k)
            if (const Index row = unknowns.equilibrium_row(node, k); row != Constraints::held)
                of_rows[owner(node)].push_back(row);
    unknowns_read_.emplace(ranks, std::move(of_unknowns));
    rows_read_.emplace(ranks, std::move(of_rows));
}

void UnknownSlices::gather(std::span<const double> own_values, double* x) const {
    share_.ranks().gather_in_turns(own_values, lengths_, [&](int rank, const double* from) {
        for_each(rank, [&](Index place) { x[place] = *from++; });
    });
}

} // namespace osculate::linear
