#pragma once
/// A scene with one number a little smaller and a little larger, for derivatives.

#include "osculate/app/load.hpp"
#include "osculate/core/error.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace osculate::app {

struct ChangedScene {
    scene::Scene scene; ///< without derivatives, gradients and plots
    Plan plan;
};

struct ChangedScenes {
    double value = 0, step = 0;                           ///< of the number and its change, SI
    std::array<std::unique_ptr<ChangedScene>, 2> sides{}; ///< below, above; null where there is a fault
};

/// @param resolved  the scene as write_scene() writes it
/// @param where     path of the derivative in the scene, for faults
/// @returns empty sides where the key is none, which check_derivatives() tells
[[nodiscard]] ChangedScenes changed_scenes(const LoadedScene& loaded, const std::string& resolved,
                                           const scene::Derivative& derivative, const std::string& where, int threads,
                                           Timings& timings, std::vector<Fault>& faults);

} // namespace osculate::app
