#include "app/check/facing.hpp"

#include <map>

namespace osculate::app {

Facing facing(const model::ContactEvaluation& evaluation, const std::vector<Vec3>& X) {
    const model::ContactPair& pair = evaluation.pair();
    constexpr double beyond = 0.1; // cosine: a facet at right angles to the master, as behind a rounded edge, is none
    std::map<Index, const contact::ContactPoint*> points; // by slave node
    for (Index j = 0; j < pair.size(); ++j)
        if (const contact::ContactPoint& point = evaluation.point(j); point.found)
            points.emplace(pair.slaves().node[static_cast<std::size_t>(j)], &point);
    Facing result;
    for (std::size_t f = 0; f < pair.slaves().facets.size(); ++f) {
        const mesh::Facet& facet = pair.slaves().facets[f];
        Vec3 master = Vec3::Zero();
        bool all = true, near = true;
        for (const Index node : facet) {
            const auto point = points.find(node);
            all = all && point != points.end();
            if (!all) break;
            master += point->second->normal;
            near = near && point->second->gap < pair.surface().facet_size(point->second->facet);
        }
        if (!all) continue;
        ++result.facets;
        if (mesh::facet_normal(facet, X).dot(master.normalized()) <= beyond) continue;
        ++result.turned;
        if (near) result.away.push_back(f);
    }
    return result;
}

} // namespace osculate::app
