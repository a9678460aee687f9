#include "app/plan/smooth_parts.hpp"

namespace osculate::app {

SmoothParts smooth_parts(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X) {
    constexpr double same = 1e-6; // of the angle between two normals
    const auto normal = [&](Index f) { return mesh::facet_area_vector(surface.facets()[f], X).normalized(); };
    const auto ends = [&](Index h) { return surface.is_boundary_edge(h) || surface.is_feature_edge(h); };
    std::vector<char> rim(static_cast<std::size_t>(surface.vertex_count()), 0);
    for (Index h = 0; h < static_cast<Index>(surface.half_edges().size()); ++h)
        if (ends(h)) {
            const mesh::HalfEdge& edge = surface.half_edges()[h];
            rim[edge.origin] = rim[surface.half_edges()[edge.next].origin] = 1;
        }
    SmoothParts parts;
    std::vector<char> seen(static_cast<std::size_t>(surface.facet_count()), 0);
    for (Index first = 0; first < surface.facet_count(); ++first) {
        std::vector<Index> waiting{first};
        bool plane = true, wide = false;
        while (!waiting.empty()) {
            const Index f = waiting.back();
            waiting.pop_back();
            if (seen[f] != 0) continue;
            seen[f] = 1;
            const auto vertices = surface.facet_vertices(f);
            for (std::size_t c = 0; c < vertices.size(); ++c) {
                wide = wide || rim[vertices[c]] == 0;
                const Index h = surface.first_half_edge(f) + static_cast<Index>(c);
                if (ends(h)) continue;
                const Index next = surface.half_edges()[surface.half_edges()[h].twin].facet;
                plane = plane && normal(f).cross(normal(next)).norm() <= same;
                waiting.push_back(next);
            }
        }
        parts.plane = parts.plane && plane;
        parts.strips = parts.strips || (!plane && !wide);
    }
    return parts;
}

} // namespace osculate::app
