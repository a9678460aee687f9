#pragma once
/// What the module gives; osculate/mesh/vtk_reader.hpp says what is read.

#include "osculate/mesh/raw_mesh.hpp"

#include <filesystem>

namespace osculate::vtk {

[[nodiscard]] mesh::RawMesh read_vtu(const std::filesystem::path& path);
[[nodiscard]] mesh::RawMesh read_legacy(const std::filesystem::path& path);
[[nodiscard]] mesh::RawMesh read_exodus(const std::filesystem::path& path);

} // namespace osculate::vtk
