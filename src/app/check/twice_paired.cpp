#include "app/check/twice_paired.hpp"

#include "app/plan/rigid_surface.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>

namespace osculate::app {

namespace {

using Corners = std::array<Index, 4>;

/// A set as its facets' corners, both in ascending order.
struct Surface {
    Index body = -1;
    std::vector<Corners> facets;
};

Surface surface(const model::Model& model, const std::string& name) {
    Surface result;
    const auto set = std::ranges::find(model.sets, name, &model::Set::name);
    if (set == model.sets.end()) return result;
    result.body = set->body;
    for (const mesh::Facet& facet : set->facets) {
        result.facets.push_back(facet.nodes);
        std::ranges::sort(result.facets.back());
    }
    std::ranges::sort(result.facets);
    return result;
}

bool share_facets(const Surface& a, const Surface& b) {
    if (a.body != b.body) return false;
    std::vector<Corners> common;
    std::ranges::set_intersection(a.facets, b.facets, std::back_inserter(common));
    return !common.empty();
}

} // namespace

std::vector<Warning> twice_paired(const scene::Scene& scene, const Plan& plan) {
    struct Sides {
        Surface slave, master;
    };
    std::vector<Sides> sides;
    for (const auto& [name, pair] : scene.contact)
        sides.push_back({surface(plan.model, pair.slave), surface(plan.model, master_set(pair.master))});
    std::vector<Warning> found;
    for (std::size_t later = 0; later < sides.size(); ++later)
        for (std::size_t i = 0; i < later; ++i) {
            const std::string &name = scene.contact[later].first, &other = scene.contact[i].first;
            if (share_facets(sides[later].slave, sides[i].slave) && share_facets(sides[later].master, sides[i].master))
                found.push_back(
                    {"contact." + name, fmt::format("contact.{} already pairs these facets: every node of them has one "
                                                    "condition too many; leave one of the two out",
                                                    other)});
            else if (share_facets(sides[later].slave, sides[i].master) &&
                     share_facets(sides[later].master, sides[i].slave))
                found.push_back({"contact." + name,
                                 fmt::format("its slave is the master of contact.{}, and its master is the slave "
                                             "there: every node of the surfaces has one condition too many; leave one "
                                             "of the two out (discretisation: mortar treats both sides more alike)",
                                             other)});
        }
    return found;
}

} // namespace osculate::app
