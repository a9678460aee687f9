/// Smooth master surfaces over nodes that all but coincide, and over strongly graded facets.

#include "blend_surfaces.hpp"

#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

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

TEST(OneRowOfFacets, AroundACylinderIsRound) {
    for (const int around : {24, 80})
        for (const double length : {0.03, 0.3, 1.0, 3.0}) {
            const Surface surface = grid(around, 1, true, false, [&](double a, double b) {
                                        const double angle = 2 * pi * a;
                                        return Vec3(std::cos(angle), std::sin(angle), length * b);
                                    }).surface("Ring");
            const Blend blend(surface);
            const auto rpim = make_rpim_surface(surface.topology, surface.x, {});
            const double turn = 2 * pi / around, sagitta = turn * turn / 8;
            Random random(4);
            double gap = 0, normal = 0, rpim_gap = 0, rpim_normal = 0;
            for (int i = 0; i < 200; ++i) {
                const double angle = random.uniform(0, 2 * pi);
                const Vec3 outward(std::cos(angle), std::sin(angle), 0);
                const Vec3 s = outward + Vec3(0, 0, random.uniform(0, length));
                const FacetHit hit = blend.search.global(s, blend.x);
                const ContactPoint point = blend.at(s, hit);
                ContactPoint other;
                rpim->evaluate(s, hit, surface.x, other);
                ASSERT_TRUE(point.found && other.found);
                gap = std::max(gap, std::abs(point.gap));
                normal = std::max(normal, (point.normal - outward).norm());
                rpim_gap = std::max(rpim_gap, std::abs(other.gap));
                rpim_normal = std::max(rpim_normal, (other.normal - outward).norm());
            }
            // facets are a sagitta off, and half a turn
            EXPECT_LT(gap, 0.1 * sagitta) << around << " facets of length " << length;
            EXPECT_LT(normal, 0.1 * turn / 2) << around << " facets of length " << length;
            if (length > 5 * turn) continue; // rpim does not take the stretch of long facets out of its coordinates
            EXPECT_LT(rpim_gap, 0.1 * sagitta) << around << " facets of length " << length;
            EXPECT_LT(rpim_normal, 0.1 * turn / 2) << around << " facets of length " << length;
        }
}

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

/// A pair between long facets and short ones is closer than a hundredth of the mean distance on one side only: the patches of
/// that side cannot have both.
TEST(NearDuplicateNodes, AreMergedWhereOneSideAloneCannotTellThemApart) {
    const std::vector<double> x{-40, -30, -20, -10, 0, 0.03, 1.03, 2.03, 3.03, 4.03};
    const int columns = static_cast<int>(x.size()) - 1, rows = 4;
    const Surface surface = grid(columns, rows, false, false, [&](double a, double b) {
                                return Vec3(x[static_cast<std::size_t>(std::lround(a * columns))], 10 * rows * b, 0);
                            }).surface("Graded");
    int beside = 0;
    for (const VertexPatchInfo& patch : vertex_patches(surface.topology, surface.x, {})) {
        bool one = false, other = false;
        for (const Index v : patch.vertices) {
            one = one || surface.x[v].x() == 0;
            other = other || surface.x[v].x() == 0.03;
        }
        EXPECT_FALSE(one && other) << "at " << surface.x[patch.vertex].transpose();
        EXPECT_GE(patch.level, 2);
        beside += one || other;
    }
    EXPECT_GT(beside, rows) << "nothing shown";
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
        for (Index k = 1; k <= 2; ++k) { // deep below the slivers, too: their own size says nothing
            const Index f = surface.topology.facet_count() - k;
            const Vec3 on = mesh::facet_centroid(surface.topology.facets()[f], surface.x);
            const Vec3 s = on - 0.2 * round.size * round.normal(on);
            ContactPoint point;
            master->evaluate(s, search.closest_on(f, s, surface.x), surface.x, point);
            ASSERT_TRUE(point.found) << round.name;
            EXPECT_NEAR(point.gap, -0.2 * round.size, 0.05 * round.size);
        }
    }
}

/// Two edges of a slit lie on each other: nodes that share no facet stay apart.
/// Long facets beside short ones that curl away: two rings are the most that lie flat, and no patch of them both covers its own
/// long facets and ends before the next node on the other side. It ends there all the same.
TEST(FacetsOfVeryUnlikeLength, KeepTheSurfaceThroughTheNodesOfTheShortOnes) {
    constexpr int curled = 4, plain = 3, rows = 6;
    const Shell shell = grid(curled + plain, rows, false, false, [](double a, double b) {
        const auto i = static_cast<int>(std::lround(a * (curled + plain))) - curled;
        Vec3 p(i > 0 ? 16.0 * i : 0, 5 * rows * b, 0);
        for (int k = 1; k <= -i; ++k) p -= Vec3(std::cos(k * 2 * pi / 9), 0, std::sin(k * 2 * pi / 9));
        return p;
    });
    const Blend blend(shell.surface("Unlike", pi));
    for (const Vec3& x : blend.x) {
        if (x.x() > 0) continue;
        const ContactPoint point = blend.at(x);
        ASSERT_TRUE(point.found) << x.transpose();
        EXPECT_LT(std::abs(point.gap), patch_round_off) << x.transpose();
    }
}

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

/// A sphere of unit radius between 60 degrees south and north; edges grow from south to north by the grading.
Shell sphere_band(int around, int across, double south, double north, double grading) {
    return grid(around, across, true, false, [=](double a, double b) {
        const double t = grading == 1 ? b : (std::pow(grading, b) - 1) / (grading - 1);
        const double angle = 2 * pi * a, up = south + (north - south) * t;
        return Vec3(std::cos(angle) * std::cos(up), std::sin(angle) * std::cos(up), std::sin(up));
    });
}

/// A mesh with edges or sizes in the ratio 1:20, and the one that is nowhere finer than its coarsest part.
struct Graded {
    const char* name;
    Shell mesh, coarse;
    bool sphere;    ///< or half-tube
    double normals; ///< largest ratio of their mean errors of the normal, somewhat more than measured
};
void PrintTo(const Graded& graded, std::ostream* out) {
    *out << graded.name;
}

std::vector<Graded> graded_meshes() {
    const double north = pi / 3, south = -north;
    const Shell tube = half_tube_grid(12, 13), band = sphere_band(24, 8, south, north, 1);
    return {{"TubeOfThinRings", half_tube_grid(12, 13 * 20), tube, false, 3},
            {"TubeOfNarrowStrips", half_tube_grid(12 * 20, 13), tube, false, 0.001},
            {"TubeGradedAlong", half_tube_grid(12, 42, 1, 20), tube, false, 2},
            {"TubeGradedAround", half_tube_grid(38, 13, 20, 1), tube, false, 0.3},
            {"TubeGradedBothWays", half_tube_grid(38, 42, 20, 20), tube, false, 0.3},
            {"SphereOfThinRings", sphere_band(24, 8 * 20, south, north, 1), band, true, 1},
            {"SphereOfNarrowStrips", sphere_band(24 * 20, 8, south, north, 1), band, true, 2},
            {"SphereGraded", sphere_band(24, 24, south, north, 20), band, true, 1.1}};
}

class GradedFacets : public ::testing::TestWithParam<Graded> {
protected:
    Blend blend{GetParam().mesh.surface("Graded")};
    Random random{72};

    [[nodiscard]] Vec3 normal(const Vec3& p) const {
        return GetParam().sphere ? Vec3(p.normalized()) : Vec3(-Vec3(p.x(), 0, p.z()).normalized());
    }
    /// A point of a facet, natural coordinates in (0, 1).
    static Vec3 on_facet(const Blend& blend, Index f, double a, double b) {
        const auto v = blend.surface.topology.facet_vertices(f);
        const auto& x = blend.x;
        return (1 - a) * (1 - b) * x[v[0]] + a * (1 - b) * x[v[1]] + a * b * x[v[2]] + (1 - a) * b * x[v[3]];
    }
    /// Longest edge, m.
    static double longest(const Blend& blend) {
        double edge = 0;
        for (Index f = 0; f < blend.surface.topology.facet_count(); ++f) {
            const auto v = blend.surface.topology.facet_vertices(f);
            for (std::size_t c = 0; c < 4; ++c) edge = std::max(edge, (blend.x[v[c]] - blend.x[v[(c + 1) % 4]]).norm());
        }
        return edge;
    }
    /// Facets whose patches reach no boundary: what is one-sided there is so in every mesh. At most so many, evenly.
    static std::vector<Index> inner_facets(const Blend& blend, std::size_t most) {
        const auto& topology = blend.surface.topology;
        std::vector<Index> all, some;
        for (Index f = 0; f < topology.facet_count(); ++f) {
            const auto near = topology.facet_ring(f, 2);
            if (std::none_of(near.begin(), near.end(), [&](Index v) { return topology.is_boundary_vertex(v); }))
                all.push_back(f);
        }
        const std::size_t stride = 1 + all.size() / most;
        for (std::size_t k = 0; k < all.size(); k += stride) some.push_back(all[k]);
        return some;
    }
    /// Mean over the area.
    double normal_error(const Blend& on) {
        double sum = 0, area = 0;
        for (const Index f : inner_facets(on, 400))
            for (int i = 0; i < 4; ++i) {
                const Vec3 p = on_facet(on, f, random.uniform(0, 1), random.uniform(0, 1)), n = normal(p);
                const ContactPoint point = on.at(p);
                EXPECT_TRUE(point.found);
                const double share = std::pow(on.surface.topology.facet_size(f), 2);
                area += share;
                sum += share * std::atan2(point.normal.cross(n).norm(), point.normal.dot(n));
            }
        return sum / area;
    }
};

TEST_P(GradedFacets, NeedNoFallback) {
    EXPECT_EQ(blend.master->fallbacks(), 0);
    for (const VertexPatchInfo& patch : vertex_patches(blend.surface.topology, blend.x, {})) EXPECT_EQ(patch.level, 2);
}

TEST_P(GradedFacets, HoldEveryVertex) {
    // patches are as long as the longest edges, and so is their round-off
    const double tolerance = 1e-11 * longest(blend);
    for (Index v = 0; v < blend.surface.topology.vertex_count(); ++v) {
        const ContactPoint point = blend.at(blend.x[v]);
        ASSERT_TRUE(point.found) << "vertex " << v;
        EXPECT_LT(std::abs(point.gap), tolerance) << "vertex " << v;
    }
}

TEST_P(GradedFacets, AreCoveredAndDoNotJump) {
    const auto& topology = blend.surface.topology;
    int lost = 0;
    double jump = 0;
    const auto inner = inner_facets(blend, 500);
    ASSERT_FALSE(inner.empty());
    for (const Index f : inner) {
        const auto v = topology.facet_vertices(f);
        const double height = random.uniform(-0.3, 0.3) * topology.facet_size(f);
        const Vec3 p = on_facet(blend, f, random.uniform(0, 1), random.uniform(0, 1));
        lost += blend.at(p + height * normal(p)).found ? 0 : 1;
        for (int c = 0; c < 4; ++c) { // above an edge, seen from both facets
            const double t = random.uniform(0, 1);
            const Vec3 edge = (1 - t) * blend.x[v[c]] + t * blend.x[v[(c + 1) % 4]], s = edge + height * normal(edge);
            const ContactPoint here = blend.at(s, blend.search.closest_on(f, s, blend.x));
            const Index across = topology.edge_neighbours(f)[c];
            const ContactPoint there = blend.at(s, blend.search.closest_on(across, s, blend.x));
            lost += here.found && there.found ? 0 : 1;
            if (!here.found || !there.found) continue;
            jump = std::max({jump, std::abs(here.gap - there.gap), (here.normal - there.normal).norm()});
        }
    }
    EXPECT_EQ(lost, 0);
    EXPECT_EQ(jump, 0) << "the same patches on either side";
}

/// Fine edges across a curve of coarse ones do not make up for the coarse ones: patches as wide as one edge see less of the
/// surface than square ones, and their normals are up to 2.7 times worse. Where facets are finer along the curve, or
/// smaller altogether, normals are better.
TEST_P(GradedFacets, HaveAboutTheNormalsOfTheirCoarsestPart) {
    const Blend coarse(GetParam().coarse.surface("Coarse"));
    ASSERT_FALSE(inner_facets(blend, 400).empty());
    ASSERT_FALSE(inner_facets(coarse, 400).empty());
    const double error = normal_error(blend);
    EXPECT_LT(error, GetParam().normals * normal_error(coarse));
    EXPECT_LT(error, 1e-3); // rad: what is asked of the regular half-tube
}

INSTANTIATE_TEST_SUITE_P(Of, GradedFacets, ::testing::ValuesIn(graded_meshes()),
                         [](const auto& tested) { return tested.param.name; });

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
