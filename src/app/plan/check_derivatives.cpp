#include "app/plan/check_derivatives.hpp"

#include "app/fault.hpp"
#include "osculate/scene/number_at.hpp"
#include "osculate/scene/writer.hpp"

#include <algorithm>
#include <regex>
#include <string>

namespace osculate::app {

namespace {
/// Whether a number is one of the steps, the solver or the output, not of what is simulated: runs beside a run take its steps.
bool is_of_steps(const std::string& key) {
    static const std::regex pattern(R"((solver|output|expect)\..*|stages\.[^.]+\.(duration|steps|control(\..*)?))");
    return std::regex_match(key, pattern);
}
/// Faults of one number.
void check_number(const std::string& resolved, const scene::Derivative& derivative, const std::string& where,
                  std::vector<Fault>& faults) {
    std::string found;
    const std::string& key = derivative.key;
    const auto number = scene::number_at(resolved, key, found);
    if (is_of_steps(key))
        faults.push_back(fault(where, "a number of what is simulated, as the steps stay as they are", "'" + key + "'"));
    else if (!number)
        faults.push_back(fault(where, "the path of a number, such as bodies.NAME.material.linear_elastic.E",
                               "'" + key + "': " + found));
    else if (number->value == 0 && derivative.step == 0)
        faults.push_back(fault(where,
                               "a number other than 0, as it is changed by a part of it, or a step beside its key",
                               "'" + key + "', 0"));
}

bool is_plastic(const scene::Material& material) {
    return std::holds_alternative<scene::ElasticPlastic>(material);
}
bool is_plastic(const scene::Body& body) {
    return is_plastic(body.material) ||
           std::ranges::any_of(body.sections, [](const auto& one) { return is_plastic(one.second.material); });
}

/// Why the adjoint of a run with this plan is not known; empty: it is.
std::string bars_gradients(const scene::Scene& scene, const Plan& plan) {
    const model::Model& model = plan.model;
    const auto dynamic = [](const time::Stage& stage) { return stage.dynamics.has_value(); };
    for (const time::Stage& stage : plan.stages)
        if (!stage.follower_pressures.empty()) return "stage '" + stage.name + "', whose pressure follows its surface";
    if (model.has_dependent_nodes())
        return "rigid bodies, couplings, ties, sectors, equations or faces with midside nodes in contact";
    for (const auto& [name, body] : scene.bodies)
        if (is_plastic(body)) return "body '" + name + "', whose material has a past";
    if (std::ranges::none_of(plan.stages, dynamic)) return {};
    if (!std::ranges::all_of(plan.stages, dynamic)) return "static and dynamic stages";
    const bool damped =
        std::ranges::any_of(plan.stages, [](const auto& s) { return s.dynamics->stiffness_damping > 0; });
    for (const model::Body& body : model.bodies) {
        if (std::ranges::any_of(body.kernels, [](const auto& kernel) { return kernel->heated(); }))
            return "a dynamic stage with temperatures, in body '" + body.name + "'";
        if (damped && !std::ranges::all_of(body.kernels, [](const auto& kernel) { return kernel->linear(); }))
            return "a dynamic stage with stiffness_damping, and body '" + body.name + "' at finite strain";
    }
    for (const auto& pair : model.pairs)
        if (pair->options().overclosure || pair->options().tangential_damping > 0)
            return "pair '" + pair->name() + "', whose forces in dynamics are means over a step";
    return {};
}
} // namespace

void check_gradients(const scene::Scene& scene, const Plan& plan, bool shared, std::vector<Fault>& faults) {
    if (scene.output.gradients.empty()) return;
    const char* all = "output.gradients";
    if (shared) faults.push_back(fault(all, "a run by one process", "--distributed"));
    if (scene.general) faults.push_back(fault(all, "contact by named pairs", "contact.general, whose pairs change"));
    if (const std::string what = bars_gradients(scene, plan); !what.empty())
        faults.push_back(fault(all,
                               "stages of elastic bodies, each free of the others but for contact, all static or all "
                               "dynamic",
                               what));
    const std::string resolved = scene::write_scene(scene);
    for (const auto& [name, gradient] : scene.output.gradients) {
        const std::string where = "output.gradients." + name;
        for (const auto& [label, by] : gradient.by) check_number(resolved, by, where + ".by." + label + ".key", faults);
        const auto* force = std::get_if<scene::SupportForce>(&gradient.of);
        const auto held = [&](const linear::NodeConstraint& constraint) {
            return constraint.set >= 0 && plan.model.sets[static_cast<std::size_t>(constraint.set)].name == force->set;
        };
        if (force != nullptr && !plan.stages.empty() && std::ranges::none_of(plan.stages.back().constraints, held))
            faults.push_back(
                fault(where + ".reaction.set", "a set that the last stage holds or drives", "'" + force->set + "'"));
    }
}

void check_derivatives(const scene::Scene& scene, bool shared, std::vector<Fault>& faults) {
    if (scene.output.derivatives.empty()) return;
    if (shared) faults.push_back(fault("output.derivatives", "a run by one process", "--distributed"));
    if (scene.general)
        faults.push_back(fault("output.derivatives", "contact by named pairs", "contact.general, whose pairs change"));
    const std::string resolved = scene::write_scene(scene);
    for (const auto& [name, derivative] : scene.output.derivatives) {
        check_number(resolved, derivative, "output.derivatives." + name + ".key", faults);
    }
}

} // namespace osculate::app
