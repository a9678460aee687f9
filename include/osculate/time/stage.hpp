#pragma once
/// One stage in the form for the stepper.

#include "osculate/core/sparse_field.hpp"
#include "osculate/equilibrium/dynamics.hpp"
#include "osculate/equilibrium/tangent_choice.hpp"
#include "osculate/linear/constraints.hpp"
#include "osculate/mesh/surface_faces.hpp"
#include "osculate/time/step_control.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osculate::time {

/// Value of a load or a motion over the time of a stage.
struct Course {
    std::string name;                 ///< for messages
    std::function<double(double)> at; ///< value at a time since the stage's start, s
    std::vector<double> corners;      ///< times since the stage's start at which steps must end, s
};

/// External forces that follow a course.
struct CourseForce {
    Index course = -1;   ///< of the stage
    SparseField pattern; ///< forces at course value 1, N
};

/// A pressure on the current area, along the current normal.
struct FollowerPressure {
    std::vector<mesh::SurfaceFace> faces; ///< global nodes
    double start = 0, end = 0;            ///< Pa, ramped like the stage
    Index course = -1;                    ///< course of the stage that it follows instead; -1: none
};

/// Temperature of nodes above that at which they have no thermal strain.
struct NodeTemperature {
    std::vector<Index> nodes;
    double start = 0, end = 0; ///< K, ramped like the stage
    Index course = -1;         ///< course of the stage that it follows instead; -1: none
};

struct Stage {
    std::string name;
    double duration = 1; ///< s
    int steps = 1;
    std::optional<equilibrium::Dynamics> dynamics; ///< absent: static
    equilibrium::TangentChoice
        tangent; ///< method for its linear systems; with general contact, for the pairs at the start
    LinearSolver linear_solver = LinearSolver::automatic; ///< asked for
    StepLimits limits;                                    ///< g_p in facet sizes; dt_max is the stage's step
    bool follow_paths = false;                            ///< follow paths of slave nodes, see CollisionCheck
    bool ramp = true;                                     ///< linear from the last value; false: full value at once
    std::vector<linear::NodeConstraint> constraints;      ///< every direction held during this stage
    SparseField force_start, force_end;                   ///< external forces at its two ends without weight, N
    std::shared_ptr<const Field> weight;                  ///< (nodes) N, in full from the start; null: no gravity
    std::vector<Course> courses;
    std::vector<CourseForce> course_forces; ///< added to these forces
    std::vector<FollowerPressure> follower_pressures;
    /// Pairs of the model as they are in this stage, in their order: others in friction or in force. Empty: as in the model.
    std::vector<std::shared_ptr<const model::ContactPair>> pairs;
    std::vector<NodeTemperature> temperatures; ///< the last that names a node counts

    /// External forces that follow no course, N. @param part  0 at the start, 1 at the end
    [[nodiscard]] Field force(std::size_t nodes, double part) const {
        Field force = SparseField::between(force_start, force_end, part, nodes);
        if (weight) force.add(1, *weight);
        return force;
    }
};

} // namespace osculate::time
