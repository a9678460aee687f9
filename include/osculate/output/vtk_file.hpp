#pragma once
/// VTK XML files: a volume mesh or a piece of one (.vtu), or a surface (.vtp), with arrays on its points.

#include "osculate/core/types.hpp"
#include "osculate/mesh/mesh.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace osculate::output {

/// Values on the points of a file, point by point.
struct Array {
    std::string name;
    int components = 1;         ///< 1, 3, or 6: a symmetric tensor in Voigt order xx, yy, zz, xy, yz, zx
    std::vector<double> values; ///< (points * components), SI
    bool integer = false;       ///< values are integers, written as Int32
    std::string unit{};         ///< SI, the array's UNITS_LABEL; empty: none
};

/// Components of an array of symmetric tensors.
inline constexpr std::array<const char*, 6> voigt_names{"XX", "YY", "ZZ", "XY", "YZ", "XZ"};

/// The array of a piece that holds its points' numbers in the whole mesh.
inline constexpr const char* point_numbers = "GlobalNodeId";

/// Writes a volume mesh, appended raw data with LZ4; `time` (s) becomes the field array TimeValue. A reader sees the
/// previous file or the complete new one, never a part; creates the file's folder if missing.
/// @param numbers  of the points in the mesh that this is a piece of, VTK's global numbers; empty: no piece
/// @throws std::runtime_error with path and reason if the file cannot be written
/// @throws InternalError for an array that does not fit the points
void write_vtu(const std::filesystem::path& path, const std::vector<Vec3>& points,
               const std::vector<mesh::ElementBlock>& blocks, const std::vector<Array>& point_data, double time,
               const std::vector<Index>& numbers = {});

/// The same for a surface; the facets' node numbers index `points`.
void write_vtp(const std::filesystem::path& path, const std::vector<Vec3>& points,
               const std::vector<mesh::Facet>& facets, const std::vector<Array>& point_data, double time);

} // namespace osculate::output
