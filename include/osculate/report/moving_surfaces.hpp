#pragma once
/// The exterior of a run's bodies over time, from its frames.

#include "osculate/core/types.hpp"
#include "osculate/report/pack.hpp"

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace osculate::report {

enum class PartKind { body, slave, master };

struct PartField {
    std::string name, unit; ///< unit: SI
    bool integer = false;
    FieldFrames values;
};

/// The exterior of a body, or a contact surface.
struct MovingPart {
    std::string name; ///< of the body, or of the pair
    PartKind kind = PartKind::body;
    std::string body;                                 ///< body of a contact surface; empty if unknown
    std::vector<Vec3> points;                         ///< reference positions, m
    std::vector<Index> nodes;                         ///< the body's node of every point
    std::vector<std::array<std::uint32_t, 4>> facets; ///< of points; a triangle repeats its last one
    std::vector<PartField> fields;

    [[nodiscard]] const PartField* find(const std::string& field) const;
};

struct MovingSurfaces {
    std::vector<double> times; ///< s, of every frame
    std::vector<MovingPart> parts;
    std::vector<std::string> notes; ///< omissions and their reasons, sentences
};

/// Limits on the data taken from a run.
struct FrameBudget {
    std::size_t frames = 1200;
    std::size_t values = 16'000'000; ///< numbers of all frames together
};

/// Reads the files in series.pvd; if there are too many frames, drops some evenly, but keeps the first and the last.
/// The result has only a note if the run has no frames, or they cannot be read.
[[nodiscard]] MovingSurfaces read_moving_surfaces(const std::filesystem::path& run_folder, const FrameBudget& budget);

/// Keeps `count` frames, including first and last. @param count  at least 2
void thin_out(MovingSurfaces& surfaces, std::size_t count);

} // namespace osculate::report
