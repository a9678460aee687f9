#include "app/plan/held_loads.hpp"

#include "osculate/linear/constraints.hpp"

#include <algorithm>
#include <span>

namespace osculate::app {

namespace {
/// Whether nothing of a force along a direction acts on a free one at any of the nodes.
bool is_held(const linear::Constraints& constraints, std::span<const Index> nodes, const Vec3& direction) {
    constexpr double round_off = 1e-9;
    return std::ranges::all_of(
        nodes, [&](Index node) { return (direction - constraints.reaction(node, direction)).norm() <= round_off; });
}

bool acts(const scene::Course& course) {
    return !course.is_value() || course.value() != 0;
}
} // namespace

std::vector<std::string> held_loads(const scene::Scene& scene, const Plan& plan) {
    std::vector<std::string> keys;
    const model::Model& model = plan.model;
    for (std::size_t s = 0; s < plan.stages.size(); ++s) {
        const auto& [name, spec] = scene.stages[s];
        if (spec.force.empty() && spec.moment.empty() && spec.nodal_force.empty()) continue;
        const linear::Constraints constraints(model.nodes(), plan.stages[s].constraints);
        const auto look = [&](const std::string& key, const auto& components, std::span<const Index> nodes) {
            for (int k = 0; k < 3; ++k)
                if (acts(components[static_cast<std::size_t>(k)]) && is_held(constraints, nodes, Vec3::Unit(k)))
                    keys.push_back("stages." + name + "." + key + "." + std::string(1, "xyz"[k]));
        };
        const auto look_at_points = [&](const char* key, const auto& loads, bool moment) {
            for (const auto& [body, components] : loads) {
                const auto rigid = std::ranges::find(model.rigid, body, &model::RigidBody::name);
                if (rigid == model.rigid.end()) continue; // a coupling that spreads its load over free nodes
                const Index node = moment ? rigid->rotation() : rigid->reference;
                look(key + std::string(".") + body, components, {&node, 1});
            }
        };
        look_at_points("force", spec.force, false);
        look_at_points("moment", spec.moment, true);
        for (const auto& [set, components] : spec.nodal_force)
            look("nodal_force." + set, components, std::ranges::find(model.sets, set, &model::Set::name)->nodes);
    }
    return keys;
}

} // namespace osculate::app
