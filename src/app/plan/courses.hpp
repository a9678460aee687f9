#pragma once
/// Loads and motions of the stages: what they ramp to, and the courses they follow within one stage.

#include "osculate/scene/scene.hpp"
#include "osculate/time/stage.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osculate::app {

/// What is driven during a stage, and what it keeps from those before.
struct Driving {
    std::map<std::string, std::array<std::optional<scene::Course>, 3>> displacement; ///< by set
    std::map<std::string, std::array<bool, 3>> released; ///< by set: components that its support holds no longer
    std::map<std::string, scene::Course> pressure, follower_pressure; ///< by set
    std::vector<std::pair<std::string, scene::Course>>
        temperature; ///< by body or set, in the order in which they are named
    std::map<std::string, std::array<scene::Course, 3>> body_force;            ///< by body
    std::map<std::string, scene::Centrifugal> centrifugal;                     ///< by body
    std::map<std::string, std::array<scene::Course, 3>> nodal_force;           ///< by set
    std::map<std::string, std::array<std::optional<scene::Course>, 6>> motion; ///< by rigid body
    std::map<std::string, std::array<scene::Course, 3>> force, moment;         ///< by rigid body

    /// Takes over what a stage names.
    void update(const scene::Stage& stage);
    /// Courses end with their last values.
    void settle(double duration);
    [[nodiscard]] bool has_load_courses() const;
    /// Without the loads that follow a course in `next`, since a course is no change of the value before it.
    [[nodiscard]] Driving without_courses_of(const Driving& next) const;
};

/// The courses of one stage, each once: sets that follow the same one may share nodes.
class CourseList {
public:
    explicit CourseList(std::vector<time::Course>& courses) : courses_(courses) {}
    /// Number of a course, which is listed where it is new.
    [[nodiscard]] Index index(const std::string& name, const scene::Course& course);

private:
    std::vector<time::Course>& courses_;
    std::vector<scene::Course> listed_;
};

/// What a value contributes to ramped loads: nothing where it follows a course.
[[nodiscard]] double ramped(const scene::Course& course);

} // namespace osculate::app
