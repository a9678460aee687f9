#pragma once
/// The unknowns and rows of a step's equations, shared by several processes.

#include "osculate/core/halo.hpp"
#include "osculate/core/slices.hpp"
#include "osculate/linear/unknowns.hpp"

#include <optional>

namespace osculate::linear {

/// A process' own are those of its nodes: their displacements, and the contact forces of the slave nodes among them. As rows are
/// exchanged between the two of one node alone, these are its own rows, too.
class UnknownSlices final : public Slices {
public:
    /// @param read  nodes whose displacements products and the preconditioner read here, in any order, one's own among them or not
    /// @param hubs  nodes whose rows every process reads, as it reads those of contact laws
    UnknownSlices(const Share& share, const Constraints& constraints, const Unknowns& unknowns,
                  const std::vector<Index>& read, const std::vector<Index>& hubs);

    /// One's own, ascending.
    [[nodiscard]] std::span<const Index> nodes() const { return share_.nodes_of(share_.ranks().rank()); }
    /// Others' nodes whose displacements are read here, ascending.
    [[nodiscard]] const std::vector<Index>& ghosts() const { return ghosts_; }

    [[nodiscard]] Ranks& ranks() const override { return share_.ranks(); }
    [[nodiscard]] const std::vector<Index>& own() const override { return own_; }
    void fill_unknowns(double* x) override { unknowns_read_->fill(x); }
    void fill_rows(double* r) override { rows_read_->fill(r); }
    void gather(std::span<const double> own_values, double* x) const override;

private:
    /// Calls each(place) for the unknowns of a rank.
    template <class Each> void for_each(int rank, Each&& each) const;

    const Share& share_;
    const Constraints& constraints_;
    const Unknowns& unknowns_;
    std::vector<Index> own_, ghosts_;
    std::vector<int> lengths_; ///< (ranks) of their slices
    std::optional<Halo> unknowns_read_, rows_read_;
};

} // namespace osculate::linear
