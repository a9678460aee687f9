#pragma once
/// Processes that run one simulation together.

#include "osculate/core/field.hpp"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace osculate {

/// What processes do together. All calls are collective: every process makes them, in the same order.
class Ranks {
public:
    virtual ~Ranks() = default;
    [[nodiscard]] virtual int rank() const = 0;
    [[nodiscard]] virtual int count() const = 0;
    /// Gives all processes the numbers of each.
    /// @param sizes  (count) how many each has
    /// @param all    those of rank 0, then those of rank 1, ...
    virtual void gather(std::span<const double> own, std::span<const int> sizes, double* all) = 0;
    /// The same, from a few ranks at a time, so that the numbers of all need no room.
    /// @param each  called with a rank and its numbers, rank by rank
    /// @param most  numbers at a time, unless one rank has more
    void gather_in_turns(std::span<const double> own, std::span<const int> sizes,
                         const std::function<void(int rank, const double* numbers)>& each, std::size_t most = 200000);
    /// Sends a list to each rank, and gets one from each. An empty list costs no message.
    /// @param out  (count) lists for each
    /// @param in   (count) of the lengths that come
    virtual void exchange(const std::vector<std::vector<double>>& out, std::vector<std::vector<double>>& in) = 0;
    /// Ends the run of all processes once each has called this, with the exit code of its own.
    /// @returns  false where some process still works after `patience` s, or has another code: nothing can be done together then
    [[nodiscard]] virtual bool agree_on_end(int code, double patience) = 0;
    /// Ends all processes, whatever they do.
    [[noreturn]] virtual void abort(int code) = 0;

    /// The largest of a value of each process.
    [[nodiscard]] double largest(double own);
    /// Sums of the values of all processes, in the order of ranks: the same bits on all.
    void sum(std::span<double> values);
    /// The text of one rank, on all. @param own  read on that rank
    [[nodiscard]] std::string said_by(int rank, const std::string& own);

private:
    std::vector<double> some_; ///< kept, as new pages cost more than what is gathered into them
};

/// Which process owns which node. Every process holds the values of all nodes and takes all decisions from them, so that all
/// take the same. What takes far more memory or time than that, matrices above all, has rows at own nodes only.
class Share {
public:
    /// @param owner  (nodes) a rank; the same on all processes
    Share(std::shared_ptr<Ranks> ranks, std::vector<int> owner);

    [[nodiscard]] Ranks& ranks() const { return *ranks_; }
    [[nodiscard]] const std::vector<int>& owner() const { return owner_; }
    [[nodiscard]] bool owns(Index node) const { return owner_[static_cast<std::size_t>(node)] == ranks_->rank(); }
    /// Nodes of a rank, ascending.
    [[nodiscard]] std::span<const Index> nodes_of(int rank) const {
        const auto r = static_cast<std::size_t>(rank);
        return std::span(by_owner_).subspan(static_cast<std::size_t>(begin_[r]),
                                            static_cast<std::size_t>(begin_[r + 1] - begin_[r]));
    }
    /// Takes the values of all nodes from their owners.
    void replicate(Field& field) const;
    /// field += the values of owners. @param own  (own nodes)
    void add(const std::vector<Vec3>& own, Field& field) const;
    /// Whether all processes hold the same bits.
    [[nodiscard]] bool agree(const Field& field) const;

private:
    /// Calls each(node, value) with the values of owners.
    template <class Each> void for_each(const std::vector<Vec3>& own, Each&& each) const;

    std::shared_ptr<Ranks> ranks_;
    std::vector<int> owner_;
    std::vector<Index> by_owner_; ///< nodes of rank 0, of rank 1, ...
    std::vector<int> begin_;      ///< (ranks + 1) in by_owner_
};

} // namespace osculate
