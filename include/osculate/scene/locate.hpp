#pragma once
/// Places of faults that are found after a scene was read.

#include "osculate/scene/reader.hpp"

#include <string>
#include <vector>

namespace osculate::scene {

/// Sets the place of every fault without a file: that of the deepest part of its key path that the scene file, or an
/// override, contains.
[[nodiscard]] std::vector<Fault> locate(std::vector<Fault> faults, const std::string& path,
                                        const std::vector<Override>& overrides = {});

} // namespace osculate::scene
