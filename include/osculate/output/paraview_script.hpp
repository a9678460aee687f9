#pragma once
/// A script for ParaView that shows the frames of a run.

#include "osculate/output/frames.hpp"

#include <filesystem>

namespace osculate::output {

constexpr const char* paraview_script_file = "show_in_paraview.py"; ///< in a run's folder

/// Writes show_in_paraview.py: bodies and slave surfaces warped by their displacement and coloured by the most
/// informative field available, arrows for contact forces. Run it in ParaView, or with `pvbatch show_in_paraview.py
/// PICTURE.png` for a picture.
/// @throws std::runtime_error with path and reason
void write_paraview_script(const std::filesystem::path& folder, const model::Model& model, const FrameFields& fields);

} // namespace osculate::output
