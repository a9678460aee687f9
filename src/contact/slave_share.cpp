#include "osculate/contact/slave_share.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace osculate::contact {

SlaveShare::SlaveShare(Ranks& ranks, Index slaves)
    : ranks_(&ranks), first_(static_cast<std::size_t>(ranks.count()) + 1, slaves) {
    first_.front() = 0;
}

void SlaveShare::share_out(std::span<const int> work) {
    const long all = std::accumulate(work.begin(), work.end(), 0L);
    const auto ranks = static_cast<long>(first_.size()) - 1, slaves = static_cast<long>(work.size());
    long done = 0, rank = 1;
    for (long j = 0; j < slaves; ++j) {
        // the next rank begins where at least its part of the work is done
        for (; rank < ranks && done * ranks >= rank * all; ++rank)
            first_[static_cast<std::size_t>(rank)] = static_cast<Index>(j);
        done += work[static_cast<std::size_t>(j)];
    }
    for (; rank <= ranks; ++rank) first_[static_cast<std::size_t>(rank)] = static_cast<Index>(slaves);
}

int SlaveShare::owner(Index j) const {
    return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), j) - first_.begin()) - 1;
}

void SlaveShare::gather_some(Index nodes, std::span<const double> own,
                             const std::function<void(int rank, Index nodes, const double* numbers)>& each) const {
    const std::size_t ranks = first_.size() - 1;
    const std::array counts{static_cast<double>(nodes), static_cast<double>(own.size())};
    std::vector<double> of_each(2 * ranks);
    ranks_->gather(counts, std::vector<int>(ranks, 2), of_each.data());
    std::vector<int> sizes;
    for (std::size_t r = 0; r < ranks; ++r) sizes.push_back(static_cast<int>(of_each[2 * r + 1]));
    ranks_->gather_in_turns(
        own, sizes,
        [&](int rank, const double* numbers) {
            each(rank, static_cast<Index>(of_each[2 * static_cast<std::size_t>(rank)]), numbers);
        },
        2 * most);
}

} // namespace osculate::contact
