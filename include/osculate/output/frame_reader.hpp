#pragma once
/// Frames of a run, read back.

#include "osculate/output/vtk_file.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace osculate::output {

struct Frame {
    std::vector<Vec3> points; ///< reference positions, m
    std::vector<Array> arrays;
    double time = 0; ///< s
    /// The array called `name`, or nullptr.
    [[nodiscard]] const Array* find(const std::string& name) const;
};

/// Reads a .vtp or .vtu file of this program, or all pieces of a .pvtu file, points in the order of the whole mesh.
/// @throws std::runtime_error with the path if it is not one
[[nodiscard]] Frame read_frame(const std::filesystem::path& path);

/// Polygons of such a file; for a .vtu or .pvtu file the exterior of its elements. Node numbers index the points of the frame.
/// @throws std::runtime_error like read_frame()
[[nodiscard]] std::vector<mesh::Facet> read_facets(const std::filesystem::path& path);

/// The file of the last frame of a part ("PAIR.slave", "BODY") in the folder of a run; no value if there is only the
/// initial frame.
[[nodiscard]] std::optional<std::filesystem::path> last_frame(const std::filesystem::path& folder,
                                                              const std::string& part);

} // namespace osculate::output
