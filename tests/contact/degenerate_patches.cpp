/// Smooth master surfaces over nodes that all but coincide, and over strongly graded facets.

#include "blend_surfaces.hpp"

#include <gtest/gtest.h>

namespace osculate::contact {
namespace {

using namespace testing;
using osculate::testing::Random;

/// Weights of patches come with machine epsilon times their condition of about 1e5.
constexpr double patch_round_off = 1e-10;

/// An exact surface and a mesh of quadrilaterals on it.
struct Round {
    const char* name;
    Shell shell;
    std::function<Vec3(const Vec3&)> onto;   ///< from nearby
    std::function<Vec3(const Vec3&)> normal; ///< at a point of it
    Index vertex;                            ///< one inside
    double size;                             ///< of facets, about
};

Shell half_tube_grid(int around, int along, double grading_around = 1, double grading_along = 1) {
    // edges grow from one end to the other by the grading
    const auto graded = [](double t, double grading) {
        return grading == 1 ? t : (std::pow(grading, t) - 1) / (grading - 1);
    };
    return grid(around, along, false, false, [=](double a, double b) {
        const double angle = pi * (1 + graded(a, grading_around));
        return Vec3(tube_radius * std::cos(angle), tube_length * graded(b, grading_along),
                    tube_radius * std::sin(angle));
    });
}

std::vector<Round> rounds() {
    const auto radial = [](const Vec3& p) -> Vec3 { return p.normalized(); };
    return {{"HalfTube", half_tube_grid(12, 13),
             [](const Vec3& p) -> Vec3 { return Vec3(0, p.y(), 0) + tube_radius * Vec3(p.x(), 0, p.z()).normalized(); },
             [](const Vec3& p) -> Vec3 { return -Vec3(p.x(), 0, p.z()).normalized(); }, 6 + 13 * 6, 0.85},
            {"Sphere",
             cube(8, false,
                  [](const Vec3& p) -> Vec3 {
                      return Vec3(std::tan(pi / 4 * p.x()), std::tan(pi / 4 * p.y()), std::tan(pi / 4 * p.z()))
                          .normalized();
                  }),
             radial, radial, 40, 0.18}};
}

/// Doubles a vertex: its copy at X takes over the facets on one side of it, two slivers close the slit.
void split(Shell& s, Index v, const Vec3& X) {
    const auto twin = static_cast<Index>(s.x.size());
    s.x.push_back(X);
    const auto corner = [](const std::vector<Index>& f, Index node) {
        return static_cast<std::size_t>(std::find(f.begin(), f.end(), node) - f.begin());
    };
    auto first = std::find_if(s.facets.begin(), s.facets.end(), [&](const auto& f) { return corner(f, v) < f.size(); });
    const std::size_t c = corner(*first, v), n = first->size();
    const Index ahead = (*first)[(c + 1) % n], left = (*first)[(c + n - 1) % n];
    (*first)[c] = twin;
    for (auto& f : s.facets) {
        const std::size_t d = corner(f, v), m = f.size();
        if (d == m || f[(d + m - 1) % m] != ahead) continue;
        const Index right = f[(d + 1) % m];
        f[d] = twin;
        s.facets.push_back({v, twin, left});
        s.facets.push_back({twin, v, right});
        return;
    }
}

/// Largest difference of gap and normal of two surfaces at random points near the facets of the first, all of which must
/// be found on both.
struct Difference {
    double gap = 0, normal = 0;
};
Difference compare(const Blend& one, const Blend& other, const Round& round, int points) {
    Random random(71);
    Difference worst;
    const auto& topology = one.surface.topology;
    for (int i = 0; i < points; ++i)
        for (Index f = i % 7; f < topology.facet_count(); f += 7) {
            const auto v = topology.facet_vertices(f);
            Vec3 p = Vec3::Zero();
            double sum = 0;
            for (const Index w : v) {
                const double share = random.uniform(0.05, 1);
                p += share * one.x[w];
                sum += share;
            }
            p = round.onto(p / sum);
            const Vec3 s = p + random.uniform(-0.02, 0.3) * round.size * round.normal(p);
            ContactVariation variation;
            const ContactPoint a = one.at(s, &variation), b = other.at(s);
            EXPECT_TRUE(a.found && b.found) << s.transpose();
            if (!a.found || !b.found) continue;
            EXPECT_TRUE(a.pressing.allFinite() && a.weights.allFinite() && variation.dn.allFinite() &&
                        variation.dpressing.allFinite());
            worst.gap = std::max(worst.gap, std::abs(a.gap - b.gap));
            worst.normal = std::max(worst.normal, (a.normal - b.normal).norm());
        }
    return worst;
}

constexpr int points = 7; ///< on a seventh of the facets each

TEST(NearDuplicateNodes, AreMergedWithTheLowest) {
    for (const Round& round : rounds())
        for (const double apart : {1e-3, 1e-6, 0.0})
            for (const bool outward : {false, true}) {
                const Vec3 X = round.shell.x[round.vertex], n = round.normal(X), off = apart * round.size * n;
                Shell doubled = round.shell;
                split(doubled, round.vertex,
                      outward ? Vec3(X + off) : round.onto(X + apart * round.size * n.unitOrthogonal()));
                const Blend clean(round.shell.surface("Clean")), blend(doubled.surface("Doubled"));
                EXPECT_EQ(blend.master->fallbacks(), 1) << round.name;
                for (const VertexPatchInfo& patch : vertex_patches(blend.surface.topology, blend.x, {}))
                    EXPECT_EQ(patch.level, 2) << round.name;
                const Difference worst = compare(blend, clean, round, points);
                EXPECT_LT(worst.gap, patch_round_off) << round.name << ": the other one takes no part";
                EXPECT_LT(worst.normal, patch_round_off) << round.name;
                EXPECT_LT(std::abs(blend.at(X).gap), patch_round_off) << round.name;
            }
}

TEST(NearDuplicateNodes, ChangeTheSurfaceByTheirDistance) {
    for (const Round& round : rounds())
        for (const double apart : {1e-3, 1e-5}) {
            // the copy keeps the place, the lower vertex moves off the surface
            const Vec3 X = round.shell.x[round.vertex];
            const double off = apart * round.size;
            Shell doubled = round.shell;
            split(doubled, round.vertex, X);
            doubled.x[round.vertex] += off * round.normal(X);
            const Blend clean(round.shell.surface("Clean")), blend(doubled.surface("Doubled"));
            const Difference worst = compare(blend, clean, round, points);
            EXPECT_LT(worst.gap, 1.2 * off) << round.name; // weights are little more than one
            EXPECT_GT(worst.gap, 0.1 * off) << round.name;
            EXPECT_NEAR(clean.at(blend.x[round.vertex]).gap, off, 0.01 * off) << round.name;
            EXPECT_LT(std::abs(blend.at(blend.x[round.vertex]).gap), patch_round_off) << round.name;
        }
}

/// An edge all but collapsed: its two quadrilaterals are triangles with a nearly straight corner.
TEST(NearDuplicateNodes, MayBeTheEndsOfAnEdge) {
    for (const Round& round : rounds()) {
        const auto around = std::find_if(round.shell.facets.begin(), round.shell.facets.end(), [&](const auto& f) {
            return std::find(f.begin(), f.end(), round.vertex) != f.end();
        });
        const auto at = std::find(around->begin(), around->end(), round.vertex);
        const Index v = *at, w = at + 1 == around->end() ? around->front() : *(at + 1);
        const Index low = std::min(v, w), high = std::max(v, w);
        Shell collapsed = round.shell, short_edge = round.shell;
        for (auto& f : collapsed.facets) {
            const auto old = std::find(f.begin(), f.end(), high);
            if (old == f.end()) continue;
            if (std::find(f.begin(), f.end(), low) != f.end())
                f.erase(old);
            else
                *old = low;
        }
        const double apart = 1e-3;
        short_edge.x[high] = round.onto(short_edge.x[low] + apart * (short_edge.x[high] - short_edge.x[low]));
        const Blend clean(collapsed.surface("Collapsed")), blend(short_edge.surface("ShortEdge"));
        EXPECT_EQ(clean.master->fallbacks(), 0);
        EXPECT_EQ(blend.master->fallbacks(), 1);
        const Difference worst = compare(blend, clean, round, points);
        EXPECT_LT(worst.gap, patch_round_off) << round.name;
        EXPECT_LT(worst.normal, patch_round_off) << round.name;
        EXPECT_LT(std::abs(blend.at(short_edge.x[high]).gap), apart * round.size) << round.name;
    }
}

/// The same for one patch per facet.
TEST(NearDuplicateNodes, AreMergedInRpimPatchesToo) {
    for (const Round& round : rounds()) {
        const Vec3 X = round.shell.x[round.vertex];
        Shell doubled = round.shell;
        split(doubled, round.vertex, X + 1e-3 * round.size * round.normal(X));
        const Surface clean = round.shell.surface("Clean"), surface = doubled.surface("Doubled");
        const auto clean_master = make_rpim_surface(clean.topology, clean.x, {});
        const auto master = make_rpim_surface(surface.topology, surface.x, {});
        EXPECT_EQ(master->fallbacks(), 1);
        const FacetSearch search(surface.topology), clean_search(clean.topology);
        for (Index f = 0; f < clean.topology.facet_count(); ++f) {
            const Vec3 s = mesh::facet_centroid(clean.topology.facets()[f], clean.x);
            ContactPoint point, before;
            ContactVariation variation;
            master->evaluate(s, search.closest_on(f, s, surface.x), surface.x, point, &variation);
            clean_master->evaluate(s, clean_search.closest_on(f, s, clean.x), clean.x, before);
            if (!before.found) continue; // the centroid of a hollow's facet may be below another one
            ASSERT_TRUE(point.found) << round.name << ", facet " << f;
            EXPECT_NEAR(point.gap, before.gap, patch_round_off);
            EXPECT_TRUE(variation.dn.allFinite());
            EXPECT_EQ(point.nodes, before.nodes);
        }
    }
}

/// Two edges of a slit lie on each other: nodes that share no facet stay apart.
TEST(NearDuplicateNodes, OfDifferentPartsStayApart) {
    Shell s = grid(6, 3, false, false, [](double a, double b) { return Vec3(6 * a, 3 * b, 0); });
    const Shell other = grid(6, 3, false, false, [](double a, double b) { return Vec3(6 * a, 3 + 3 * b, 0); });
    const auto offset = static_cast<Index>(s.x.size());
    s.x.insert(s.x.end(), other.x.begin(), other.x.end());
    for (auto facet : other.facets) {
        for (Index& node : facet) node += offset;
        s.facets.push_back(facet);
    }
    const Blend blend(s.surface("Slit"));
    EXPECT_EQ(blend.master->fallbacks(), 0);
    for (const VertexPatchInfo& patch : vertex_patches(blend.surface.topology, blend.x, {}))
        EXPECT_EQ(patch.vertices.front() < offset, patch.vertices.back() < offset);
}

} // namespace
} // namespace osculate::contact
