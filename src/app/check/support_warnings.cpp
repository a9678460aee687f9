#include "app/check/support_warnings.hpp"

#include "app/plan/held_loads.hpp"

#include <algorithm>
#include <utility>

namespace osculate::app {

std::vector<Warning> support_warnings(const scene::Scene& scene, const Plan& plan) {
    std::vector<Warning> found;
    for (std::string& key : held_loads(scene, plan)) found.push_back({std::move(key), why_held_load_is_odd});
    for (const auto& [name, support] : scene.supports) {
        if (support.symmetry || std::ranges::count(support.fixed, true) > 0) continue;
        const bool moved = std::ranges::any_of(scene.stages, [&name = name](const auto& stage) {
            const auto* motion = scene::find(stage.second.displacement, name);
            return motion != nullptr &&
                   std::ranges::any_of(*motion, [](const auto& component) { return component.has_value(); });
        });
        if (!moved)
            found.push_back({"supports." + name, "it holds nothing, and no stage moves it: name components, for "
                                                 "example fix: [x, y, z], or leave it out"});
    }
    return found;
}

} // namespace osculate::app
