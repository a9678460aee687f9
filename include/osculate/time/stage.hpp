#pragma once
/// One stage as the stepper sees it.

#include "osculate/equilibrium/dynamics.hpp"
#include "osculate/equilibrium/tangent_choice.hpp"
#include "osculate/linear/constraints.hpp"
#include "osculate/mesh/surface_faces.hpp"
#include "osculate/time/step_control.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace osculate::time {

/// A load's or a motion's value over the time of a stage.
struct Course {
    std::string name;                 ///< for messages
    std::function<double(double)> at; ///< value at a time since the stage's start, s
    std::vector<double> corners;      ///< times since the stage's start that steps must hit, s
};

/// External forces that follow a course.
struct CourseForce {
    Index course = -1; ///< of the stage
    Field pattern;     ///< (nodes) forces where the course is 1, N
};

/// A pressure on the current area, along the current normal.
struct FollowerPressure {
    std::vector<mesh::SurfaceFace> faces; ///< global nodes
    double start = 0, end = 0;            ///< Pa, ramped as the stage says
    Index course = -1;                    ///< of the stage, that it follows instead
};

struct Stage {
    std::string name;
    double duration = 1; ///< s
    int steps = 1;
    std::optional<equilibrium::Dynamics> dynamics;   ///< absent: static
    equilibrium::TangentChoice tangent;              ///< how its linear systems are solved
    StepLimits limits;                               ///< g_p in facet sizes; dt_max is the stage's step
    bool follow_paths = false;                       ///< of slave nodes, see CollisionCheck
    bool ramp = true;                                ///< linear from the last value; false: full value at once
    std::vector<linear::NodeConstraint> constraints; ///< every direction held during this stage
    Field force_start, force_end;                    ///< (nodes) external forces at its two ends, N
    std::vector<Course> courses;
    std::vector<CourseForce> course_forces; ///< on top of these
    std::vector<FollowerPressure> follower_pressures;
};

} // namespace osculate::time
