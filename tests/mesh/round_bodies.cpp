/// Balls and cylinders: sound meshes, exact surfaces, shapes that elements can live with.

#include "mesh/shapes.hpp"
#include "osculate/mesh/quality.hpp"

#include <gmock/gmock.h>
#include <map>
#include <set>
#include <stdexcept>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using ::testing::IsEmpty;
constexpr double pi = std::numbers::pi;
constexpr double round_off = 1e-13; ///< relative, of a node's position

struct RoundBody {
    std::string name;
    Mesh mesh;
    bool ball;
    double share; ///< of the whole body
    double radius = 2, length = 5;
    int cuts = 0;
};

std::vector<RoundBody> round_bodies() {
    std::vector<RoundBody> bodies;
    int cuts = 0;
    for (const Portion portion : {Portion::full, Portion::half, Portion::quarter}) {
        const double share = 1 / std::pow(2, cuts);
        bodies.push_back({"ball", make_ball(2, {8, 4, 6}, portion), true, share});
        bodies.push_back({"graded ball", make_ball(2, {8, 4, 6}, portion, 1.3), true, share});
        bodies.push_back({"ball with a fine pole", make_ball(2, {16, 7, 6}, portion, 1.2, 7), true, share});
        bodies.push_back({"cylinder", make_cylinder(2, 5, {6, 3, 4}, portion), false, share});
        bodies.push_back({"graded cylinder", make_cylinder(2, 5, {6, 3, 4}, portion, 1.4), false, share});
        for (std::size_t i = bodies.size() - 5; i < bodies.size(); ++i) bodies[i].cuts = cuts;
        ++cuts;
    }
    return bodies;
}

TEST(RoundBodies, AreSoundAndClosed) {
    for (const RoundBody& body : round_bodies()) {
        SCOPED_TRACE(body.name + ", share " + std::to_string(body.share));
        EXPECT_THAT(faults(body.mesh), IsEmpty());
        const auto facets = exterior_facets(body.mesh);
        const auto sum = fixtures::integrate(facets, body.mesh.nodes);
        EXPECT_LT(sum.area_vector.norm(), 1e-12 * sum.area);
        std::set<Index> vertices;
        std::map<std::pair<Index, Index>, int> edges;
        for (const Facet& facet : facets)
            for (int c = 0; c < facet.count; ++c) {
                vertices.insert(facet.nodes[c]);
                ++edges[std::minmax(facet.nodes[c], facet.nodes[(c + 1) % facet.count])];
            }
        for (const auto& [edge, count] : edges) EXPECT_EQ(count, 2);
        EXPECT_EQ(vertices.size() - edges.size() + facets.size(), 2u);
    }
}

TEST(RoundBodies, HaveTheirOuterNodesOnTheTrueSurfaceAndTheirCutsInThePlanes) {
    for (const RoundBody& body : round_bodies()) {
        SCOPED_TRACE(body.name + ", share " + std::to_string(body.share));
        const auto& x = body.mesh.nodes;
        std::size_t named = 0;
        for (const auto& [name, facets] : body.mesh.surfaces) {
            named += facets.size();
            for (const Facet& facet : facets)
                for (const Index n : facet) {
                    if (name == "outer")
                        EXPECT_NEAR(body.ball ? x[n].norm() : x[n].head<2>().norm(), body.radius,
                                    round_off * body.radius);
                    else if (name == "x_min")
                        EXPECT_EQ(x[n].x(), 0);
                    else if (name == "y_min")
                        EXPECT_EQ(x[n].y(), 0);
                    else if (name == "z_min")
                        EXPECT_EQ(x[n].z(), 0);
                    else if (name == "z_max")
                        EXPECT_EQ(x[n].z(), body.length);
                    else
                        ADD_FAILURE() << "a surface called " << name;
                }
        }
        EXPECT_EQ(named, exterior_facets(body.mesh).size()) << "every exterior facet has one name";
        EXPECT_EQ(body.mesh.surfaces.size(), (body.ball ? 1u : 3u) + static_cast<std::size_t>(body.cuts));
        for (const Facet& facet : body.mesh.surfaces.at("outer")) {
            Vec3 out = facet_centroid(facet, x);
            if (!body.ball) out.z() = 0;
            EXPECT_GT(out.normalized().dot(facet_normal(facet, x)), 0.7);
        }
    }
}

/// A polyhedron with its corners on the sphere lacks a share of the volume that falls with the square of the facet size.
TEST(Ball, HasTheVolumeOfTheSphereUpToItsFacets) {
    const double exact = 4 * pi / 3 * 8;
    const auto lack = [&](int n) {
        const Mesh mesh = make_ball(2, {n, n / 2, n});
        return exact - fixtures::integrate(exterior_facets(mesh), mesh.nodes).volume;
    };
    const double coarse = lack(8), fine = lack(16);
    EXPECT_LT(coarse, 0.02 * exact);
    const double slack = 0.1; // of a factor measured between two meshes; the next term of the series is a sixtieth
    EXPECT_NEAR(coarse / fine, 4, slack);
}

TEST(Cylinder, HasTheVolumeOfItsPolygon) {
    for (const double grading : {1.0, 1.3}) {
        const Mesh mesh = make_cylinder(2, 5, {6, 3, 4}, Portion::full, grading);
        // a quarter is cut at equal angles: 24 isosceles triangles
        const double exact = 5 * 24 * 0.5 * 4 * std::sin(2 * pi / 24);
        EXPECT_NEAR(fixtures::integrate(exterior_facets(mesh), mesh.nodes).volume, exact, 1e-12 * exact);
    }
}

/// Largest cosine between two edges that meet at a corner of an element: 0 for bricks, 1 where it is flat.
double largest_corner_cosine(const Mesh& mesh) {
    constexpr int neighbours[8][3] = {{1, 3, 4}, {0, 2, 5}, {1, 3, 6}, {0, 2, 7},
                                      {5, 7, 0}, {4, 6, 1}, {5, 7, 2}, {4, 6, 3}};
    double largest = 0;
    const auto& nodes = mesh.blocks.at(0).connectivity;
    for (std::size_t e = 0; e < nodes.size(); e += 8)
        for (int c = 0; c < 8; ++c)
            for (int a = 0; a < 3; ++a) {
                const Vec3& x = mesh.nodes[nodes[e + c]];
                const Vec3 p = mesh.nodes[nodes[e + neighbours[c][a]]] - x;
                const Vec3 q = mesh.nodes[nodes[e + neighbours[c][(a + 1) % 3]]] - x;
                largest = std::max(largest, std::abs(p.normalized().dot(q.normalized())));
            }
    return largest;
}

TEST(RoundBodies, HaveElementsWithOpenAngles) {
    const double cosine = std::cos(pi / 6); // three elements meet at the cube's edges: 120 degrees are the best there
    EXPECT_LT(largest_corner_cosine(make_ball(1, {8, 4, 8})), cosine);
    EXPECT_LT(largest_corner_cosine(make_ball(1, {16, 8, 16})), cosine);
    EXPECT_LT(largest_corner_cosine(make_cylinder(1, 1, {8, 4, 8})), cosine);
    EXPECT_LT(largest_corner_cosine(make_cylinder(1, 1, {16, 8, 4})), cosine);
}

TEST(Ball, IsFinerAtItsPoleByTheFactorGivenWithoutLosingItsShapes) {
    const auto length = [](const Mesh& mesh, double z) { // of an edge that starts at the pole
        Index pole = 0;
        for (Index i = 0; i < mesh.node_count(); ++i)
            if (std::abs(mesh.nodes[i].z() - z) < 1e-9 && mesh.nodes[i].head<2>().norm() < 1e-9) pole = i;
        double shortest = 10;
        for (const Facet& facet : mesh.surfaces.at("outer"))
            for (int c = 0; c < 4; ++c)
                if (facet.nodes[c] == pole)
                    shortest = std::min(shortest, (mesh.nodes[facet.nodes[(c + 1) % 4]] - mesh.nodes[pole]).norm());
        return shortest;
    };
    const Mesh plain = make_ball(1, {32, 16, 32}), refined = make_ball(1, {32, 16, 32}, Portion::full, 1, 2);
    const double slack = 0.02; // an edge is long enough for the factor to change along it
    EXPECT_NEAR(length(plain, -1) / length(refined, -1), 2, 2 * slack);
    EXPECT_NEAR(length(refined, 1) / length(plain, 1), 2, 2 * slack);
    EXPECT_LT(largest_corner_cosine(refined), largest_corner_cosine(plain) + slack);
}

TEST(RoundBodies, RefuseImpossibleArguments) {
    EXPECT_THROW((void)make_ball(0, {8, 4, 8}), std::invalid_argument);
    EXPECT_THROW((void)make_ball(1, {7, 4, 8}), std::invalid_argument) << "odd";
    EXPECT_THROW((void)make_ball(1, {8, 0, 8}), std::invalid_argument);
    EXPECT_THROW((void)make_ball(1, {8, 4, 8}, Portion::full, 0.5), std::invalid_argument);
    EXPECT_THROW((void)make_ball(1, {8, 4, 8}, Portion::full, 1, 0.5), std::invalid_argument);
    EXPECT_THROW((void)make_ball(1, {10000, 10000, 10000}), std::invalid_argument);
    EXPECT_THROW((void)make_cylinder(1, -1, {8, 4, 8}), std::invalid_argument);
    EXPECT_THROW((void)make_cylinder(1, 1, {8, 4, 8}, Portion::full, 0), std::invalid_argument);
    EXPECT_THROW((void)make_cylinder(1, 1, {0, 4, 8}), std::invalid_argument);
}

TEST(Tube, ClosesUponItself) {
    const double inner = 2, thickness = 0.5, length = 3;
    for (const int around : {3, 4, 24}) {
        const Mesh tube = make_tube(inner, thickness, length, {around, 2, 2});
        EXPECT_THAT(faults(tube), IsEmpty());
        EXPECT_EQ(tube.node_count(), around * 3 * 3) << "no seam";
        EXPECT_EQ(tube.surfaces.size(), 4U);
        const auto facets = exterior_facets(tube);
        std::size_t named = 0;
        for (const auto& [name, surface] : tube.surfaces) named += surface.size();
        EXPECT_EQ(named, facets.size());
        const auto sum = fixtures::integrate(facets, tube.nodes);
        EXPECT_LT(sum.area_vector.norm(), 1e-12 * sum.area);
        const double section = around / 2. * std::sin(2 * pi / around); // of the polygon of radius 1
        const double outer = inner + thickness;
        EXPECT_NEAR(sum.volume, section * (outer * outer - inner * inner) * length, 1e-12 * sum.volume);
        for (const auto& [name, radius] : {std::pair{"inner", inner}, {"outer", outer}})
            for (const Facet& facet : tube.surfaces.at(name))
                for (int c = 0; c < 4; ++c)
                    EXPECT_NEAR(tube.nodes[facet.nodes[c]].head<2>().norm(), radius, round_off * radius);
    }
    EXPECT_THROW((void)make_tube(2, 1, 1, {2, 1, 1}), std::invalid_argument);
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
