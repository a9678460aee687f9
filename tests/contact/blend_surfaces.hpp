#pragma once
/// Closed, open and folded surfaces for the tests of the vertex gap blend, and a blend over one of them.

#include "osculate/contact/master_surface.hpp"
#include "surfaces.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <string>

namespace osculate::contact::fixtures {

constexpr double pi = std::numbers::pi;

/// OSCULATE_FULL=1: as many samples as are needed to find what is one in a million. Minutes.
inline bool full() {
    const char* set = std::getenv("OSCULATE_FULL");
    return set != nullptr && std::string(set) == "1";
}

/// Keeps a measured figure in the test's report; with OSCULATE_FULL=1 prints it too.
inline void record(const std::string& what, double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    ::testing::Test::RecordProperty(what, text);
    if (full()) std::printf("    %s: %s\n", what.c_str(), text);
}

/// Facets over numbered positions, before their topology is built.
struct Shell {
    std::vector<Vec3> x;
    std::vector<std::vector<Index>> facets;

    [[nodiscard]] Surface surface(const std::string& name, double feature_angle = mesh::default_feature_angle) const {
        std::vector<mesh::Facet> list;
        for (const auto& corners : facets) {
            mesh::Facet facet;
            facet.count = static_cast<int>(corners.size());
            std::copy(corners.begin(), corners.end(), facet.nodes.begin());
            list.push_back(facet);
        }
        mesh::HalfEdgeSurface topology(list, x, feature_angle);
        std::vector<Vec3> positions;
        for (const Index node : topology.vertex_nodes()) positions.push_back(x[node]);
        return {name, std::move(topology), std::move(positions)};
    }
};

/// n1 x n2 quadrilaterals over the unit square, mapped; a facet for which `cut` holds becomes two triangles. Periodic
/// directions are closed.
inline Shell grid(
    int n1, int n2, bool periodic1, bool periodic2, const std::function<Vec3(double, double)>& map,
    const std::function<bool(int, int)>& cut = [](int, int) { return false; }) {
    Shell shell;
    const int m1 = periodic1 ? n1 : n1 + 1, m2 = periodic2 ? n2 : n2 + 1;
    for (int j = 0; j < m2; ++j)
        for (int i = 0; i < m1; ++i) shell.x.push_back(map(double(i) / n1, double(j) / n2));
    const auto at = [&](int i, int j) { return (i % m1) + m1 * (j % m2); };
    for (int j = 0; j < n2; ++j)
        for (int i = 0; i < n1; ++i) {
            const Index a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if (!cut(i, j)) {
                shell.facets.push_back({a, b, c, d});
            } else if ((i + j) % 2 == 0) {
                shell.facets.push_back({a, b, c});
                shell.facets.push_back({a, c, d});
            } else {
                shell.facets.push_back({a, b, d});
                shell.facets.push_back({b, c, d});
            }
        }
    return shell;
}

/// An irregular half of all facets, always the same.
inline bool irregular(int i, int j) {
    return (7 * i + 5 * j + i * j) % 11 < 5;
}

/// Icosahedron of unit radius whose facets are cut in four `times` times.
inline Shell icosphere(int times) {
    const double t = (1 + std::sqrt(5.0)) / 2;
    Shell s;
    s.x = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
           {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
    s.facets = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (Vec3& p : s.x) p.normalize();
    for (int k = 0; k < times; ++k) {
        std::map<std::pair<Index, Index>, Index> middle;
        const auto mid = [&](Index a, Index b) {
            const auto [place, fresh] = middle.try_emplace(std::minmax(a, b), static_cast<Index>(s.x.size()));
            if (fresh) s.x.push_back((s.x[a] + s.x[b]).normalized());
            return place->second;
        };
        std::vector<std::vector<Index>> finer;
        for (const auto& f : s.facets) {
            const Index a = mid(f[0], f[1]), b = mid(f[1], f[2]), c = mid(f[2], f[0]);
            finer.insert(finer.end(), {{f[0], a, c}, {a, f[1], b}, {c, b, f[2]}, {a, b, c}});
        }
        s.facets = std::move(finer);
    }
    return s;
}

/// Surface of the cube [-1, 1]^3 with n x n squares a face, `cut` ones in two; f(p) places its vertices.
inline Shell cube(int n, bool hybrid, const std::function<Vec3(const Vec3&)>& place) {
    Shell s;
    std::map<std::array<int, 3>, Index> number;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, n}) {
            const auto at = [&](int i, int j) {
                std::array<int, 3> k{};
                k[axis] = side;
                k[(axis + 1) % 3] = side == 0 ? j : i; // outward either way
                k[(axis + 2) % 3] = side == 0 ? i : j;
                const auto [found, fresh] = number.try_emplace(k, static_cast<Index>(s.x.size()));
                if (fresh) s.x.push_back(place(Vec3(2.0 * k[0] / n - 1, 2.0 * k[1] / n - 1, 2.0 * k[2] / n - 1)));
                return found->second;
            };
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const Index a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
                    if (hybrid && irregular(i + 3 * axis, j + side)) {
                        s.facets.push_back({a, b, c});
                        s.facets.push_back({a, c, d});
                    } else {
                        s.facets.push_back({a, b, c, d});
                    }
                }
        }
    return s;
}

/// Unit sphere from a cube with equal angles along its edges, half of its squares cut in two.
inline Shell hybrid_sphere(int n) {
    return cube(n, true, [](const Vec3& p) -> Vec3 {
        return Vec3(std::tan(pi / 4 * p.x()), std::tan(pi / 4 * p.y()), std::tan(pi / 4 * p.z())).normalized();
    });
}

/// Radii 3 and 1 about z; outward.
inline Shell torus(int around, int across) {
    return grid(
        around, across, true, true,
        [](double a, double b) {
            const double r = 3 + std::cos(2 * pi * b);
            return Vec3(r * std::cos(2 * pi * a), r * std::sin(2 * pi * a), std::sin(2 * pi * b));
        },
        irregular);
}

inline double saddle_height(double x, double y) {
    return 0.15 * x * x - 0.1 * y * y;
}
inline Shell saddle(int n) {
    return grid(
        n, n, false, false,
        [](double a, double b) {
            const double x = 4 * a - 2, y = 4 * b - 2;
            return Vec3(x, y, saddle_height(x, y));
        },
        irregular);
}

/// A blend over one surface; x are the current positions, surface.x stays the reference.
struct Blend {
    explicit Blend(Surface s, const BlendOptions& options = {})
        : surface(std::move(s)), search(surface.topology), x(surface.x),
          master(make_blend_surface(surface.topology, surface.x, options)) {
        search.build(x);
    }
    Blend(const Blend&) = delete;
    Blend& operator=(const Blend&) = delete;

    [[nodiscard]] ContactPoint at(const Vec3& s, const FacetHit& hit, ContactVariation* variation = nullptr) const {
        ContactPoint point;
        master->evaluate(s, hit, x, point, variation);
        return point;
    }
    [[nodiscard]] ContactPoint at(const Vec3& s, ContactVariation* variation = nullptr) const {
        return at(s, search.global(s, x), variation);
    }
    void move(const auto& f) {
        for (Vec3& p : x) p = f(p);
        search.build(x);
    }

    Surface surface;
    FacetSearch search;
    std::vector<Vec3> x;
    std::unique_ptr<MasterSurface> master;
};

} // namespace osculate::contact::fixtures
