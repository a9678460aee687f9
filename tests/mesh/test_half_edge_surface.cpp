#include "mesh/shapes.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <map>
#include <set>
#include <stdexcept>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using fixtures::all_shapes;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

struct Surface {
    std::string name;
    std::vector<Facet> facets;
    std::vector<Vec3> positions;
};

/// The exterior and every named part of every generated body.
std::vector<Surface> all_surfaces() {
    std::vector<Surface> surfaces;
    for (const auto& shape : all_shapes()) {
        surfaces.push_back({shape.name, exterior_facets(shape.mesh), shape.mesh.nodes});
        for (const auto& [name, facets] : shape.mesh.surfaces)
            surfaces.push_back({shape.name + " " + name, facets, shape.mesh.nodes});
    }
    return surfaces;
}

TEST(EverySurface, KeepsTheIdentitiesOfHalfEdges) {
    for (const Surface& given : all_surfaces()) {
        SCOPED_TRACE(given.name);
        const HalfEdgeSurface surface(given.facets, given.positions);
        const auto& half_edges = surface.half_edges();
        for (Index h = 0; h < static_cast<Index>(half_edges.size()); ++h) {
            const HalfEdge& e = half_edges[h];
            Index around = h;
            for (int c = 0; c < surface.facets()[e.facet].count; ++c) {
                EXPECT_EQ(half_edges[around].facet, e.facet);
                if (c > 0) {
                    EXPECT_NE(around, h);
                }
                around = half_edges[around].next;
            }
            EXPECT_EQ(around, h) << "next cycles around the facet";
            if (e.twin < 0) continue;
            EXPECT_EQ(half_edges[e.twin].twin, h);
            EXPECT_NE(half_edges[e.twin].facet, e.facet);
            EXPECT_EQ(half_edges[e.twin].origin, half_edges[e.next].origin);
            EXPECT_EQ(half_edges[half_edges[e.twin].next].origin, e.origin);
            EXPECT_EQ(surface.is_feature_edge(h), surface.is_feature_edge(e.twin));
        }
    }
}

TEST(EverySurface, NumbersItsVerticesByAscendingNode) {
    for (const Surface& given : all_surfaces()) {
        SCOPED_TRACE(given.name);
        const HalfEdgeSurface surface(given.facets, given.positions);
        const auto& nodes = surface.vertex_nodes();
        EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
        for (Index f = 0; f < surface.facet_count(); ++f) {
            const auto vertices = surface.facet_vertices(f);
            ASSERT_EQ(vertices.size(), static_cast<std::size_t>(given.facets[f].count));
            for (std::size_t c = 0; c < vertices.size(); ++c) {
                EXPECT_EQ(nodes[vertices[c]], given.facets[f].nodes[c]);
                EXPECT_EQ(surface.vertex_of(given.facets[f].nodes[c]), vertices[c]);
                EXPECT_EQ(surface.half_edges()[surface.first_half_edge(f) + c].origin, vertices[c]);
            }
        }
        EXPECT_EQ(surface.vertex_of(static_cast<Index>(given.positions.size())), -1);
    }
}

/// Sphere 2, disc 1: every generated exterior is the one, every side of a body the other.
TEST(EverySurface, HasTheEulerCharacteristicOfItsBoundary) {
    for (const Surface& given : all_surfaces()) {
        SCOPED_TRACE(given.name);
        const HalfEdgeSurface surface(given.facets, given.positions);
        EXPECT_LE(surface.boundary_loop_count(), 1);
        EXPECT_EQ(surface.vertex_count() - surface.edge_count() + surface.facet_count(),
                  2 - surface.boundary_loop_count());
    }
}

TEST(EverySurface, OrdersFansCounterClockwise) {
    for (const Surface& given : all_surfaces()) {
        SCOPED_TRACE(given.name);
        const HalfEdgeSurface surface(given.facets, given.positions);
        for (Index v = 0; v < surface.vertex_count(); ++v) {
            std::set<Index> expected;
            for (Index f = 0; f < surface.facet_count(); ++f) {
                const auto corners = surface.facet_vertices(f);
                if (std::count(corners.begin(), corners.end(), v) > 0) expected.insert(f);
            }
            const auto fan = surface.vertex_facets(v);
            EXPECT_EQ(std::set<Index>(fan.begin(), fan.end()), expected);
            EXPECT_EQ(fan.size(), expected.size());
            // The edge that enters v in one facet is the edge that leaves it in the next.
            const auto corner = [&](Index f) {
                const auto corners = surface.facet_vertices(f);
                return std::pair(std::find(corners.begin(), corners.end(), v) - corners.begin(), std::ssize(corners));
            };
            const std::size_t links = fan.size() - (surface.is_boundary_vertex(v) ? 1 : 0);
            for (std::size_t i = 0; i < links; ++i) {
                const auto [c, count] = corner(fan[i]);
                EXPECT_EQ(surface.edge_neighbours(fan[i])[(c + count - 1) % count], fan[(i + 1) % fan.size()]);
            }
            if (surface.is_boundary_vertex(v)) {
                EXPECT_EQ(surface.edge_neighbours(fan.front())[corner(fan.front()).first], -1);
            }
        }
    }
}

/// Rings by definition: fixed point of "shares a vertex, and is connected around it by edges that are no features".
std::set<Index> ring_by_brute_force(const HalfEdgeSurface& surface, Index facet, int k) {
    const auto has = [&](Index f, Index v) {
        const auto corners = surface.facet_vertices(f);
        return std::find(corners.begin(), corners.end(), v) != corners.end();
    };
    std::set<Index> ring{facet};
    for (int level = 0; level < k; ++level) {
        std::set<Index> larger = ring;
        for (const Index f : ring)
            for (const Index v : surface.facet_vertices(f)) {
                std::set<Index> connected{f};
                for (std::size_t before = 0; before != connected.size();) {
                    before = connected.size();
                    for (const Index g : std::set<Index>(connected)) {
                        const auto neighbours = surface.edge_neighbours(g);
                        for (int c = 0; c < surface.facets()[g].count; ++c)
                            if (neighbours[c] >= 0 && has(neighbours[c], v) &&
                                !surface.is_feature_edge(surface.first_half_edge(g) + c)) {
                                const auto& e = surface.half_edges()[surface.first_half_edge(g) + c];
                                if (e.origin == v || surface.half_edges()[e.next].origin == v)
                                    connected.insert(neighbours[c]);
                            }
                    }
                }
                larger.insert(connected.begin(), connected.end());
            }
        ring = larger;
    }
    return ring;
}

TEST(EverySurface, HasTheRingsOfBruteForce) {
    for (const Surface& given : all_surfaces()) {
        SCOPED_TRACE(given.name);
        const HalfEdgeSurface surface(given.facets, given.positions);
        const Index stride = std::max<Index>(1, surface.facet_count() / 12);
        for (Index f = 0; f < surface.facet_count(); f += stride)
            for (int k = 0; k <= 3; ++k) {
                const std::set<Index> expected = ring_by_brute_force(surface, f, k);
                const auto ring = surface.ring_facets(f, k);
                EXPECT_EQ(ring, std::vector<Index>(expected.begin(), expected.end()));
                std::set<Index> corners;
                for (const Index g : expected)
                    corners.insert(surface.facet_vertices(g).begin(), surface.facet_vertices(g).end());
                EXPECT_EQ(surface.facet_ring(f, k), std::vector<Index>(corners.begin(), corners.end()));
            }
    }
}

int feature_edge_count(const HalfEdgeSurface& surface) {
    int sides = 0;
    for (std::size_t h = 0; h < surface.half_edges().size(); ++h) sides += surface.is_feature_edge(h);
    return sides / 2;
}

TEST(HalfEdgeSurface, FindsTheTwelveEdgesOfACube) {
    for (const auto& [name, type] : fixtures::element_types()) {
        const int sides = 12 * fixtures::facets_per_edge(type); // of the cube, in facets
        const Mesh one = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1}, type);
        EXPECT_EQ(feature_edge_count({exterior_facets(one), one.nodes}), sides) << name;
        const Mesh many = make_block({0, 0, 0}, {1, 1, 1}, {3, 3, 3}, type);
        EXPECT_EQ(feature_edge_count({exterior_facets(many), many.nodes}), 3 * sides) << name;
    }
}

TEST(HalfEdgeSurface, KeepsTheFineArcOfAHalfTubeSmoothAndItsCornersSharp) {
    const Mesh tube = make_half_tube(3, 1, 12, {13, 5, 3});
    // Two rims with two long edges each, two half rings with two arcs and two short sides each.
    EXPECT_EQ(feature_edge_count({exterior_facets(tube), tube.nodes}), 4 * 5 + 4 * 13 + 4 * 3);
    const HalfEdgeSurface inner(tube.surfaces.at("inner"), tube.nodes);
    EXPECT_EQ(feature_edge_count(inner), 0);
    EXPECT_EQ(inner.boundary_loop_count(), 1);
    const double facet_turn = std::numbers::pi / 13;
    const HalfEdgeSurface below(tube.surfaces.at("inner"), tube.nodes, 0.99 * facet_turn);
    const HalfEdgeSurface above(tube.surfaces.at("inner"), tube.nodes, 1.01 * facet_turn);
    EXPECT_EQ(feature_edge_count(below), 12 * 5);
    EXPECT_EQ(feature_edge_count(above), 0);
}

TEST(HalfEdgeSurface, RingsDoNotPassACorner) {
    const Mesh cube = make_block({0, 0, 0}, {1, 1, 1}, {3, 3, 3});
    const HalfEdgeSurface surface(exterior_facets(cube), cube.nodes);
    for (Index f = 0; f < surface.facet_count(); ++f) {
        const auto ring = surface.ring_facets(f, 3);
        EXPECT_EQ(ring.size(), 9u) << "the face it lies in";
        for (const Index g : ring)
            EXPECT_GT(facet_normal(surface.facets()[f], cube.nodes).dot(facet_normal(surface.facets()[g], cube.nodes)),
                      0.99);
    }
}

TEST(HalfEdgeSurface, RingsOfAPlaneGridAreSquares) {
    const Mesh block = make_block({0, 0, 0}, {1, 1, 1}, {9, 9, 1});
    const HalfEdgeSurface top(block.surfaces.at("z_max"), block.nodes);
    const Index centre = 9 * 4 + 4;
    EXPECT_THAT(top.facet_ring(centre, 0), ElementsAre(44, 45, 54, 55));
    EXPECT_EQ(top.facet_ring(centre, 1).size(), 16u);
    EXPECT_EQ(top.facet_ring(centre, 2).size(), 36u);
    EXPECT_EQ(top.facet_ring(centre, 3).size(), 64u);
    EXPECT_EQ(top.facet_ring(0, 1).size(), 9u) << "cut by the boundary";
    EXPECT_THAT(top.vertex_neighbours(0), ElementsAre(1, 9, 10));
    EXPECT_EQ(top.vertex_neighbours(centre).size(), 8u);
    EXPECT_THAT(top.edge_neighbours(0), UnorderedElementsAre(-1, -1, 1, 9));
    EXPECT_NEAR(top.facet_size(7), 1.0 / 9, 1e-15);
    EXPECT_NEAR(top.mean_facet_size(), 1.0 / 9, 1e-15);
}

TEST(HalfEdgeSurface, FindsBoundaryVerticesAndEdges) {
    const Mesh block = make_block({0, 0, 0}, {1, 1, 1}, {3, 3, 1});
    const HalfEdgeSurface top(block.surfaces.at("z_max"), block.nodes);
    int vertices = 0, edges = 0;
    for (Index v = 0; v < top.vertex_count(); ++v) {
        const Vec3& x = block.nodes[top.vertex_nodes()[v]];
        const bool rim = std::min(x.x(), x.y()) == 0 || std::max(x.x(), x.y()) == 1;
        EXPECT_EQ(top.is_boundary_vertex(v), rim);
        vertices += top.is_boundary_vertex(v);
    }
    for (std::size_t h = 0; h < top.half_edges().size(); ++h) edges += top.is_boundary_edge(h);
    EXPECT_EQ(vertices, 12);
    EXPECT_EQ(edges, 12);
}

TEST(HalfEdgeSurface, CountsTheLoopsOfAHoleAndOfSeparateParts) {
    const Mesh block = make_block({0, 0, 0}, {1, 1, 1}, {3, 3, 1});
    std::vector<Facet> ring = block.surfaces.at("z_max");
    ring.erase(ring.begin() + 4);
    EXPECT_EQ(HalfEdgeSurface(ring, block.nodes).boundary_loop_count(), 2);
    // Two facets that touch in one vertex only: two fans there, two loops.
    const HalfEdgeSurface touching({ring[0], block.surfaces.at("z_max")[4]}, block.nodes);
    EXPECT_EQ(touching.boundary_loop_count(), 2);
    const Index shared = touching.vertex_of(block.surfaces.at("z_max")[4].nodes[0]);
    EXPECT_THAT(touching.vertex_facets(shared), UnorderedElementsAre(0, 1));
    EXPECT_THAT(touching.ring_facets(0, 2), ElementsAre(0)) << "no edge leads across";
}

TEST(HalfEdgeSurface, MayBeEmpty) {
    const HalfEdgeSurface surface({}, {});
    EXPECT_EQ(surface.facet_count() + surface.vertex_count() + surface.edge_count(), 0);
    EXPECT_EQ(surface.boundary_loop_count(), 0);
    EXPECT_EQ(surface.mean_facet_size(), 0);
}

std::string error_of(const std::vector<Facet>& facets, const std::vector<Vec3>& positions) {
    try {
        const HalfEdgeSurface surface(facets, positions);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(HalfEdgeSurface, RefusesWhatIsNoOrientedSurfaceAndNamesTheNodes) {
    const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    const auto triangle = [](Index a, Index b, Index c) { return Facet{{a, b, c, -1}, 3, -1, -1}; };
    EXPECT_THAT(error_of({triangle(0, 1, 2), triangle(1, 0, 3)}, x), IsEmpty());
    EXPECT_THAT(error_of({triangle(0, 1, 2), triangle(1, 0, 3), triangle(0, 1, 4)}, x),
                AllOf(HasSubstr("more than two facets"), HasSubstr("nodes 0 and 1")));
    EXPECT_THAT(error_of({triangle(0, 1, 2), triangle(0, 1, 3)}, x),
                AllOf(HasSubstr("outside"), HasSubstr("nodes 0 and 1")));
    EXPECT_THAT(error_of({triangle(3, 1, 3)}, x), HasSubstr("node 3 twice"));
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
