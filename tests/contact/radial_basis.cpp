/// Which radial functions a patch gets where none are asked for.

#include "contact/surfaces.hpp"
#include "osculate/contact/master_surface.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using fixtures::Surface;

/// Gaps of a row of points inside a half-tube, over its smooth surface.
std::vector<double> gaps(const Surface& tube, bool blend, std::optional<Multiquadric> basis, int terms = 6) {
    BlendOptions of_blend;
    RpimOptions of_rpim;
    of_blend.basis = of_rpim.basis = basis;
    of_blend.polynomial_terms = of_rpim.polynomial_terms = terms;
    const auto surface =
        blend ? make_blend_surface(tube.topology, tube.x, of_blend) : make_rpim_surface(tube.topology, tube.x, of_rpim);
    FacetSearch search(tube.topology);
    search.build(tube.x);
    std::vector<double> result;
    for (double t = -0.9; t < 1; t += 0.1) {
        const Vec3 s(2.9 * std::sin(t), 6.1, -2.9 * std::cos(t));
        ContactPoint point;
        surface->evaluate(s, search.global(s, tube.x), tube.x, point);
        if (point.found) result.push_back(point.gap);
    }
    return result;
}

TEST(RadialBasis, IsR5WhereTheFacetsResolveTheSurfaceAndR3WhereTheyDoNot) {
    for (const bool blend : {false, true}) {
        const Surface fine = fixtures::half_tube(mesh::CellType::hex8, 12), // 15 degrees a facet
            coarse = fixtures::half_tube(mesh::CellType::hex8, 8);          // 22.5
        ASSERT_FALSE(gaps(fine, blend, r5).empty());
        EXPECT_EQ(gaps(fine, blend, std::nullopt), gaps(fine, blend, r5));
        EXPECT_EQ(gaps(coarse, blend, std::nullopt), gaps(coarse, blend, r3));
        EXPECT_NE(gaps(fine, blend, r3), gaps(fine, blend, r5));
    }
}

TEST(RadialBasis, IsR3WherePatchesReachOverABend) {
    // flat up to x = 3, then steep by 25 degrees; patches of vertices at 2.5 reach 3.5, those at 1.5 end at 2.5
    mesh::Mesh block = mesh::make_block({0, 0, -1}, {5, 4, 1}, {10, 8, 1});
    for (Vec3& x : block.nodes) x.z() -= std::max(0.0, x.x() - 3) * std::tan(25 * std::numbers::pi / 180);
    const Surface surface = fixtures::surface_of("Bent", block, "z_max");
    const auto gap = [&](double x, std::optional<Multiquadric> basis) {
        BlendOptions options;
        options.basis = basis;
        const auto blend = make_blend_surface(surface.topology, surface.x, options);
        FacetSearch search(surface.topology);
        search.build(surface.x);
        ContactPoint point;
        const Vec3 s(x, 2.1, 0.05);
        blend->evaluate(s, search.global(s, surface.x), surface.x, point);
        return point.gap;
    };
    EXPECT_NE(gap(2.6, r3), gap(2.6, r5));
    EXPECT_EQ(gap(2.6, std::nullopt), gap(2.6, r3));
    EXPECT_EQ(gap(0.8, std::nullopt), gap(0.8, r5));
}

TEST(RadialBasis, IsR3WithoutQuadraticPolynomials) {
    const Surface fine = fixtures::half_tube(mesh::CellType::hex8, 12);
    for (const bool blend : {false, true}) EXPECT_EQ(gaps(fine, blend, std::nullopt, 3), gaps(fine, blend, r3, 3));
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
