#include "app/plan/loose_slaves.hpp"

#include "osculate/fe/facet_quadrature.hpp"

namespace osculate::app {

namespace {
bool chosen_by_nodes(const scene::SetSpec& set) {
    const auto* named = std::get_if<scene::SelectNamed>(&set.select);
    return std::holds_alternative<scene::SelectNumbers>(set.select) || (named != nullptr && named->nodes);
}
} // namespace

std::map<Index, Vec3> loose_slaves(const Draft& draft, const std::string& name) {
    const scene::SetSpec* const spec = scene::find(draft.scene.sets, name);
    if (spec == nullptr || !chosen_by_nodes(*spec)) return {};
    const model::Set& set = draft.set(name);
    const std::vector<Index> covered = mesh::nodes_of(set.facets); // ascending
    std::map<Index, Vec3> area;
    for (const Index node : set.nodes)
        if (!std::ranges::binary_search(covered, node)) area.emplace(node, Vec3::Zero());
    if (area.empty()) return {};
    for (const mesh::Facet& facet :
         model::exterior_facets(draft.plan.model.bodies[static_cast<std::size_t>(set.body)])) {
        if (std::none_of(facet.begin(), facet.end(), [&](Index node) { return area.contains(node); })) continue;
        const auto share = fe::tributary_areas(facet, draft.plan.model.X);
        const Vec3 normal = mesh::facet_normal(facet, draft.plan.model.X);
        for (int c = 0; c < facet.count; ++c)
            if (const auto at = area.find(facet.nodes[static_cast<std::size_t>(c)]); at != area.end())
                at->second += share[static_cast<std::size_t>(c)] * normal;
    }
    return area;
}

} // namespace osculate::app
