#pragma once
/// Master surfaces for the tests of search and evaluation, from the mesh generators.

#include "osculate/mesh/generators.hpp"
#include "osculate/mesh/half_edge_surface.hpp"
#include "support/random.hpp"

#include <string>

namespace osculate::contact::fixtures {

/// A surface and the positions of its vertices, local numbering.
struct Surface {
    std::string name;
    mesh::HalfEdgeSurface topology;
    std::vector<Vec3> x;
};

inline Surface surface_of(const std::string& name, const mesh::Mesh& mesh, const std::string& part,
                          double feature_angle = mesh::default_feature_angle) {
    mesh::HalfEdgeSurface topology(mesh.surfaces.at(part), mesh.nodes, feature_angle);
    std::vector<Vec3> x;
    for (const Index node : topology.vertex_nodes()) x.push_back(mesh.nodes[node]);
    return {name, std::move(topology), std::move(x)};
}

/// Inner surface of the half-tube of radius 3 and length 12, 15 degrees a facet.
constexpr double tube_radius = 3, tube_length = 12;
inline Surface half_tube(mesh::CellType element = mesh::CellType::hex8, int around = 12) {
    return surface_of(element == mesh::CellType::hex8 ? "HalfTube" : "HalfTubeTet4",
                      mesh::make_half_tube(tube_radius, 1, tube_length, {around, 13, 1}, element), "inner");
}

/// Top z = 0 of the block [0, 5] x [0, 4].
inline Surface block_top(mesh::BlockPattern pattern) {
    const char* names[] = {"Quadrilaterals", "Triangles", "Hybrid"};
    return surface_of(names[static_cast<int>(pattern)],
                      mesh::make_block({0, 0, -1}, {5, 4, 1}, {10, 8, 1}, mesh::CellType::hex8, pattern), "z_max");
}

inline std::vector<Surface> all_surfaces() {
    std::vector<Surface> all;
    all.push_back(half_tube());
    all.push_back(half_tube(mesh::CellType::tet4));
    for (const auto pattern : {mesh::BlockPattern::quad, mesh::BlockPattern::triangle, mesh::BlockPattern::hybrid})
        all.push_back(block_top(pattern));
    return all;
}

/// A random point of the surface's bounding box, made wider by `margin` on all sides.
inline Vec3 random_point(const Surface& surface, double margin, osculate::support::Random& random) {
    Vec3 low = surface.x[0], high = low;
    for (const Vec3& x : surface.x) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    Vec3 p;
    for (int k = 0; k < 3; ++k) p(k) = random.uniform(low(k) - margin, high(k) + margin);
    return p;
}

} // namespace osculate::contact::fixtures
