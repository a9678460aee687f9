#include "app/plan/courses.hpp"

#include <algorithm>

namespace osculate::app {

namespace {

void settle_one(scene::Course& course, double duration) {
    if (!course.is_value()) course = course.function()(duration);
}

} // namespace

void Driving::update(const scene::Stage& stage) {
    for (const auto& [set, components] : stage.release)
        for (std::size_t k = 0; k < 3; ++k)
            if (components[k]) {
                released[set][k] = true;
                displacement[set][k].reset();
            }
    for (const auto& [set, components] : stage.displacement)
        for (std::size_t k = 0; k < 3; ++k)
            if (components[k]) displacement[set][k] = components[k];
    for (const auto& [set, value] : stage.pressure) pressure[set] = value;
    for (const auto& [set, value] : stage.follower_pressure) follower_pressure[set] = value;
    for (const auto& [body, value] : stage.body_force) body_force[body] = value;
    for (const auto& [body, value] : stage.centrifugal) centrifugal[body] = value;
    for (const auto& [part, value] : stage.temperature) {
        std::erase_if(temperature, [&, &name = part](const auto& before) { return before.first == name; });
        temperature.emplace_back(part, value);
    }
    for (const auto& [set, value] : stage.nodal_force) nodal_force[set] = value;
    for (const auto& [body, components] : stage.motion)
        for (std::size_t k = 0; k < components.size(); ++k)
            if (components[k]) motion[body][k] = components[k];
    for (const auto& [body, value] : stage.force) force[body] = value;
    for (const auto& [body, value] : stage.moment) moment[body] = value;
}

void Driving::settle(double duration) {
    for (auto& [set, components] : displacement)
        for (auto& component : components)
            if (component) settle_one(*component, duration);
    for (auto& [set, value] : pressure) settle_one(value, duration);
    for (auto& [set, value] : follower_pressure) settle_one(value, duration);
    for (auto& [part, value] : temperature) settle_one(value, duration);
    for (auto* vectors : {&body_force, &nodal_force, &force, &moment})
        for (auto& [body, components] : *vectors)
            for (auto& component : components) settle_one(component, duration);
    for (auto& [body, components] : motion)
        for (auto& component : components)
            if (component) settle_one(*component, duration);
}

bool Driving::has_load_courses() const {
    const auto varies = [](const scene::Course& course) { return !course.is_value(); };
    const auto any = [&](const auto& vectors) {
        return std::ranges::any_of(vectors,
                                   [&](const auto& entry) { return std::ranges::any_of(entry.second, varies); });
    };
    return std::ranges::any_of(pressure, [&](const auto& entry) { return varies(entry.second); }) || any(body_force) ||
           any(nodal_force) || any(force) || any(moment);
}

Driving Driving::without_courses_of(const Driving& next) const {
    Driving kept = *this;
    for (auto& [set, value] : kept.pressure)
        if (!next.pressure.at(set).is_value()) value = 0.0;
    const auto drop = [](auto& vectors, const auto& then) {
        for (auto& [body, components] : vectors)
            for (std::size_t k = 0; k < 3; ++k)
                if (!then.at(body)[k].is_value()) components[k] = 0.0;
    };
    drop(kept.body_force, next.body_force);
    drop(kept.nodal_force, next.nodal_force);
    drop(kept.force, next.force);
    drop(kept.moment, next.moment);
    return kept;
}

Index CourseList::index(const std::string& name, const scene::Course& course) {
    const auto at = std::ranges::find(listed_, course);
    const auto index = static_cast<Index>(at - listed_.begin());
    if (at == listed_.end()) {
        listed_.push_back(course);
        courses_.push_back({name, course.function(), course.corners()});
    }
    return index;
}

double ramped(const scene::Course& course) {
    return course.is_value() ? course.value() : 0;
}

} // namespace osculate::app
