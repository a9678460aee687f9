#include "osculate/contact/slave_share.hpp"

#include <algorithm>
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

SlaveShare::Gathered SlaveShare::gathered(std::span<const double> own) const {
    const std::size_t ranks = first_.size() - 1;
    std::vector<double> counts(ranks);
    const auto count = static_cast<double>(own.size());
    ranks_->gather({&count, 1}, std::vector<int>(ranks, 1), counts.data());
    const std::vector<int> sizes(counts.begin(), counts.end());
    Gathered all;
    all.first.assign(1, 0);
    for (const int size : sizes) all.first.push_back(all.first.back() + static_cast<std::size_t>(size));
    all.numbers.resize(all.first.back());
    ranks_->gather(own, sizes, all.numbers.data());
    return all;
}

} // namespace osculate::contact
