#include "app/plan/settle_pairs.hpp"

#include "app/fault.hpp"
#include "app/plan/body_materials.hpp"
#include "app/plan/loose_slaves.hpp"
#include "app/plan/smooth_parts.hpp"
#include "osculate/fe/facet_quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace osculate::app {

namespace {

/// By how much sides must differ before their order does not decide.
constexpr double clearly = 1.1;

/// One side of a pair that has no roles.
struct Side {
    std::string set;
    double size; ///< root of the mean area of its facets, m
    double E;    ///< Young's modulus under it, Pa
};

Side side_of(const Draft& draft, const std::string& name) {
    const model::Set& set = draft.set(name);
    double area = 0;
    for (const mesh::Facet& facet : set.facets) {
        const auto parts = fe::tributary_areas(facet, draft.plan.model.X);
        area = std::accumulate(parts.begin(), parts.end(), area);
    }
    const double count = std::max<double>(1, static_cast<double>(set.facets.size()));
    const auto body = static_cast<std::size_t>(set.body);
    return {name, std::sqrt(area / count),
            modulus_under(draft.scene.bodies[body].second, draft.plan.model.bodies[body], set.facets)};
}

/// Gaps are measured at the slave's nodes: a finer side sees more of the other, and a softer one gives way to it.
std::string choose_slave(const Draft& draft, scene::Pair& pair) {
    Side slave = side_of(draft, pair.between[0]), master = side_of(draft, pair.between[1]);
    const auto softer = [&](double times) { return slave.E * times < master.E; };
    const auto finer = [&] { return slave.size * clearly < master.size; };
    const auto decide = [&](auto&& first_is) { // of either order
        if (first_is()) return true;
        std::swap(slave, master);
        if (first_is()) return true;
        std::swap(slave, master);
        return false;
    };
    std::string why;
    if (decide([&] { return softer(much_stiffer); }))
        why =
            fmt::format("the slave is {}, as '{}' is {:.3g} times as stiff", slave.set, master.set, master.E / slave.E);
    else if (decide(finer))
        why = fmt::format("the slave is {}, whose facets are {:.3g} times as long as those of '{}'", slave.set,
                          slave.size / master.size, master.set);
    else if (decide([&] { return softer(clearly); }))
        why = fmt::format("the slave is {}, as '{}' is {:.3g} times as stiff and meshed alike", slave.set, master.set,
                          master.E / slave.E);
    else
        why = fmt::format("the slave is {}, the first of two sides that are meshed alike and as stiff", slave.set);
    pair.slave = slave.set;
    pair.master.set = master.set;
    pair.between = {};
    return why;
}

std::string why_discretisation(bool dynamic) {
    return dynamic ? "node, which conserves energy: a stage is dynamic" : "petrov_galerkin: every stage is static";
}

/// Whether the body of a set is one facet wide: as a master it tells a smooth surface nothing about its slope across.
bool is_slice(const Draft& draft, const std::string& set) {
    const auto body = static_cast<std::size_t>(draft.set(set).body);
    return draft.scene.bodies[body].second.slice.has_value();
}

/// Patches over a plane face give the gaps and normals of its facets, as long as it does not bend; in steps of dynamics
/// the little that it bends is not worth them. In statics the shares of the master's nodes are results, which would change.
bool facets_suffice(const Draft& draft, const scene::Pair& pair, bool dynamic) {
    if (is_slice(draft, pair.master.set)) return true;
    if (!dynamic || pair.discretisation != Discretisation::node) return false;
    const std::vector<Vec3>& X = draft.plan.model.X;
    const std::vector<mesh::Facet>& facets = draft.set(pair.master.set).facets;
    if (facets.empty()) return false;
    try {
        return smooth_parts(mesh::HalfEdgeSurface(facets, X), X).plane;
    } catch (const std::runtime_error&) { // no manifold, which is a fault of its own
        return false;
    }
}

} // namespace

void settle_pairs(Draft& draft) {
    const bool dynamic = std::ranges::any_of(draft.scene.stages, [](const auto& stage) {
        return std::holds_alternative<scene::DynamicAnalysis>(stage.second.analysis);
    });
    for (auto& [name, pair] : draft.scene.contact) {
        PairChoice& choice = draft.plan.choices.emplace_back();
        if (!pair.between[0].empty()) choice.roles = choose_slave(draft, pair);
        // a rigid surface is exact at every node, whatever facets draw it
        const bool exact = !pair.master.rigid_surface.empty();
        // nodes of a slice above one another would have the same average twice, which an exact law does not share out
        const bool slice = is_slice(draft, pair.slave),
                   gives = !std::holds_alternative<scene::ExactContact>(pair.pressure_overclosure);
        if (slice && !gives && pair.discretisation && *pair.discretisation != Discretisation::node)
            draft.faults.push_back(fault("contact." + name + ".discretisation",
                                         "node, where the slave is a slice and contact is exact", "another"));
        const bool loose = !loose_slaves(draft, pair.slave).empty();
        if (loose && pair.discretisation && *pair.discretisation != Discretisation::node)
            draft.faults.push_back(fault("contact." + name + ".discretisation",
                                         "node, where nodes of the slave cover no facet to take averages over",
                                         "another"));
        if (!pair.discretisation && loose) {
            pair.discretisation = Discretisation::node;
            choice.discretisation = "node: nodes of the slave cover no facet";
        }
        if (!pair.discretisation && slice && !gives) {
            pair.discretisation = Discretisation::node;
            choice.discretisation = "node: the slave is a slice, whose nodes above one another are one";
        }
        if (!pair.discretisation) {
            // forces that are not the work conjugates of the gaps add energy, or take it, in every impact
            pair.discretisation = dynamic || exact ? Discretisation::node : Discretisation::petrov_galerkin;
            choice.discretisation =
                exact ? "node: the master is a rigid surface, exact at every node" : why_discretisation(dynamic);
        }
        if (!std::holds_alternative<scene::AutomaticSurface>(pair.master.surface)) {
            if (!exact && is_slice(draft, pair.master.set) &&
                !std::holds_alternative<scene::FacetsSurface>(pair.master.surface))
                draft.faults.push_back(fault("contact." + name + ".master.surface",
                                             "facets: a slice is one facet wide, which gives no smooth surface",
                                             "another surface"));
            continue;
        }
        if (!exact && facets_suffice(draft, pair, dynamic))
            pair.master.surface = scene::FacetsSurface{};
        else
            pair.master.surface = scene::BlendSurface{};
    }
    draft.plan.contact = draft.scene.contact;
    if (draft.scene.general && !draft.scene.general->discretisation) {
        draft.scene.general->discretisation = dynamic ? Discretisation::node : Discretisation::petrov_galerkin;
        draft.plan.general_choice.discretisation = why_discretisation(dynamic);
    }
    draft.plan.general = draft.scene.general;
}

} // namespace osculate::app
