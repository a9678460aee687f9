#pragma once
/// Numbering of the unknowns and rows of a step's equations.

#include "osculate/linear/constraints.hpp"

#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace osculate::linear {

/// The unknowns form named blocks: `displacements`, free components by their equation numbers, then `contact forces`,
/// three local components for each slave node of a pair (its coupling). The three equilibrium rows of a slave node are
/// exchanged with its three contact rows, so that both keep a large diagonal: equilibrium is solved for the contact
/// force, the contact law for the displacement. A held displacement component has no equilibrium row, and the contact
/// row remains with the force.
class Unknowns {
public:
    struct Block {
        std::string_view name;
        Index first = 0, size = 0;
    };
    /// @param slaves  (couplings) global nodes; rows are exchanged only with the first coupling of a node
    Unknowns(const Constraints& constraints, std::vector<Index> slaves)
        : constraints_(&constraints), slaves_(std::move(slaves)),
          exchanged_(static_cast<std::size_t>(constraints.nodes()), -1) {
        for (std::size_t j = 0; j < slaves_.size(); ++j)
            if (Index& taken = exchanged_[slaves_[j]]; taken < 0) taken = static_cast<Index>(j);
    }

    [[nodiscard]] Index size() const { return constraints_->equations() + 3 * couplings(); }
    [[nodiscard]] std::array<Block, 2> blocks() const {
        return {Block{"displacements", 0, constraints_->equations()},
                Block{"contact forces", constraints_->equations(), 3 * couplings()}};
    }
    [[nodiscard]] Index couplings() const { return static_cast<Index>(slaves_.size()); }
    [[nodiscard]] Index slave(Index j) const { return slaves_[j]; }
    /// The coupling whose rows are exchanged with those of a node, -1: none.
    [[nodiscard]] Index exchanged(Index node) const { return exchanged_[node]; }

    /// Equilibrium row of local component k of a node, or Constraints::held.
    [[nodiscard]] Index equilibrium_row(Index node, int k) const {
        const Index e = constraints_->equation(node, k);
        if (e == Constraints::held || exchanged_[node] < 0) return e;
        return multiplier(exchanged_[node]) + k;
    }
    /// Row of the contact law of coupling j, component k.
    [[nodiscard]] Index contact_row(Index j, int k) const {
        const Index e = constraints_->equation(slaves_[j], k);
        return exchanged_[slaves_[j]] == j && e != Constraints::held ? e : multiplier(j) + k;
    }
    /// First unknown of the contact force of coupling j.
    [[nodiscard]] Index multiplier(Index j) const { return constraints_->equations() + 3 * j; }

private:
    const Constraints* constraints_;
    std::vector<Index> slaves_;    ///< (couplings)
    std::vector<Index> exchanged_; ///< (nodes)
};

} // namespace osculate::linear
