#pragma once
/// What a run's frames show of its bodies from outside, over time.

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
    std::string body;         ///< that a contact surface is part of; empty where it is not known
    std::vector<Vec3> points; ///< reference positions, m
    std::vector<Index> nodes; ///< the body's node of every point
    std::vector<std::array<std::uint32_t, 4>> facets; ///< of points; a triangle repeats its last one
    std::vector<PartField> fields;

    [[nodiscard]] const PartField* find(const std::string& field) const;
};

struct MovingSurfaces {
    std::vector<double> times; ///< s, a frame each
    std::vector<MovingPart> parts;
    std::vector<std::string> notes; ///< what was left out and why, sentences
};

/// How much of a run is taken.
struct FrameBudget {
    std::size_t frames = 1200;
    std::size_t values = 16'000'000; ///< numbers of all frames together
};

/// Reads what series.pvd lists; frames are thinned out evenly where there are too many, the first and the last one stay.
/// Nothing but a note where the run has no frames, or where they cannot be read.
[[nodiscard]] MovingSurfaces read_moving_surfaces(const std::filesystem::path& run_folder, const FrameBudget& budget);

/// Keeps `count` frames, first and last among them. @param count  at least 2
void thin_out(MovingSurfaces& surfaces, std::size_t count);

} // namespace osculate::report
