#pragma once
/// A number of a resolved scene, to change it.

#include "osculate/scene/reader.hpp"

#include <functional>
#include <optional>
#include <string>

namespace osculate::scene {

struct NumberAt {
    double value = 0;                    ///< SI
    std::function<Override(double)> set; ///< the scene with another value
};

/// @param resolved  of write_scene()
/// @param key       dotted path; the last parts of it may be places in lists, from 0 on: bodies.block.mesh.block.size.2
/// @param found     what stands there, if no number
[[nodiscard]] std::optional<NumberAt> number_at(const std::string& resolved, const std::string& key,
                                                std::string& found);

} // namespace osculate::scene
