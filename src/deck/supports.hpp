#pragma once
/// What a deck holds, as supports of a scene and motions of its stages.

#include "deck/bodies.hpp"
#include "deck/loads.hpp"

#include <array>
#include <string>
#include <vector>

namespace osculate::deck {

/// What the deck holds a component of a node at: step (-1: all of them), value, amplitude.
struct Holding {
    int step = -1;
    double value = 0;
    std::string amplitude;
    bool released = false; ///< by this step
    auto operator<=>(const Holding&) const = default;
};
using Holdings = std::array<std::vector<Holding>, 3>;

class DeckSupports {
public:
    /// All must outlive this object. @param length  metres per unit of the deck
    DeckSupports(DeckModel& model, DeckSets& sets, double length, std::vector<StageLoads>& stages)
        : model_(model), sets_(sets), length_(length), stages_(stages) {}

    /// The entries of `supports`; adds what moves, and what is let go of, to the stages.
    [[nodiscard]] std::string write();

private:
    /// No direction is radial on an axis: what holds a node there across it holds it in both directions.
    void hold_across(Holdings& holdings, Index p);
    /// Whether all components are held for ever, along whatever axes.
    static bool holds_all(const Holdings& holdings);
    /// Axes of a set as a support has them.
    std::string axes_of(std::size_t transform, bool on_axis) const;
    /// Components held at zero from the start are supports, others driven by stages.
    std::string write_support(const std::string& set, const Holdings& holdings, const std::string& axes);
    void release(const std::string& set, const Holding& holding, std::size_t d);

    DeckModel& model_;
    DeckSets& sets_;
    double length_;
    std::vector<StageLoads>& stages_;
};

} // namespace osculate::deck
