#include "contact/creases.hpp"

#include "contact/vertex_patch.hpp"

#include <algorithm>

namespace osculate::contact {

Creases::Creases(const mesh::HalfEdgeSurface& surface)
    : surface_(&surface), of_(static_cast<std::size_t>(surface.facet_count())) {
    for (Index f = 0; f < surface.facet_count(); ++f) {
        const auto v = surface.facet_vertices(f);
        std::vector<Neighbour>& own = of_[static_cast<std::size_t>(f)];
        for (std::size_t c = 0; c < v.size(); ++c) {
            const int corner = static_cast<int>(c);
            const Index h = surface.first_half_edge(f) + corner;
            if (surface.is_feature_edge(h))
                own.push_back({corner, true, surface.half_edges()[surface.half_edges()[h].twin].facet});
            for (const auto& sector : sectors(surface, v[c]))
                if (!std::binary_search(sector.begin(), sector.end(), f))
                    own.push_back({corner, false, sector.front()});
        }
        none_ = none_ && own.empty();
    }
}

std::vector<Index> Creases::across(const FacetHit& hit) const {
    std::vector<Index> result;
    if (hit.latched || hit.limited || hit.overhang == 0 || of(hit.facet).empty()) return result;
    const int n = static_cast<int>(surface_->facet_vertices(hit.facet).size());
    const auto on_edge = [&](int c) {
        const Vec2& u = hit.u;
        const double square[] = {1 + u.y(), 1 - u.x(), 1 - u.y(), 1 + u.x()};
        const double triangle[] = {u.y(), 1 - u.sum(), u.x()};
        return (n == 4 ? square : triangle)[c] < tie;
    };
    for (const Neighbour& k : of(hit.facet)) {
        const bool this_edge = on_edge(k.corner), last_edge = on_edge((k.corner + n - 1) % n);
        if (k.edge ? this_edge : this_edge && last_edge) result.push_back(k.facet);
    }
    return result;
}

} // namespace osculate::contact
