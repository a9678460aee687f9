#pragma once
/// Output templates read into a scene, those they extend first.

#include "osculate/core/error.hpp"
#include "osculate/scene/output.hpp"
#include "scene/tree.hpp"
#include "scene/tree_reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::scene {

/// Fills the output from the template that a scene names, or the usual one; every fault goes to `faults`.
/// @param names  of the scene, which the templates' probes may refer to
/// @returns  what the scene calls it when that can be found again from anywhere: the name of a shipped one, or a path
[[nodiscard]] std::string read_template(const Tree& scene, const std::filesystem::path& directory,
                                        const KnownNames& names, Output& output, std::vector<Fault>& faults);

} // namespace osculate::scene
