#include "app/facing.hpp"

#include <map>

namespace osculate::app {

Facing facing(const model::ContactTerm& pair, const std::vector<Vec3>& X) {
    constexpr double beyond = 0.1; // cosine: a facet at right angles to the master, as behind a rounded edge, is none
    std::map<Index, Vec3> normals; // of the master, by slave node
    for (Index j = 0; j < pair.size(); ++j)
        if (const contact::ContactPoint& point = pair.point(j); point.found)
            normals.emplace(pair.slaves().node[static_cast<std::size_t>(j)], point.normal);
    Facing result;
    for (std::size_t f = 0; f < pair.slaves().facets.size(); ++f) {
        const mesh::Facet& facet = pair.slaves().facets[f];
        Vec3 master = Vec3::Zero();
        bool all = true;
        for (const Index node : facet) {
            const auto normal = normals.find(node);
            all = all && normal != normals.end();
            if (all) master += normal->second;
        }
        if (!all) continue;
        ++result.facets;
        if (mesh::facet_normal(facet, X).dot(master.normalized()) > beyond) result.away.push_back(f);
    }
    return result;
}

} // namespace osculate::app
