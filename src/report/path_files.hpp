#pragma once
/// Probes along lines and arcs, as the run left their rows.

#include "osculate/report/pack.hpp"
#include "osculate/scene/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::report {

struct PathField {
    std::string name, unit;
    FieldFrames values; ///< time by time, sample by sample
};

struct PathFile {
    std::string name;
    bool angle = false; ///< `at` is an angle, rad; else the distance from the start, m
    std::vector<float> at;
    std::vector<double> times;
    std::vector<PathField> fields; ///< those that have a value somewhere
};

/// The probes of the scene that lie along a path and have rows in probes/NAME.csv; one that cannot be read is noted. Rows of
/// a time that is not complete yet are left out.
[[nodiscard]] std::vector<PathFile> read_path_files(const std::filesystem::path& folder, const scene::Scene& scene,
                                                    std::vector<std::string>& notes);

} // namespace osculate::report
