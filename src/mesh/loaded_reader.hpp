#pragma once
/// Readers in shared modules, which are loaded when a mesh first asks for them.

#include <string>

namespace osculate::mesh {

/// Function `name` of module `lib<module>.so`, which stays loaded. Throws MeshError about `file`, with `remedy`.
[[nodiscard]] void* load_reader(const char* module, const char* name, const std::string& file, const char* remedy);

} // namespace osculate::mesh
