#pragma once
/// Every generated body in every element type, with the exact volume within its facets, and two integrals over a surface.

#include "osculate/mesh/generators.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace osculate::mesh::fixtures {

struct Shape {
    std::string name;
    Mesh mesh;
    double volume; ///< of the faceted body, cubic metres
    double area;   ///< of its exterior in hex8, square metres
};

inline std::vector<std::pair<std::string, CellType>> element_types() {
    std::vector<std::pair<std::string, CellType>> types;
    for (const CellType type : generated_types()) types.emplace_back(cell_info(type).name, type);
    return types;
}

/// Half-tube's cross-section is a ring of trapezia.
inline double half_tube_volume(double inner, double thickness, double length, int around) {
    const double outer = inner + thickness;
    return length * around * 0.5 * std::sin(std::numbers::pi / around) * (outer * outer - inner * inner);
}

/// Contactor's cross-section is a row of trapezia below the flat top.
inline double contactor_volume(double radius, double width, double length, double height, int across) {
    double area = 0;
    for (int i = 0; i < across; ++i) {
        double depth = 0;
        for (const int end : {i, i + 1}) {
            const double x = width * (double(end) / across - 0.5);
            depth += (height - radius) + std::sqrt(radius * radius - x * x);
        }
        area += width / across * depth / 2;
    }
    return area * length;
}

/// Integrals over facets by 2 x 2 Gauss points on bilinear quadrilaterals, exactly on triangles.
struct SurfaceIntegrals {
    double volume = 0;               ///< a third of the integral of x . n: the enclosed volume when closed
    Vec3 area_vector = Vec3::Zero(); ///< zero when closed
    double area = 0;
};

inline SurfaceIntegrals integrate(const std::vector<Facet>& facets, const std::vector<Vec3>& positions) {
    SurfaceIntegrals sum;
    const auto add = [&](const Vec3& x, const Vec3& n) {
        sum.volume += x.dot(n) / 3;
        sum.area_vector += n;
        sum.area += n.norm();
    };
    for (const Facet& facet : facets) {
        const auto at = [&](int i) { return positions[facet.nodes[i]]; };
        if (facet.count == 3) {
            add((at(0) + at(1) + at(2)) / 3, 0.5 * (at(1) - at(0)).cross(at(2) - at(0)));
            continue;
        }
        const double g = 0.5 / std::sqrt(3.0);
        for (const double u : {0.5 - g, 0.5 + g})
            for (const double v : {0.5 - g, 0.5 + g}) {
                const Vec3 x = (1 - u) * (1 - v) * at(0) + u * (1 - v) * at(1) + u * v * at(2) + (1 - u) * v * at(3);
                const Vec3 x_u = (1 - v) * (at(1) - at(0)) + v * (at(2) - at(3));
                const Vec3 x_v = (1 - u) * (at(3) - at(0)) + u * (at(2) - at(1));
                add(x, 0.25 * x_u.cross(x_v));
            }
    }
    return sum;
}

/// Facets that end at midside nodes are half as long as the element.
inline int facets_per_edge(CellType type) {
    return cell_info(type).edges.empty() ? 1 : 2;
}

/// Whether every node of the grid on a side is a corner of facets there, so that a curved side is that of hex8; faces of
/// eight nodes leave out the node in their middle.
inline bool has_facets_of_hex8(CellType type) {
    const CellInfo& info = cell_info(type);
    return info.edges.empty() || std::ranges::all_of(info.faces, [](const LocalFace& face) { return face.count == 3; });
}

inline std::vector<Shape> all_shapes() {
    std::vector<Shape> shapes;
    const auto add = [&](const std::string& name, double volume, const auto& make, CellType type,
                         BlockPattern pattern = BlockPattern::quad) {
        const Mesh hexes = make(CellType::hex8, BlockPattern::quad, facets_per_edge(type));
        const double area = integrate(exterior_facets(hexes), hexes.nodes).area;
        shapes.push_back({name, make(type, pattern, 1), volume, area});
    };
    const auto block = [](CellType type, BlockPattern pattern, int m) {
        return make_block({-1, 2, 0.5}, {2, 3, 1}, {5 * m, 4 * m, 2 * m}, type, pattern);
    };
    const auto tube = [](CellType type, BlockPattern, int m) {
        return make_half_tube(3, 1, 12, {13 * m, 5 * m, 3 * m}, type);
    };
    const auto contactor = [](CellType type, BlockPattern, int m) {
        return make_contactor(3, 4, 4, 1, 0.5, {12 * m, 5 * m, 3 * m}, type);
    };
    const auto cell = [](CellType type, BlockPattern, int m) {
        return make_block({0, 0, 0}, {1, 1, 1}, {m, m, m}, type);
    };
    for (const auto& [name, type] : element_types()) {
        const int m = facets_per_edge(type);
        add("block " + name, 6, block, type);
        add("single cell " + name, 1, cell, type);
        if (!has_facets_of_hex8(type)) continue;
        add("half_tube " + name, half_tube_volume(3, 1, 12, 13 * m), tube, type);
        add("contactor " + name, contactor_volume(3, 4, 4, 1, 12 * m), contactor, type);
    }
    add("block triangle", 6, block, CellType::hex8, BlockPattern::triangle);
    add("block hybrid", 6, block, CellType::hex8, BlockPattern::hybrid);
    return shapes;
}

} // namespace osculate::mesh::fixtures
