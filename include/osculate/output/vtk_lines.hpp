#pragma once
/// Polylines in a VTK XML file (.vtp).

#include "osculate/output/vtk_file.hpp"

namespace osculate::output {

/// Writes polylines; their numbers index `points`; `line_data` has one tuple per line.
/// @throws std::runtime_error with path and reason if the file cannot be written
/// @throws InternalError for an array that does not fit the lines
void write_lines(const std::filesystem::path& path, const std::vector<Vec3>& points,
                 const std::vector<std::vector<Index>>& lines, const std::vector<Array>& line_data);

} // namespace osculate::output
