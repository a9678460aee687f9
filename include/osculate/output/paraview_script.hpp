#pragma once
/// A script for ParaView that shows the frames of a run.

#include "osculate/output/frames.hpp"

#include <filesystem>

namespace osculate::output {

constexpr const char* paraview_script_file = "show_in_paraview.py"; ///< in a run's folder

/// Writes show_in_paraview.py: bodies warped by their displacement and coloured by the most telling field there is, slave surfaces
/// likewise, arrows for contact forces. Run within ParaView, or by `pvbatch show_in_paraview.py PICTURE.png` for a picture.
/// @throws std::runtime_error with path and reason
void write_paraview_script(const std::filesystem::path& folder, const model::Model& model, const FrameFields& fields);

} // namespace osculate::output
