/// Parts of a plan: contact.

#include "app/plan/flat_master.hpp"
#include "app/plan/plan_items.hpp"
#include "osculate/model/general_contact.hpp"
#include "osculate/time/collision_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace osculate::app {

namespace {

constexpr const char* no_pair = "the scene has no pair";

/// Slave nodes of the pairs that `chosen` is true of.
template <class Chosen> double slave_nodes(const Plan& plan, Chosen&& chosen) {
    double sum = 0;
    for (const auto& pair : plan.pairs_at_start())
        if (chosen(*pair)) sum += pair->size();
    return sum;
}

/// Contact points with their forces, positions at the start of the step, master vertices.
PlanCost contact_cost(const Plan& plan) {
    PlanCost cost{0, 0, "slave nodes an iteration"};
    for (const auto& pair : plan.pairs_at_start()) {
        cost.count += pair->size();
        cost.bytes += pair->size() * (sizeof(contact::ContactPoint) + sizeof(contact::FacetHit) + 3 * sizeof(Vec3));
        cost.bytes += sizeof(Vec3) * static_cast<double>(plan.model.nodes() + pair->surface().vertex_count());
    }
    return cost;
}

/// Patches of one smooth master: per vertex with a blend, per facet with rpim.
void add_patches(const scene::MasterSpec& master, const mesh::HalfEdgeSurface& surface, PlanCost& cost) {
    const auto* rpim = std::get_if<scene::RpimSurface>(&master.surface);
    const auto* blend = std::get_if<scene::BlendSurface>(&master.surface);
    if (rpim == nullptr && blend == nullptr) return;
    const double patches = rpim != nullptr ? surface.facet_count() : surface.vertex_count();
    const double side =
        2 * (rpim != nullptr ? rpim->ring : blend->ring) + (rpim != nullptr ? 2 : 1); // of quadrilaterals
    const double n = std::min<double>(side * side, surface.vertex_count()), m = rpim != nullptr ? rpim->m : blend->m;
    cost.count += patches;
    cost.bytes += sizeof(double) * patches * ((n + m) * n + 2 * n * m + 3 * (2 * n + m)); // H, fit and D, placed
}

std::string in_words(const scene::MasterSpec& master) {
    if (const auto* rpim = std::get_if<scene::RpimSurface>(&master.surface))
        return fmt::format("rpim of {} ring(s)", rpim->ring);
    if (const auto* blend = std::get_if<scene::BlendSurface>(&master.surface))
        return fmt::format("blend of {} ring(s)", blend->ring);
    return "facets";
}

/// "tube: petrov_galerkin: every stage is static, floor: node"
std::string discretisations(const Plan& plan) {
    static constexpr std::array names{"node", "mortar", "petrov_galerkin"};
    std::string text;
    for (std::size_t p = 0; p < plan.contact.size(); ++p) {
        const std::string& why = plan.choices[p].discretisation;
        text += (text.empty() ? "" : ", ") + plan.contact[p].first + ": " +
                (why.empty() ? names[static_cast<std::size_t>(*plan.contact[p].second.discretisation)] : why);
    }
    if (plan.general)
        text +=
            (text.empty() ? "" : ", ") + std::string("general: ") +
            (plan.general_choice.discretisation.empty() ? names[static_cast<std::size_t>(*plan.general->discretisation)]
                                                        : plan.general_choice.discretisation);
    return text;
}

bool has_contact(const Plan& plan) {
    return !plan.model.pairs.empty() || plan.model.general;
}

void add_surface_items(const scene::Scene& scene, const Plan& plan, PlanList& list) {
    const bool contact = has_contact(plan);
    PlanCost patches{0, 0, "patches fitted once"};
    std::string smooth, flat;
    double images = 0, slave_facets = 0;
    for (const auto& pair : plan.model.pairs) {
        const scene::Pair& spec = *scene::find(scene.contact, pair->name());
        for (Index v = 0; v < pair->surface().vertex_count() && pair->mirrored(); ++v)
            images += pair->own_vertex(v) != v ? 1 : 0;
        if (averages(pair->options().discretisation)) slave_facets += static_cast<double>(pair->slaves().facets.size());
        if (std::holds_alternative<scene::FacetsSurface>(spec.master.surface)) continue;
        add_patches(spec.master, pair->surface(), patches);
        smooth += (smooth.empty() ? "" : ", ") + pair->name() + ": " + in_words(spec.master);
        if (stays_flat(plan, *pair))
            flat += fmt::format("; the master of {} stays flat: facets give the same forces on its slave nodes",
                                pair->name());
    }
    if (plan.model.general)
        for (const model::OuterSurface& surface : plan.model.general->surfaces()) {
            const model::MasterSide& side = *surface.side;
            for (Index v = 0; v < side.surface().vertex_count() && side.mirrored(); ++v)
                images += side.own_vertex(v) != v ? 1 : 0;
            if (!surface.smooth) continue;
            const scene::MasterSpec blend{{}, {}, scene::BlendSurface{}};
            add_patches(blend, side.surface(), patches);
            smooth += (smooth.empty() ? "" : ", ") + surface.name + ": " + in_words(blend);
        }
    for (const model::ContactHistory& history : plan.near_at_start)
        if (averages(history.pair->options().discretisation))
            slave_facets += static_cast<double>(history.pair->slaves().facets.size());
    list.say("smooth master surface", !smooth.empty(),
             !smooth.empty() ? smooth + flat
             : contact       ? "every pair has facets"
                             : no_pair,
             patches);
    list.say("mirror images", images > 0,
             images > 0 ? "a master is cut at a plane of symmetry"
             : contact  ? "no master is cut at a plane of symmetry"
                        : no_pair,
             {sizeof(Vec3) * images, images, "vertices an iteration"});
    list.say("averaged forces", slave_facets > 0, contact ? discretisations(plan) : no_pair,
             {0, slave_facets, "slave facets an iteration"});
}

} // namespace

void add_contact_items(const scene::Scene& scene, const Plan& plan, PlanList& list) {
    const bool contact = has_contact(plan);
    list.say("contact", contact, contact ? fmt::format("{} pair(s)", plan.pairs_at_start().size()) : no_pair,
             contact_cost(plan));
    const auto surfaces = plan.model.general ? plan.model.general->surfaces().size() : 0;
    list.say("general contact", surfaces > 0,
             surfaces > 0 ? fmt::format("{} outer surfaces may meet; {} pair(s) of them are near at the start",
                                        surfaces, plan.near_at_start.size())
                          : "the scene has no contact.general",
             {sizeof(Vec3) * static_cast<double>(plan.model.nodes()), 0, {}});
    std::string roles;
    for (std::size_t p = 0; p < plan.contact.size(); ++p)
        if (!plan.choices[p].roles.empty())
            roles += (roles.empty() ? "" : ", ") + plan.contact[p].first + ": " + plan.choices[p].roles;
    list.say("choice of slaves", !roles.empty(),
             !roles.empty() ? roles
             : contact      ? "every pair names slave and master, or geometry chooses in general contact"
                            : no_pair,
             {0, 0, {}});
    double rubbing = slave_nodes(plan, [](const auto& pair) { return pair.options().friction > 0; });
    for (const time::Stage& stage : plan.stages)
        for (const auto& pair : stage.pairs)
            if (pair->options().friction > 0) rubbing = std::max(rubbing, static_cast<double>(pair->size()));
    list.say("friction", rubbing > 0,
             rubbing > 0 ? "a pair has mu > 0"
             : contact   ? "no pair has mu > 0"
                         : no_pair,
             {0, rubbing, "slave nodes an iteration"});
    add_surface_items(scene, plan, list);

    const double slaves = slave_nodes(plan, [](const auto&) { return true; });
    const auto controlled = std::ranges::count_if(
        plan.stages, [](const time::Stage& stage) { return std::isfinite(stage.limits.allowed_interpenetration); });
    list.say(
        "interpenetration control", contact && controlled > 0,
        !contact ? no_pair
        : controlled > 0
            ? fmt::format("{} stage(s) solve a trial first and judge its gaps; static ones by default only after a cut",
                          controlled)
            : "no static stage has control.allowed_interpenetration",
        {0, 1, "more solve(s) a step"});
    double finest = std::numeric_limits<double>::infinity();
    for (const auto& pair : plan.pairs_at_start()) finest = std::min(finest, pair->finest());
    const bool paths = std::ranges::any_of(plan.stages, &time::Stage::follow_paths);
    list.say("collision check", paths,
             paths ? fmt::format("paths of open nodes, in steps that move them by {:.3g} m or more against a master, "
                                 "or in which they lose it",
                                 time::CollisionCheck::reach * finest)
                   : (contact ? "every stage is static" : no_pair),
             {sizeof(Vec3) * static_cast<double>(plan.model.nodes()), 2 * slaves, "slave nodes a step"});
}

} // namespace osculate::app
