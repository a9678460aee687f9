#pragma once
/// From a scene's words to what is taken of a mesh file.

#include "osculate/mesh/mesh_file.hpp"

#include <algorithm>

namespace osculate::app {

/// `all` stands for all repairs but the merging of coincident nodes, which would join bodies that touch, and what leaves
/// parts joined at nodes.
inline mesh::Repairs repairs_of(const std::vector<std::string>& asked) {
    mesh::Repairs repairs;
    const auto wants = [&](const std::string& word) { return std::ranges::count(asked, word) > 0; };
    const std::vector<std::string>& words = mesh::repair_words();
    for (std::size_t r = 0; r < words.size(); ++r) {
        const auto repair = static_cast<mesh::Repair>(r);
        const bool in_all = repair != mesh::Repair::coincident_nodes && repair != mesh::Repair::keep_non_manifold;
        repairs.wanted[r] = wants(words[r]) || (in_all && wants("all"));
    }
    return repairs;
}

} // namespace osculate::app
