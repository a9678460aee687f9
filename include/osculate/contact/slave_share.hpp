#pragma once
/// Which process evaluates which slave nodes of a pair, where several share a run.

#include "osculate/core/ranks.hpp"

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

namespace osculate::contact {

/// Each process has neighbours in the numbering of the slave nodes. The others take from it what it finds, so that all
/// hold the same bits, as if each had evaluated every node.
class SlaveShare {
public:
    /// @param slaves  number of slave nodes; all belong to rank 0 until share_out()
    SlaveShare(Ranks& ranks, Index slaves);

    /// Shares them out anew. @param work  (slaves) what each costs, > 0; the same on all processes
    void share_out(std::span<const int> work);
    [[nodiscard]] Ranks& ranks() const { return *ranks_; }
    [[nodiscard]] bool owns(Index j) const { return begin() <= j && j < end(); }
    [[nodiscard]] int owner(Index j) const;
    /// Number of slave nodes of a rank.
    [[nodiscard]] Index size(int rank) const {
        return first_[static_cast<std::size_t>(rank) + 1] - first_[static_cast<std::size_t>(rank)];
    }
    /// Own slave nodes: from begin() to before end().
    [[nodiscard]] Index begin() const { return first_[static_cast<std::size_t>(ranks_->rank())]; }
    [[nodiscard]] Index end() const { return first_[static_cast<std::size_t>(ranks_->rank()) + 1]; }

    /// Gives all processes numbers of every slave node, those of some nodes of each process at a time: the numbers of all
    /// are as large as what they are for. Collective.
    /// @param pack    pack(j, numbers) appends those of an own slave node
    /// @param unpack  unpack(j, at) takes those of another process' node from `at` on, and returns where they end
    template <class Pack, class Unpack> void exchange(Pack&& pack, Unpack&& unpack) const;

private:
    /// Gathers numbers of some slave nodes of each process.
    /// @param nodes  of how many these are
    /// @param each   called with a rank, of how many slave nodes it has told, and their numbers, rank by rank
    void gather_some(Index nodes, std::span<const double> own,
                     const std::function<void(int rank, Index nodes, const double* numbers)>& each) const;

    /// Numbers of all processes at a time, unless those of one node of each are more.
    static constexpr std::size_t most = 1 << 19;

    Ranks* ranks_;
    std::vector<Index> first_; ///< (ranks + 1) slave nodes of each rank
};

template <class Pack, class Unpack> void SlaveShare::exchange(Pack&& pack, Unpack&& unpack) const {
    const int self = ranks_->rank();
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    std::vector<double> own;
    while (!std::equal(next.begin(), next.end(), first_.begin() + 1)) {
        own.clear();
        Index packed = next[static_cast<std::size_t>(self)];
        const Index first = packed;
        while (packed < end() && own.size() < most / next.size()) pack(packed++, own);
        gather_some(packed - first, own, [&](int rank, Index nodes, const double* at) {
            Index& j = next[static_cast<std::size_t>(rank)];
            const Index last = j + nodes;
            if (rank == self) j = last;
            while (j < last) at = unpack(j++, at);
        });
    }
}

} // namespace osculate::contact
