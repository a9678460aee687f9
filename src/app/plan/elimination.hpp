#pragma once
/// Elimination of linear equations between displacements.

#include "osculate/model/model.hpp"
#include "osculate/time/stage.hpp"

#include <map>
#include <set>
#include <vector>

namespace osculate::app {

/// sum over the nodes of factor . displacement = 0
using EquationRow = std::map<Index, Vec3>;

/// Directions along which stages hold or drive nodes.
class HeldDirections {
public:
    /// The stages must outlive this object.
    explicit HeldDirections(const std::vector<time::Stage>& stages);
    /// Part of a factor along directions that any stage holds or drives.
    [[nodiscard]] Vec3 part(Index node, const Vec3& factor) const;
    /// Whether what every stage prescribes satisfies an equation.
    [[nodiscard]] bool satisfy(const EquationRow& row) const;

private:
    using Constraints = std::map<Index, std::vector<const linear::NodeConstraint*>>;
    std::vector<Constraints> stages_;
    std::map<Index, Mat3> all_; ///< projectors
};

/// Gauss-Jordan elimination, one direction of one node an equation.
class Elimination {
public:
    /// It must outlive this object.
    explicit Elimination(const HeldDirections& held) : held_(held) {}

    /// redundant: it holds anyhow.
    enum class Result { led, redundant, nothing_to_lead };

    /// @param order  nodes, those first that are to be led where it makes no difference
    Result add(const EquationRow& equation, const std::vector<Index>& order);
    [[nodiscard]] std::vector<model::LedNode> take() { return std::move(led_); }

private:
    /// The same equation without directions that are led already.
    [[nodiscard]] EquationRow reduced(const EquationRow& equation) const;
    /// -1: none may be led.
    [[nodiscard]] Index choose(const EquationRow& row, const std::vector<Index>& order) const;
    /// Takes a direction that is led from now on out of what leads others.
    void substitute(const model::LedNode& one);

    const HeldDirections& held_;
    std::vector<model::LedNode> led_;
    std::map<Index, std::vector<std::size_t>> at_; ///< node -> those of its directions
    std::map<Index, std::set<std::size_t>> uses_;  ///< node -> those in which it has a part
};

} // namespace osculate::app
