#pragma once
/// A run as a film, GIF or MP4.

#include <filesystem>
#include <string>

namespace osculate::app {

struct FilmCommand {
    std::string folder;
    std::string file;   ///< its ending says which; empty: film.mp4 in the folder
    std::string field;  ///< of the bodies; empty: that of the report's pictures
    double seconds = 8; ///< length of the film
};

/// Draws the frames of a run, deformed and coloured, each for as long as it lasts in the run, with time and colour legend.
/// Needs gnuplot and ffmpeg.
/// @returns  what was written, a line
/// @throws SceneError for a folder without frames, a field that there is none of, another ending
/// @throws ReportFailure where a program is missing or fails
[[nodiscard]] std::string write_film(const FilmCommand& command);

} // namespace osculate::app
