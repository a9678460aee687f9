#include "osculate/study/approximation.hpp"

#include "osculate/study/errors.hpp"
#include "osculate/study/study_meshes.hpp"

#include <array>
#include <gtest/gtest.h>

namespace osculate::study::OSCULATE_THIS_FILE {
namespace {

constexpr double irregularity = 0.1;

Vec2 corner(std::size_t corners, std::size_t c) {
    constexpr std::array<std::array<double, 2>, 4> square{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    constexpr std::array<std::array<double, 2>, 3> triangle{{{0, 0}, {1, 0}, {0, 1}}};
    return corners == 4 ? Vec2(square[c][0], square[c][1]) : Vec2(triangle[c][0], triangle[c][1]);
}

class Method : public ::testing::TestWithParam<std::string> {};

TEST_P(Method, PassesThroughTheNodes) {
    constexpr double round_off = 1e-10; // of the size; the interpolation's condition is 5e4
    const SurfaceMesh mesh = refined_mesh(Saddle{{0, 0, 0}, 0.3, 0.2}, 6, irregularity);
    const auto approximation = make_approximation(GetParam(), mesh);
    for (Index f = 0; f < mesh.topology.facet_count(); ++f) {
        const auto v = mesh.topology.facet_vertices(f);
        for (std::size_t c = 0; c < v.size(); ++c) {
            const auto p = approximation->at(f, corner(v.size(), c));
            ASSERT_TRUE(p);
            EXPECT_LT((p->point - mesh.x[v[c]]).norm(), round_off);
        }
    }
}

TEST_P(Method, KeepsAPlaneFlat) {
    constexpr double round_off = 1e-9; // curvature: second derivatives over the facet size squared
    const Saddle plane{{0, 0, 0}, 0, 0};
    const SurfaceMesh mesh = refined_mesh(plane, 6, irregularity);
    const Errors errors = measure_errors(mesh, *make_approximation(GetParam(), mesh), plane, 3, 1);
    EXPECT_EQ(errors.missing, 0);
    EXPECT_LT(errors.position.worst, round_off);
    EXPECT_LT(errors.normal.worst, round_off);
    EXPECT_LT(errors.curvature.worst, round_off);
}

INSTANTIATE_TEST_SUITE_P(All, Method, ::testing::ValuesIn(method_names()), [](const auto& test) { return test.param; });

TEST(Nagata, BendsAlongAnArc) {
    // strip of a cylinder with axis y, one facet wide: vertex normals lie in the arc's plane, those inside exactly
    constexpr double radius = 2, step = 0.1;
    std::vector<Vec2> plane;
    std::vector<mesh::Facet> facets;
    std::vector<Vec3> nodes;
    for (int i = 0; i < 5; ++i)
        for (const double y : {0.0, 0.2})
            nodes.emplace_back(radius * std::sin(i * step), y, radius * std::cos(i * step));
    for (Index i = 0; i < 4; ++i) {
        mesh::Facet facet;
        facet.nodes = {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1};
        facet.count = 4;
        facets.push_back(facet);
    }
    const SurfaceMesh mesh{mesh::HalfEdgeSurface(facets, nodes), nodes};
    const auto p = make_nagata(mesh)->at(1, Vec2::Zero()); // its four vertices are inside the strip
    ASSERT_TRUE(p);
    // a parabola through the arc's ends and tangents is off by radius (step/2)^4 / 8, 2e-6; the chord by 3e-3
    constexpr double parabola = 2e-6;
    EXPECT_NEAR(Vec2(p->point.x(), p->point.z()).norm(), radius, parabola);
    EXPECT_NEAR(p->mean_curvature, 1 / (2 * radius), 2e-3); // of a parabola at its middle, step^2/8 relative
}

TEST(MeasuredErrors, AreThoseOfAKnownOffset) {
    // the facets of a plane against a plane at another height
    const SurfaceMesh mesh = refined_mesh(Saddle{{0, 0, 0}, 0, 0}, 4, irregularity);
    const Errors errors = measure_errors(mesh, *make_facets(mesh), Saddle{{0, 0, 0.25}, 0, 0}, 4, 2);
    EXPECT_DOUBLE_EQ(errors.position.mean, 0.25);
    EXPECT_DOUBLE_EQ(errors.position.worst, 0.25);
    EXPECT_EQ(errors.points, 16 * mesh.topology.facet_count());
}

TEST(RefinedMesh, IsClosedHybridAndOutward) {
    for (const ExactSurface& exact : {ExactSurface(Sphere{}), ExactSurface(Torus{})}) {
        const SurfaceMesh mesh = refined_mesh(exact, 5, irregularity);
        EXPECT_EQ(mesh.topology.boundary_loop_count(), 0);
        int triangles = 0;
        for (const mesh::Facet& facet : mesh.topology.facets()) triangles += facet.count == 3;
        EXPECT_GT(triangles, 0);
        EXPECT_LT(triangles, mesh.topology.facet_count());
        constexpr double right_side = 1.2; // rad: coarse facets lean, but not by a quarter turn
        EXPECT_LT(measure_errors(mesh, *make_facets(mesh), exact, 2, 1).normal.worst, right_side);
    }
}

} // namespace
} // namespace osculate::study::OSCULATE_THIS_FILE
