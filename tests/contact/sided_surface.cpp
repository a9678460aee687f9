/// Facets and patches of one facet each on surfaces with sharp edges: which side a point is over.

#include "osculate/contact/sided_surface.hpp"

#include "blend_surfaces.hpp"

#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

constexpr double patch_round_off = 1e-10;
constexpr int cuts = 6;
constexpr double size = 2.0 / cuts;

class Sided : public testing::TestWithParam<bool> {
protected:
    static std::unique_ptr<MasterSurface> each(const Surface& surface) {
        if (GetParam()) return make_rpim_surface(surface.topology, surface.x, {});
        return make_facets_surface(surface.topology);
    }
    const Surface box = cube(cuts, true, [](const Vec3& p) { return p; }).surface("Cube");
    const FacetSearch search{box.topology};
    const std::unique_ptr<MasterSurface> master = with_sides(box.topology, each(box));
    [[nodiscard]] std::vector<FacetHit> closest(const Vec3& s) const {
        double least = std::numeric_limits<double>::max();
        for (Index f = 0; f < box.topology.facet_count(); ++f)
            least = std::min(least, search.closest_on(f, s, box.x).distance);
        std::vector<FacetHit> hits;
        for (Index f = 0; f < box.topology.facet_count(); ++f)
            if (const FacetHit hit = search.closest_on(f, s, box.x); hit.distance <= least * (1 + 1e-12))
                hits.push_back(hit);
        return hits;
    }
};

TEST_P(Sided, IsTheFaceThatAPointBeyondAnEdgeOrACornerIsFartherFromWhicheverFacetIsNamed) {
    Random random(61);
    for (int i = 0; i < 300; ++i) {
        Vec3 off(random.uniform(0, 0.5), random.uniform(0, 0.5), random.uniform(0, 0.5));
        off *= size;
        Vec3 s = Vec3::Ones() + off;
        if (i % 2 == 0) s.z() = random.uniform(-1, 1), off.z() = 0;
        Index axis = 0;
        const double gap = off.maxCoeff(&axis);
        for (const FacetHit& hit : closest(s)) {
            ContactPoint point;
            ContactVariation variation;
            master->evaluate(s, hit, box.x, point, &variation);
            ASSERT_TRUE(point.found) << s.transpose();
            EXPECT_NEAR(point.gap, gap, patch_round_off) << s.transpose();
            EXPECT_LT((point.normal - Vec3::Unit(axis)).norm(), patch_round_off) << s.transpose();
            EXPECT_EQ(point.facet, hit.facet);
            EXPECT_NE(point.side, -1);
            ASSERT_EQ(variation.dg.cols(), 3 + 3 * static_cast<Index>(point.nodes.size()));
            EXPECT_LT((variation.dg.leftCols<3>().transpose() - point.normal).norm(), patch_round_off);
            const auto announced = master->patch_vertices(hit.facet);
            for (const Index node : point.nodes) EXPECT_TRUE(std::ranges::binary_search(announced, node));
        }
    }
}

TEST_P(Sided, HasNoContactInThePlaneOfTheOtherFaceHoweverFar) {
    for (const double far : {1.0, 10.0, 1000.0}) {
        const Vec3 s(1 + far * size, 0.1, 1); // in the plane of the top
        for (const FacetHit& hit : closest(s)) {
            ContactPoint point;
            master->evaluate(s, hit, box.x, point);
            if (point.found) {
                EXPECT_NEAR(point.gap, far * size, patch_round_off * far);
            }
        }
    }
}

TEST_P(Sided, KeepsTheSideToWhichAPointIsLatched) {
    const Vec3 s(1 + 0.2 * size, 0.1, 1 + 0.4 * size);
    for (FacetHit hit : closest(s)) {
        hit.latched = true;
        ContactPoint point;
        master->evaluate(s, hit, box.x, point);
        ASSERT_TRUE(point.found);
        const bool top = std::ranges::all_of(box.topology.facet_vertices(hit.facet),
                                             [&](Index v) { return box.x[static_cast<std::size_t>(v)].z() == 1; });
        EXPECT_NEAR(point.gap, (top ? 0.4 : 0.2) * size, patch_round_off);
    }
}

TEST_P(Sided, IsTheSurfaceItselfWithoutEdges) {
    const Surface tube = half_tube();
    auto plain = each(tube);
    const MasterSurface* const same = plain.get();
    EXPECT_EQ(with_sides(tube.topology, std::move(plain)).get(), same);
}

INSTANTIATE_TEST_SUITE_P(Of, Sided, testing::Bool(),
                         [](const auto& test) { return std::string(test.param ? "Rpim" : "Facets"); });

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
