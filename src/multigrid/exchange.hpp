#pragma once
/// Values that other processes own.

#include "multigrid/wait.hpp"
#include "osculate/core/types.hpp"

#include <algorithm>
#include <mpi.h>
#include <vector>

namespace osculate::solve {

/// Numbers, ascending, each once.
inline void make_unique(std::vector<Index>& list) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// Each process sends one list to each, and gets one from each.
template <class Number>
[[nodiscard]] std::vector<std::vector<Number>> send_to_each(const std::vector<std::vector<Number>>& lists) {
    static_assert(std::is_trivially_copyable_v<Number>);
    const std::size_t ranks = lists.size();
    std::vector<int> bytes_out(ranks), bytes_in(ranks), place_out(ranks + 1, 0), place_in(ranks + 1, 0);
    for (std::size_t r = 0; r < ranks; ++r) bytes_out[r] = static_cast<int>(lists[r].size() * sizeof(Number));
    meet();
    MPI_Alltoall(bytes_out.data(), 1, MPI_INT, bytes_in.data(), 1, MPI_INT, MPI_COMM_WORLD);
    for (std::size_t r = 0; r < ranks; ++r) {
        place_out[r + 1] = place_out[r] + bytes_out[r];
        place_in[r + 1] = place_in[r] + bytes_in[r];
    }
    std::vector<Number> out, in(static_cast<std::size_t>(place_in.back()) / sizeof(Number));
    for (const auto& list : lists) out.insert(out.end(), list.begin(), list.end());
    MPI_Alltoallv(out.data(), bytes_out.data(), place_out.data(), MPI_BYTE, in.data(), bytes_in.data(), place_in.data(),
                  MPI_BYTE, MPI_COMM_WORLD);
    std::vector<std::vector<Number>> result(ranks);
    for (std::size_t r = 0; r < ranks; ++r)
        result[r].assign(in.begin() + place_in[r] / static_cast<int>(sizeof(Number)),
                         in.begin() + place_in[r + 1] / static_cast<int>(sizeof(Number)));
    return result;
}

/// The same sum on all processes, in the order of ranks.
[[nodiscard]] std::vector<double> sum_over_ranks(const std::vector<double>& own);

[[nodiscard]] double largest_over_ranks(double own);

/// Sends lists to those that have something to receive, and receives from those that send, in lists of the lengths that come.
void send_and_receive(const std::vector<std::vector<double>>& out, std::vector<std::vector<double>>& in);

/// Copies of what others own, behind one's own. Nothing is sent by a process that is alone.
class Exchange {
public:
    Exchange() = default;
    /// @param own     numbers of one's own, by place, ascending; the same numbers name the same things everywhere
    /// @param ghosts  numbers of others', in the order of their owners
    /// @param owner   (ghosts)
    Exchange(const std::vector<Index>& own, const std::vector<Index>& ghosts, const std::vector<int>& owner);

    [[nodiscard]] bool alone() const { return ranks_ == 0; }
    [[nodiscard]] std::size_t ranks() const { return ranks_; }
    /// Places of what a rank has copies of.
    [[nodiscard]] const std::vector<Index>& sent_to(std::size_t rank) const { return send_[rank]; }
    /// Places of the copies of what a rank owns.
    [[nodiscard]] Index first_from(std::size_t rank) const { return first_[rank]; }
    [[nodiscard]] Index end_from(std::size_t rank) const { return first_[rank + 1]; }
    /// Fills the copies in x, (own and copies) times `width`.
    void fill(double* x, int width) const;
    /// Adds the copies in x to what they are copies of, in the order of ranks.
    void add(double* x, int width) const;

private:
    std::size_t ranks_ = 0;
    std::vector<std::vector<Index>> send_; ///< (ranks) places
    std::vector<Index> first_;             ///< (ranks + 1)
};

} // namespace osculate::solve
