/// The vertex gap blend where surfaces are not smooth: creases, folds, boundaries, bad nodes, several sheets.

#include "../../src/contact/fold.hpp"
#include "blend_surfaces.hpp"

#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

/// Coordinates along a plane's normal are exact zeros in the patches: only the sums of the blend remain.
constexpr double exact_plane = 1e-14;
/// Weights of patches come with machine epsilon times their condition of about 1e5.
constexpr double patch_round_off = 1e-10;
constexpr double no_features = pi;

constexpr int cube_cuts = 6;
constexpr double cube_facet = 2.0 / cube_cuts;
Surface plain_cube() {
    return cube(cube_cuts, true, [](const Vec3& p) { return p; }).surface("Cube");
}

TEST(BlendOnCube, IsExactlyFlatUpToItsEdges) {
    const Blend blend(plain_cube());
    EXPECT_EQ(blend.master->fallbacks(), 0);
    Random random(51);
    for (int i = 0; i < 2000; ++i) {
        const int axis = i % 3;
        const double side = i % 2 == 0 ? 1 : -1, height = random.uniform(-0.3, 0.3) * cube_facet;
        const double reach = i % 5 == 0 ? 1 : 1 - std::max(0.0, -height); // inside, another face may be nearer
        Vec3 s = random.vector(reach);
        if (i % 5 == 0) s((axis + 1) % 3) = s((axis + 1) % 3) < 0 ? -1 : 1; // over an edge itself
        s(axis) = side * (1 + (i % 5 == 0 ? std::abs(height) : height));
        const ContactPoint point = blend.at(s);
        ASSERT_TRUE(point.found) << s.transpose();
        EXPECT_NEAR(point.gap, side * s(axis) - 1, exact_plane) << s.transpose();
        EXPECT_LT((point.normal - side * Vec3::Unit(axis)).norm(), exact_plane) << s.transpose();
        for (const Index node : point.nodes) EXPECT_EQ(blend.x[node](axis), side);
    }
}

TEST(BlendOnCube, TakesTheFartherFaceBeyondAnEdgeOrACorner) {
    const Blend blend(plain_cube());
    Random random(52);
    for (int i = 0; i < 1000; ++i) {
        Vec3 off(random.uniform(0, 0.5), random.uniform(0, 0.5), random.uniform(0, 0.5));
        off *= cube_facet;
        Vec3 s = Vec3::Ones() + off;
        if (i % 2 == 0) s.z() = random.uniform(-1, 1), off.z() = 0;
        Index axis = 0;
        const double gap = off.maxCoeff(&axis);
        const FacetHit hit = blend.search.global(s, blend.x);
        ContactVariation variation;
        const ContactPoint point = blend.at(s, hit, &variation);
        ASSERT_TRUE(point.found) << s.transpose();
        EXPECT_NEAR(point.gap, gap, exact_plane) << s.transpose();
        EXPECT_LT((point.normal - Vec3::Unit(axis)).norm(), exact_plane) << s.transpose();
        EXPECT_EQ(variation.dg.cols(), 3 + 3 * static_cast<Index>(point.nodes.size()));
        EXPECT_LT((variation.dg.leftCols<3>().transpose() - point.normal).norm(), patch_round_off);
        const auto announced = blend.master->patch_vertices(hit.facet);
        EXPECT_TRUE(std::includes(announced.begin(), announced.end(), point.nodes.begin(), point.nodes.end()));
        // whichever of the equally close facets the search names
        for (Index f = 0; f < blend.surface.topology.facet_count(); ++f) {
            const FacetHit other = blend.search.closest_on(f, s, blend.x);
            if (other.distance > hit.distance * (1 + 1e-12)) continue;
            const ContactPoint same = blend.at(s, other);
            ASSERT_TRUE(same.found);
            EXPECT_NEAR(same.gap, gap, exact_plane);
        }
    }
}

TEST(BlendOnCube, IsOutOfReachFarBeyondAnEdge) {
    const Blend blend(plain_cube());
    for (const double far : {2.0, 20.0}) EXPECT_FALSE(blend.at({1 + far, 0.1, 1 + far}).found);
}

TEST(BlendOnCube, IsNotFoundWhereAnIterateHasAllOfItInOnePlace) {
    Blend blend(plain_cube());
    const FacetHit hit = blend.search.global({1.1, 0.1, 0.2}, blend.x);
    std::ranges::fill(blend.x, Vec3(1e16, 0, 0)); // where its size is less than the last digit
    EXPECT_FALSE(blend.at({1e16 + 2, 0.1, 0.2}, hit).found);
}

/// Two planes that meet in a valley of 90 degrees, free space above both.
TEST(BlendInAValley, TakesTheNearerPlaneOutsideAndTheDeeperOneInside) {
    const Blend blend(grid(8, 6, false, false, [](double a, double b) {
                          return a < 0.5 ? Vec3(0, 3 * b, 4 - 8 * a) : Vec3(8 * a - 4, 3 * b, 0);
                      }).surface("Valley"));
    Random random(53);
    for (int i = 0; i < 500; ++i) {
        const double side = i % 2 == 0 ? 1 : -1;
        const double a = side * random.uniform(0.01, 0.4), b = side * random.uniform(0.01, 0.4);
        const ContactPoint point = blend.at({a, random.uniform(0.1, 2.9), b});
        ASSERT_TRUE(point.found);
        EXPECT_NEAR(point.gap, std::min(a, b), patch_round_off);
        EXPECT_LT((point.normal - Vec3::Unit(a < b ? 0 : 2)).norm(), patch_round_off);
    }
}

constexpr double can_radius = 2, can_length = 4;
constexpr int can_around = 24, can_along = 8;
/// A cylinder about z, from z = 0 to its length, with flat caps.
Surface can() {
    Shell s = grid(can_around, can_along, true, false, [](double a, double b) {
        return Vec3(can_radius * std::cos(2 * pi * a), can_radius * std::sin(2 * pi * a), can_length * b);
    });
    const int rings = 4;
    for (const bool top : {false, true}) {
        const auto rim = [&](int i) { return i % can_around + (top ? can_around * can_along : 0); };
        const auto first = static_cast<Index>(s.x.size());
        const auto at = [&](int ring, int i) {
            if (ring == rings) return rim(i);
            return ring == 0 ? first : first + 1 + (ring - 1) * can_around + i % can_around;
        };
        const double z = top ? can_length : 0;
        s.x.emplace_back(0, 0, z);
        for (int ring = 1; ring < rings; ++ring)
            for (int i = 0; i < can_around; ++i) {
                const double r = can_radius * ring / rings, angle = 2 * pi * i / can_around;
                s.x.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
            }
        for (int ring = 0; ring < rings; ++ring)
            for (int i = 0; i < can_around; ++i) {
                std::vector<Index> f{at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i + 1)};
                if (ring == 0) f.pop_back();
                if (!top) std::reverse(f.begin(), f.end());
                s.facets.push_back(f);
            }
    }
    return s.surface("Can");
}

TEST(BlendOnCan, IsSmoothAroundAndSharpAtItsRims) {
    const Blend blend(can());
    EXPECT_EQ(blend.surface.topology.boundary_loop_count(), 0);
    for (const VertexPatchInfo& patch : vertex_patches(blend.surface.topology, blend.surface.x, {})) {
        double low = can_length, high = 0, inner = can_radius;
        for (const Index v : patch.vertices) {
            low = std::min(low, blend.x[v].z());
            high = std::max(high, blend.x[v].z());
            inner = std::min(inner, blend.x[v].head<2>().norm());
        }
        EXPECT_TRUE(inner > 0.99 * can_radius || low == high) << "a patch runs around the rim";
    }
    Random random(54);
    double worst_gap = 0, worst_turn = 0, worst_cap = 0;
    for (int i = 0; i < 1000; ++i) {
        const double angle = random.uniform(0, 2 * pi), z = random.uniform(0, can_length), h = random.uniform(0, 0.15);
        const Vec3 outward(std::cos(angle), std::sin(angle), 0);
        const ContactPoint side = blend.at((can_radius + h) * outward + Vec3(0, 0, z));
        ASSERT_TRUE(side.found);
        worst_gap = std::max(worst_gap, std::abs(side.gap - h));
        worst_turn = std::max(worst_turn, (side.normal - outward).norm());
        // a cap's polygon ends inside the circle by 1 % of the radius
        const ContactPoint cap = blend.at(random.uniform(0, 0.99) * can_radius * outward + Vec3(0, 0, can_length + h));
        ASSERT_TRUE(cap.found);
        worst_cap = std::max(worst_cap, std::abs(cap.gap - h) + (cap.normal - Vec3::UnitZ()).norm());
    }
    // the facets' own sagitta is 0.017 and their normals are off by 0.13
    EXPECT_LT(worst_gap, 1e-3);
    EXPECT_LT(worst_turn, 1e-2);
    EXPECT_LT(worst_cap, patch_round_off);
}

/// A strip of quadrilaterals of unit length, each turned from the last by `turn`, the first from the x1x2 plane by `first`.
Shell strip(int count, double first, double turn) {
    Shell s;
    Vec3 p = Vec3::Zero();
    for (int i = 0; i <= count; ++i) {
        for (int j = 0; j <= 4; ++j) s.x.push_back(p + j * Vec3::UnitY());
        const double angle = first + i * turn;
        p += Vec3(std::cos(angle), 0, std::sin(angle));
    }
    for (Index i = 0; i < count; ++i)
        for (Index j = 0; j < 4; ++j) s.facets.push_back({5 * i + j, 5 * i + j + 5, 5 * i + j + 6, 5 * i + j + 1});
    return s;
}

struct Strip {
    const char* name;
    double first, turn; ///< degrees
    bool folds_in_x1x2, folds_in_its_plane;
};

/// Fig. 5: (a) to (c) are cured by the patch's own plane, (d) is not.                         [Qian 2014, sec 3.2]
TEST(Folds, CatchEveryOverlapOfFigure5) {
    const Strip strips[] = {{"a nearly flat", -20, 10, false, false},
                            {"b bent past the vertical", 0, 30, true, false},
                            {"c rotated upside down", 150, 15, true, false},
                            {"d more than a hairpin", -110, 55, true, true}};
    for (const Strip& k : strips) {
        const Surface surface = strip(5, k.first * pi / 180, k.turn * pi / 180).surface(k.name, no_features);
        std::vector<Index> all;
        for (Index f = 0; f < surface.topology.facet_count(); ++f) all.push_back(f);
        const auto middle = surface.topology.facet_vertices(9); // of the third row of facets
        const Vec3 normal =
            (surface.x[middle[2]] - surface.x[middle[0]]).cross(surface.x[middle[3]] - surface.x[middle[1]]);
        const ReferencePlane x1x2 = ReferencePlane::through(Vec3::Zero(), Vec3::UnitZ());
        const ReferencePlane own = ReferencePlane::through(surface.x[middle[0]], normal.normalized());
        EXPECT_EQ(folds(surface.topology, all, x1x2, surface.x), k.folds_in_x1x2) << k.name;
        EXPECT_EQ(folds(surface.topology, all, own, surface.x), k.folds_in_its_plane) << k.name;

        const Blend blend(surface);
        EXPECT_EQ(blend.master->fallbacks() > 0, k.folds_in_its_plane) << k.name;
        for (const Index f : all) {
            const Vec3 centre = mesh::facet_centroid(surface.topology.facets()[f], surface.x);
            const Vec3 out = mesh::facet_normal(surface.topology.facets()[f], surface.x);
            for (const double height : {-0.1, 0.05, 0.1}) {
                ContactVariation variation;
                const ContactPoint point = blend.at(centre + height * out, &variation);
                ASSERT_TRUE(point.found) << k.name << ", facet " << f << ", height " << height;
                EXPECT_LT(std::abs(point.gap - height), 0.3) << k.name; // a facet's sagitta
                EXPECT_GT(point.normal.dot(out), 0.7) << k.name;
                EXPECT_TRUE(variation.dn.allFinite()) << k.name;
            }
        }
    }
}

/// 170 degrees a facet: not even the facets around a vertex can be laid flat.
TEST(Folds, LeaveTheFacetWhereNothingElseIsPossible) {
    const Surface surface = strip(3, 0, 170 * pi / 180).surface("Hairpin", no_features);
    const Blend blend(surface);
    EXPECT_GT(blend.master->fallbacks(), 0);
    for (Index f = 0; f < 4; ++f) {
        const Vec3 centre = mesh::facet_centroid(surface.topology.facets()[f], surface.x);
        ContactVariation variation;
        const Vec3 s = centre + 0.01 * mesh::facet_normal(surface.topology.facets()[f], surface.x);
        ContactPoint point = blend.at(s, blend.search.closest_on(f, s, blend.x), &variation);
        ASSERT_TRUE(point.found);
        std::sort(point.nodes.begin(), point.nodes.end());
        EXPECT_NEAR(point.gap, 0.01, patch_round_off);
        EXPECT_EQ(variation.dg.cols(), 3 + 3 * static_cast<Index>(point.nodes.size()));
        const auto announced = blend.master->patch_vertices(f);
        EXPECT_TRUE(std::includes(announced.begin(), announced.end(), point.nodes.begin(), point.nodes.end()));
    }
}

/// A flat grid with one vertex doubled, and two slivers between the two.
TEST(BlendOverNearDuplicateNodes, RefusesTheirPatchesAndStaysFlat) {
    for (const double apart : {1e-3, 1e-6, 0.0}) {
        Shell s = grid(8, 8, false, false, [](double a, double b) { return Vec3(8 * a, 8 * b, 0); });
        const auto at = [](Index i, Index j) { return i + 9 * j; };
        const Index v = at(4, 4), twin = static_cast<Index>(s.x.size());
        s.x.emplace_back(4 + apart, 4, 0);
        for (auto& f : s.facets)
            for (Index& node : f)
                if (node == v && std::find(f.begin(), f.end(), at(5, 4)) != f.end()) node = twin;
        s.facets.push_back({v, twin, at(4, 5)});
        s.facets.push_back({twin, v, at(4, 3)});
        const Blend blend(s.surface("Doubled"));
        EXPECT_GT(blend.master->fallbacks(), 0);
        Random random(55);
        for (int i = 0; i < 500; ++i) {
            const Vec3 p(random.uniform(0.1, 7.9), random.uniform(0.1, 7.9), random.uniform(-0.3, 0.3));
            const ContactPoint point = blend.at(p);
            ASSERT_TRUE(point.found) << p.transpose() << " with nodes " << apart << " apart";
            EXPECT_NEAR(point.gap, p.z(), patch_round_off);
            EXPECT_LT((point.normal - Vec3::UnitZ()).norm(), patch_round_off);
        }
    }
}

TEST(BlendAtItsBoundary, IsNotFoundBeyond) {
    const Blend tube(half_tube()); // facets of size 0.85, from y = 0 to 12
    for (const double height : {-0.1, 0.0, 0.2}) {
        EXPECT_TRUE(tube.at({0.1, 0.0, -tube_radius + height}).found);
        EXPECT_FALSE(tube.at({0.1, -0.02, -tube_radius + height}).found);
        EXPECT_FALSE(tube.at({0.1, tube_length + 0.02, -tube_radius + height}).found);
        EXPECT_FALSE(tube.at({tube_radius - height, 5, 0.1}).found);
    }
    EXPECT_FALSE(tube.at({0, -50, 0}).found);
}

TEST(BlendOnAHollow, IsUniqueOrNotFoundNearTheCentreOfCurvature) {
    const Blend tube(half_tube());
    Random random(56);
    for (int i = 0; i < 200; ++i) {
        const double angle = pi * (1 + random.uniform(0.2, 0.8)), radius = random.uniform(0, 0.4) * tube_radius;
        const Vec3 s(radius * std::cos(angle), random.uniform(3, 9), radius * std::sin(angle));
        const ContactPoint point = tube.at(s);
        if (!point.found) {
            EXPECT_LT(radius, 0.25 * tube_radius);
            continue;
        }
        EXPECT_GT(radius, 0.15 * tube_radius);
        EXPECT_NEAR(point.gap, tube_radius - radius, 0.02 * tube_radius);
        EXPECT_TRUE(point.pressing.allFinite());
    }
    EXPECT_FALSE(tube.at({0, 6, 0}).found);
}

TEST(BlendBetweenTwoSheets, ChoosesTheSameOneEveryTime) {
    Shell s = grid(6, 6, false, false, [](double a, double b) { return Vec3(6 * a, 6 * b, 0); });
    const Shell upper = grid(6, 6, false, false, [](double a, double b) { return Vec3(6 - 6 * a, 6 * b, 0.5); });
    const auto offset = static_cast<Index>(s.x.size());
    s.x.insert(s.x.end(), upper.x.begin(), upper.x.end());
    for (auto facet : upper.facets) {
        for (Index& node : facet) node += offset;
        s.facets.push_back(facet);
    }
    const Blend blend(s.surface("Sheets"));
    FacetSearch below(blend.surface.topology, blend.x, {3, 3, -1});
    below.build(blend.x);
    Random random(57);
    for (int i = 0; i < 100; ++i) {
        const Vec3 p(random.uniform(0.1, 5.9), random.uniform(0.1, 5.9), 0.25);
        const ContactPoint first = blend.at(p, below.global(p, blend.x));
        const ContactPoint again = blend.at(p, below.global(p, blend.x));
        ASSERT_TRUE(first.found);
        EXPECT_LT(first.facet, 36) << "the sheet nearer to the point that decides ties";
        EXPECT_EQ(first.facet, again.facet);
        EXPECT_EQ(first.gap, again.gap);
        EXPECT_NEAR(first.gap, 0.25, patch_round_off);
        for (const Index node : first.nodes) EXPECT_LT(node, offset) << "nodes of one sheet only";
    }
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
