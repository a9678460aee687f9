#pragma once
/// A scene for human readers: its keys as a tree of words, with units and prefixes instead of SI numbers.

#include "osculate/scene/scene.hpp"

#include <string>
#include <vector>

namespace osculate::scene {

struct OutlineItem {
    std::string key;
    std::string text;               ///< "30 MPa"; empty if there are items
    std::vector<OutlineItem> items; ///< of a group

    /// The item of that name, or nullptr.
    [[nodiscard]] const OutlineItem* find(const std::string& name) const;
};

/// The resolved scene; the root has neither key nor text.
[[nodiscard]] OutlineItem outline(const Scene& scene);

/// "30 MPa", "50 mm", "2 kN/m³": a number of SI units with the prefix that gives a number from 1 to 1000. Zero, and
/// numbers next to it, keep the unit itself.
/// @param unit  a product of powers of SI units; a prefix is put before Pa, N, J, W, s and m, and before kN/m^3 and the
///              like
[[nodiscard]] std::string engineering(double value, const std::string& unit);

} // namespace osculate::scene
