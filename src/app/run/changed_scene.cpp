#include "app/run/changed_scene.hpp"

#include "app/fault.hpp"
#include "osculate/scene/number_at.hpp"

#include <cmath>
#include <fmt/format.h>

namespace osculate::app {

namespace {

/// What differs between two plans whose unknowns must be the same; empty: nothing.
std::string difference(const Plan& a, const Plan& b) {
    const auto shape = [](const model::Model& model) {
        std::vector<Index> numbers{model.nodes()};
        for (const model::Body& body : model.bodies) numbers.push_back(body.mesh.element_count());
        return numbers;
    };
    if (shape(a.model) != shape(b.model)) return "another mesh";
    const auto pairs = [](const model::Model& model) {
        std::vector<std::vector<Index>> nodes;
        for (const auto& pair : model.pairs) {
            nodes.push_back(pair->slaves().node);
            nodes.push_back(pair->master_nodes());
        }
        return nodes;
    };
    if (pairs(a.model) != pairs(b.model)) return "other contact nodes";
    const auto held = [](const std::vector<time::Stage>& stages) {
        std::vector<std::size_t> counts;
        for (const time::Stage& stage : stages) counts.push_back(stage.constraints.size());
        return counts;
    };
    if (held(a.stages) != held(b.stages)) return "other supports";
    return {};
}

} // namespace

ChangedScenes changed_scenes(const LoadedScene& loaded, const std::string& resolved,
                             const scene::Derivative& derivative, const std::string& where, int threads,
                             Timings& timings, std::vector<Fault>& faults) {
    ChangedScenes changed;
    std::string found;
    const auto number = scene::number_at(resolved, derivative.key, found);
    if (!number) return changed;
    changed.value = number->value;
    changed.step = derivative.step > 0 ? derivative.step : std::abs(number->value) * derivative.change;
    for (std::size_t k = 0; k < changed.sides.size(); ++k) {
        const double value = number->value + (k == 0 ? -changed.step : changed.step);
        try {
            auto side = std::make_unique<ChangedScene>();
            side->scene = scene::parse_scene(resolved, "the scene with another number", {number->set(value)});
            side->scene.output.derivatives.clear();
            side->scene.output.gradients.clear();
            side->scene.output.plots.clear();
            side->plan = compile(side->scene, threads, timings);
            if (const std::string other = difference(loaded.plan, side->plan); !other.empty())
                faults.push_back(fault(where + ".key", "a number that leaves mesh, pairs and supports as they are",
                                       fmt::format("{} at {:g}", other, value)));
            changed.sides[k] = std::move(side);
        } catch (const SceneError& error) {
            faults.push_back(
                fault(where + ".key", "a number that may be changed a little both ways",
                      fmt::format("at {:.10g}, {}: expected {}, found {}", value, error.faults().front().key,
                                  error.faults().front().expected, error.faults().front().found)));
        }
    }
    return changed;
}

} // namespace osculate::app
