#pragma once
/// Volume meshes in pieces, one of each process that shares a run: a VTK file (.pvtu) that lists files of pieces.

#include "osculate/output/vtk_file.hpp"

namespace osculate::output {

/// Writes the list of the pieces of a volume mesh.
/// @param pieces      files written by write_vtu() with numbers, relative to the list's folder
/// @param point_data  arrays as in them; their values are not used
void write_pvtu(const std::filesystem::path& path, const std::vector<std::string>& pieces,
                const std::vector<Array>& point_data, double time);
/// The pieces in such a list. @throws std::runtime_error with the path if it is none
[[nodiscard]] std::vector<std::filesystem::path> pieces_in(const std::filesystem::path& path);

} // namespace osculate::output
