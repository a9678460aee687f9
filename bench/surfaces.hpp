#pragma once
/// Surfaces that the kernels are timed on, and slave points near them.

#include "osculate/contact/facet_patch.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/mesh/generators.hpp"

#include <random>
#include <string>
#include <vector>

namespace osculate::bench {

/// A surface and the positions of its vertices.
struct Surface {
    mesh::HalfEdgeSurface topology;
    std::vector<Vec3> x;

    Surface(const std::vector<mesh::Facet>& facets, const std::vector<Vec3>& nodes) : topology(facets, nodes) {
        for (const Index node : topology.vertex_nodes()) x.push_back(nodes[node]);
    }
};

/// Inner surface of the paper's half-tube, or the top of its soil, 25 x 25 facets.
inline const Surface& surface(const std::string& name) {
    static const auto on = [](const mesh::Mesh& mesh, const char* part) {
        return Surface(mesh.surfaces.at(part), mesh.nodes);
    };
    static const Surface half_tube = on(mesh::make_half_tube(3, 1, 12, {13, 12, 1}), "inner");
    static const Surface block = on(mesh::make_block({-5, -5, -1}, {10, 10, 1}, {25, 25, 1}), "z_max");
    return name == "half_tube" ? half_tube : block;
}

/// A wavy sheet of n x n unit quadrilaterals.
inline Surface sheet(int n) {
    std::vector<Vec3> nodes;
    std::vector<mesh::Facet> facets;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) nodes.emplace_back(i, j, std::sin(0.3 * i) * std::cos(0.2 * j));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Index a = j * (n + 1) + i;
            facets.push_back({{a, a + 1, a + n + 2, a + n + 1}, 4, -1, -1});
        }
    return {facets, nodes};
}

/// A point and a facet that it is near.
struct SlavePoint {
    Vec3 s;
    Index facet;
};

/// Points spread over the whole surface, within 5 % of a facet size of it.
inline std::vector<SlavePoint> slave_points(const Surface& surface, int count) {
    std::mt19937 engine(1);
    const auto uniform = [&](double low, double high) { return low + (high - low) * (engine() / 4294967296.0); };
    std::vector<SlavePoint> points;
    for (int k = 0; k < count; ++k) {
        const auto facet = static_cast<Index>(uniform(0, surface.topology.facet_count()));
        const auto vertices = surface.topology.facet_vertices(facet);
        const contact::FacetPatch patch(static_cast<int>(vertices.size()));
        contact::MatrixX3 corners(patch.size(), 3);
        for (Index c = 0; c < patch.size(); ++c) corners.row(c) = surface.x[vertices[c]].transpose();
        const contact::PatchPoint on = patch.point(Vec2(uniform(-1, 1), uniform(-1, 1)), corners);
        const double gap = uniform(-0.05, 0.05) * surface.topology.facet_size(facet);
        points.push_back({on.X + gap * on.normal(), facet});
    }
    return points;
}

} // namespace osculate::bench
