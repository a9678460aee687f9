#include "osculate/study/study_meshes.hpp"

#include "osculate/mesh/generators.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace osculate::study {

namespace {

/// These surfaces have no creases, whatever a coarse mesh of them looks like.
constexpr double no_features = std::numbers::pi;

SurfaceMesh surface_mesh(std::vector<mesh::Facet> facets, const std::vector<Vec3>& nodes) {
    mesh::HalfEdgeSurface topology(std::move(facets), nodes, no_features);
    std::vector<Vec3> x;
    for (const Index node : topology.vertex_nodes()) x.push_back(nodes[static_cast<std::size_t>(node)]);
    return {std::move(topology), std::move(x)};
}

/// Always the same number in [-1, 1] for a node and component.
double scatter(Index node, unsigned component) {
    std::uint64_t z = (std::uint64_t{static_cast<std::uint32_t>(node)} << 2 | component) + 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u; // splitmix64
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    z ^= z >> 31;
    return 2 * (static_cast<double>(z >> 11) * 0x1p-53) - 1;
}

double height_of(const Sphere& sphere, const Vec2& p) {
    return sphere.centre.z() + std::sqrt(sphere.radius * sphere.radius - (p - sphere.centre.head<2>()).squaredNorm());
}

double height_of(const Torus& torus, const Vec2& p) {
    const double off = (p - torus.centre.head<2>()).norm() - torus.ring_radius;
    return torus.centre.z() + std::sqrt(torus.tube_radius * torus.tube_radius - off * off);
}

double height_of(const Saddle& saddle, const Vec2& p) {
    return saddle.height(p.x(), p.y());
}

SurfaceMesh refined(const Sphere& sphere, int n, double irregularity) {
    mesh::Mesh cube = mesh::make_block(Vec3::Constant(-1), Vec3::Constant(2), {n, n, n}, mesh::CellType::hex8,
                                       mesh::BlockPattern::hybrid);
    const double quarter = std::numbers::pi / 4;
    for (Index i = 0; i < cube.node_count(); ++i) {
        Vec3& x = cube.nodes[static_cast<std::size_t>(i)];
        const Vec3 even = (quarter * x).array().tan(); // equal angles along the edges
        Vec3 direction = even.normalized();
        const double edge = 2 * quarter / n;
        direction += irregularity * edge * Vec3(scatter(i, 0), scatter(i, 1), scatter(i, 2));
        x = sphere.centre + sphere.radius * direction.normalized();
    }
    return surface_mesh(mesh::exterior_facets(cube), cube.nodes);
}

SurfaceMesh refined(const Torus& torus, int n, double irregularity) {
    const int around_ring = 2 * n, around_tube = n;
    const mesh::Mesh sheet =
        mesh::make_block(Vec3::Zero(), Vec3(around_ring, around_tube, 1), {around_ring, around_tube, 1},
                         mesh::CellType::hex8, mesh::BlockPattern::hybrid);
    // the sheet's opposite sides become one
    const auto wrapped = [&](Index node) {
        const Vec3& x = sheet.nodes[static_cast<std::size_t>(node)];
        const auto i = static_cast<Index>(std::lround(x.x())) % around_ring,
                   j = static_cast<Index>(std::lround(x.y())) % around_tube;
        return i + around_ring * j;
    };
    std::vector<mesh::Facet> facets = sheet.surfaces.at("z_max");
    for (mesh::Facet& facet : facets)
        for (int c = 0; c < facet.count; ++c)
            facet.nodes[static_cast<std::size_t>(c)] = wrapped(facet.nodes[static_cast<std::size_t>(c)]);
    std::vector<Vec3> nodes;
    for (int j = 0; j < around_tube; ++j)
        for (int i = 0; i < around_ring; ++i) {
            const auto node = static_cast<Index>(nodes.size());
            const double turn = 2 * std::numbers::pi;
            const double ring = turn * (i + irregularity * scatter(node, 0)) / around_ring;
            const double tube = turn * (j + irregularity * scatter(node, 1)) / around_tube;
            const double r = torus.ring_radius + torus.tube_radius * std::cos(tube);
            nodes.push_back(torus.centre +
                            Vec3(r * std::cos(ring), r * std::sin(ring), torus.tube_radius * std::sin(tube)));
        }
    return surface_mesh(std::move(facets), nodes);
}

SurfaceMesh refined(const Saddle& saddle, int n, double irregularity) {
    constexpr double edge = 2;
    mesh::Mesh sheet = mesh::make_block(saddle.centre - Vec3(edge / 2, edge / 2, 1), Vec3(edge, edge, 1), {n, n, 1},
                                        mesh::CellType::hex8, mesh::BlockPattern::hybrid);
    for (Index i = 0; i < sheet.node_count(); ++i) {
        Vec3& x = sheet.nodes[static_cast<std::size_t>(i)];
        const double from_middle = (x - saddle.centre).head<2>().cwiseAbs().maxCoeff();
        if (from_middle < edge / 2 * (1 - 0.5 / n))
            x.head<2>() += irregularity * edge / n * Vec2(scatter(i, 0), scatter(i, 1));
        x.z() = saddle.height(x.x(), x.y());
    }
    return surface_mesh(sheet.surfaces.at("z_max"), sheet.nodes);
}

} // namespace

SurfaceMesh lift(const std::vector<Vec2>& plane, std::vector<mesh::Facet> facets, const ExactSurface& exact) {
    std::vector<Vec3> nodes;
    for (const Vec2& p : plane) {
        const double height = std::visit([&](const auto& surface) { return height_of(surface, p); }, exact);
        if (!std::isfinite(height))
            throw std::runtime_error("node " + std::to_string(nodes.size()) +
                                     " of the plane mesh does not lie below the surface");
        nodes.emplace_back(p.x(), p.y(), height);
    }
    return surface_mesh(std::move(facets), nodes);
}

SurfaceMesh refined_mesh(const ExactSurface& exact, int n, double irregularity) {
    return std::visit([&](const auto& surface) { return refined(surface, n, irregularity); }, exact);
}

} // namespace osculate::study
