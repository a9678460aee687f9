#pragma once
/// Places of faults that were found after a scene was read.

#include "osculate/scene/reader.hpp"

#include <string>
#include <vector>

namespace osculate::scene {

/// Gives every fault without a file the place of its key: that of the deepest part of the key path that the scene file,
/// or an override, names.
[[nodiscard]] std::vector<Fault> locate(std::vector<Fault> faults, const std::string& path,
                                        const std::vector<Override>& overrides = {});

} // namespace osculate::scene
