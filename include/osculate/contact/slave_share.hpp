#pragma once
/// Which process evaluates which slave nodes of a pair, where several share a run.

#include "osculate/core/ranks.hpp"

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

    /// Gives all processes numbers of every slave node. Collective.
    /// @param pack    pack(j, numbers) appends those of an own slave node
    /// @param unpack  unpack(j, at) takes those of another process' node from `at` on, and returns where they end
    template <class Pack, class Unpack> void exchange(Pack&& pack, Unpack&& unpack) const;

private:
    /// (all) numbers of rank 0, then those of rank 1, ..., and where those of each begin, (ranks + 1).
    struct Gathered {
        std::vector<double> numbers;
        std::vector<std::size_t> first;
    };
    [[nodiscard]] Gathered gathered(std::span<const double> own) const;

    Ranks* ranks_;
    std::vector<Index> first_; ///< (ranks + 1) slave nodes of each rank
};

template <class Pack, class Unpack> void SlaveShare::exchange(Pack&& pack, Unpack&& unpack) const {
    std::vector<double> own;
    for (Index j = begin(); j < end(); ++j) pack(j, own);
    const Gathered all = gathered(own);
    for (std::size_t r = 0; r + 1 < first_.size(); ++r) {
        if (static_cast<int>(r) == ranks_->rank()) continue;
        const double* at = all.numbers.data() + all.first[r];
        for (Index j = first_[r]; j < first_[r + 1]; ++j) at = unpack(j, at);
    }
}

} // namespace osculate::contact
