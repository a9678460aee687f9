/// A half, a quarter and an eighth of a sphere with their symmetry planes, against the whole sphere.

#include "blend_surfaces.hpp"
#include "osculate/contact/mirror.hpp"

#include <gtest/gtest.h>
#include <string>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

/// Of the radius, which is 1. Mirrored patches hold the same nodes in another order, so their factorisations differ by
/// machine epsilon times their condition of about 1e5; everything else is exact, as the whole mesh is mirror-symmetric to
/// the last digit.
constexpr double patch_round_off = 1e-10;

enum class Mesh { quadrilaterals, triangles, hybrid };

constexpr int divisions = 16; ///< a face of the cube; even, and exact in binary

/// Unit sphere from a cube, mirror-symmetric about the coordinate planes, on which edges lie: cuts and their diagonals are
/// those of one quarter of each face.
Shell symmetric_sphere(Mesh mesh) {
    const Shell whole = cube(divisions, false, [](const Vec3& p) { return p; });
    Shell sphere;
    for (const Vec3& p : whole.x)
        sphere.x.push_back(
            Vec3(std::tan(pi / 4 * p.x()), std::tan(pi / 4 * p.y()), std::tan(pi / 4 * p.z())).normalized());
    for (const auto& f : whole.facets) {
        Vec3 centre = Vec3::Zero();
        for (const Index v : f) centre += whole.x[v] / 4;
        // place in the first octant: the same for all mirror images
        const Vec3 place = divisions / 2 * centre.cwiseAbs();
        const int code =
            static_cast<int>(place.x()) + 3 * static_cast<int>(place.y()) + 7 * static_cast<int>(place.z());
        if (mesh == Mesh::quadrilaterals || (mesh == Mesh::hybrid && code * code % 11 < 5)) {
            sphere.facets.push_back(f);
            continue;
        }
        // of the two diagonals, the one whose ends are more (or less) alike in their distance from the edges of the face
        const auto spread = [&](std::size_t c) {
            return std::abs(whole.x[f[c]].cwiseAbs().sum() - whole.x[f[c + 2]].cwiseAbs().sum());
        };
        const bool first = (spread(0) < spread(1)) == (code % 3 != 0);
        if (first) {
            sphere.facets.push_back({f[0], f[1], f[2]});
            sphere.facets.push_back({f[0], f[2], f[3]});
        } else {
            sphere.facets.push_back({f[0], f[1], f[3]});
            sphere.facets.push_back({f[1], f[2], f[3]});
        }
    }
    return sphere;
}

/// Displacement without any regularity but the mirror symmetry; nodes on a plane stay there.
Vec3 shaken(const Vec3& X, double amount, double phase) {
    const Vec3 folded = X.cwiseAbs();
    Vec3 x = X;
    for (int k = 0; k < 3; ++k) {
        const double sign = X(k) > 0 ? 1 : X(k) < 0 ? -1 : 0;
        x(k) += sign * amount * std::sin(phase + folded.dot(Vec3(97 + 10 * k, 61 - 7 * k, 83 + 3 * k)));
    }
    return x;
}

/// The part of a shell where the first `planes` coordinates are positive, mirrored at those coordinate planes as a contact
/// pair mirrors it. Node numbers stay those of the whole.
struct Part {
    Part(const Shell& whole, int planes) {
        std::vector<mesh::Facet> facets;
        double area = 0;
        for (const auto& corners : whole.facets) {
            Vec3 centre = Vec3::Zero();
            for (const Index v : corners) centre += whole.x[v];
            if (centre.head(planes).minCoeff() < 0) continue;
            mesh::Facet facet;
            facet.count = static_cast<int>(corners.size());
            std::copy(corners.begin(), corners.end(), facet.nodes.begin());
            facets.push_back(facet);
            const Vec3 a = whole.x[corners[1]] - whole.x[corners[0]], b = whole.x[corners.back()] - whole.x[corners[0]];
            area = std::max(area, a.cross(b).norm());
        }
        std::vector<SymmetryPlane> list;
        for (int k = 0; k < planes; ++k) list.push_back({Vec3::Zero(), Vec3::Unit(k)});
        mirrored = mirror(facets, whole.x, list, 6 * std::sqrt(area));
    }
    [[nodiscard]] Surface surface() const {
        mesh::HalfEdgeSurface topology(mirrored.facets, mirrored.positions);
        std::vector<Vec3> x;
        for (const Index node : topology.vertex_nodes()) x.push_back(mirrored.positions[node]);
        return {"Part", std::move(topology), std::move(x)};
    }
    /// Current positions of nodes and ghosts from those of the nodes.
    [[nodiscard]] std::vector<Vec3> positions(const std::vector<Vec3>& of_nodes) const {
        std::vector<Vec3> x;
        for (std::size_t i = 0; i < mirrored.original.size(); ++i)
            x.push_back(mirrored.images[mirrored.image[i]](of_nodes[mirrored.original[i]]));
        return x;
    }

    MirroredSurface mirrored;
};

struct Case {
    const char* name;
    Mesh mesh;
    int planes;
    bool irregular; ///< the reference mesh is shaken too
};
void PrintTo(const Case& tested, std::ostream* out) {
    *out << tested.name;
}

class MirroredPart : public ::testing::TestWithParam<Case> {
protected:
    static constexpr double size = pi / 2 / divisions; ///< of a facet

    /// Rougher surfaces (0.1) bring slave points close to a centre of curvature, where the normal turns by ten radians a
    /// facet and round-off grows as much.
    static constexpr double roughness = 0.03 * size;

    const int planes = GetParam().planes;
    const Shell shell = [] {
        Shell s = symmetric_sphere(GetParam().mesh);
        if (GetParam().irregular)
            for (Vec3& X : s.x) X = shaken(X, 0.1 * size, 0.4);
        return s;
    }();
    const Part part{shell, planes};
    Blend whole{shell.surface("Whole")}, cut{part.surface()};
    Random random{51};

    void deform() {
        std::vector<Vec3> x = shell.x;
        for (Vec3& p : x) p = shaken(p, roughness, 1.3);
        for (std::size_t v = 0; v < whole.x.size(); ++v) whole.x[v] = x[whole.surface.topology.vertex_nodes()[v]];
        const std::vector<Vec3> with_ghosts = part.positions(x);
        for (std::size_t v = 0; v < cut.x.size(); ++v) cut.x[v] = with_ghosts[cut.surface.topology.vertex_nodes()[v]];
        whole.search.build(whole.x);
        cut.search.build(cut.x);
    }

    /// Within 0.3 facet sizes of the sphere, in the part kept: anywhere, close to its planes, on them, and where round-off
    /// has carried it past them.
    Vec3 slave() {
        for (;;) {
            Vec3 s = random.direction();
            for (int k = 0; k < planes; ++k) {
                const double how = random.uniform(0, 1);
                s(k) = std::abs(s(k)) * (how < 0.3 ? 1 : how < 0.6 ? size : how < 0.7 ? 1e-8 : how < 0.8 ? -1e-13 : 0);
            }
            if (s.norm() > 0.01) return (1 + 0.3 * size * random.uniform()) * s.normalized();
        }
    }

    /// Largest differences over many slave points. What a node of the part bears is its share and its images' shares.
    struct Difference {
        double gap = 0, normal = 0, weights = 0, pressing = 0, gradient = 0;
    };
    Difference compare() {
        // the node of the whole at the place of each vertex of the part
        std::vector<Index> at(cut.x.size());
        for (std::size_t v = 0; v < at.size(); ++v) {
            double nearest = 1;
            for (std::size_t w = 0; w < whole.x.size(); ++w) {
                const double distance = (whole.surface.x[w] - cut.surface.x[v]).norm();
                if (distance < nearest) nearest = distance, at[v] = static_cast<Index>(w);
            }
            EXPECT_LT(nearest, patch_round_off) << "no node of the whole sphere at " << cut.surface.x[v].transpose();
        }
        Difference worst;
        for (int i = 0; i < (full() ? 5000 : 500); ++i) {
            const Vec3 s = slave();
            ContactVariation da, db;
            const ContactPoint a = whole.at(s, &da), b = cut.at(s, &db);
            EXPECT_TRUE(a.found && b.found) << s.transpose();
            if (!a.found || !b.found) continue;
            worst.gap = std::max(worst.gap, std::abs(a.gap - b.gap));
            worst.normal = std::max(worst.normal, (a.normal - b.normal).norm());
            worst.gradient =
                std::max(worst.gradient, size * (da.dn.leftCols<3>() - db.dn.leftCols<3>()).norm()); // curvature
            std::map<Index, std::pair<double, Vec3>> shares;                                         // whole minus part
            for (std::size_t k = 0; k < a.nodes.size(); ++k) {
                const auto row = static_cast<Index>(k);
                shares[a.nodes[k]] = {a.weights(row), a.pressing.row(row).transpose()};
            }
            for (std::size_t k = 0; k < b.nodes.size(); ++k) {
                const auto row = static_cast<Index>(k);
                auto& [weight, pressing] = shares.try_emplace(at[b.nodes[k]], 0, Vec3::Zero()).first->second;
                weight -= b.weights(row);
                pressing -= b.pressing.row(row).transpose();
            }
            for (const auto& [node, share] : shares) {
                worst.weights = std::max(worst.weights, std::abs(share.first));
                worst.pressing = std::max(worst.pressing, share.second.norm());
            }
        }
        return worst;
    }
    static void expect_none(const Difference& worst) {
        record("gap", worst.gap);
        record("normal", worst.normal);
        record("weights", worst.weights);
        record("pressing", worst.pressing);
        record("gradient", worst.gradient);
        EXPECT_LT(worst.gap, patch_round_off);
        EXPECT_LT(worst.normal, patch_round_off);
        EXPECT_LT(worst.weights, patch_round_off);
        EXPECT_LT(worst.pressing, patch_round_off);
        EXPECT_LT(worst.gradient, 10 * patch_round_off); // second derivatives of the weights, per facet size
    }
};

TEST_P(MirroredPart, HasTheGapAndNormalOfTheWhole) {
    ASSERT_LT(cut.x.size(), whole.x.size()) << "ghosts everywhere would show nothing";
    expect_none(compare());
}

TEST_P(MirroredPart, HasTheGapAndNormalOfTheWholeWhenDeformed) {
    deform();
    expect_none(compare());
}

/// On a plane the normal lies in it: nothing pushes across.
TEST_P(MirroredPart, HasItsNormalInThePlaneOnThePlane) {
    deform();
    for (int i = 0; i < 200; ++i) {
        Vec3 s = random.direction();
        s.head(planes) = s.head(planes).cwiseAbs();
        s(0) = 0;
        const ContactPoint point = cut.at(s.normalized());
        ASSERT_TRUE(point.found);
        EXPECT_LT(std::abs(point.normal.x()), patch_round_off);
    }
}

/// What the planes are for: without them the patches at the cut are one-sided.
TEST_P(MirroredPart, IsNotTheWholeWithoutItsPlanes) {
    Shell half = shell;
    std::erase_if(half.facets, [&](const auto& corners) {
        return std::any_of(corners.begin(), corners.end(), [&](Index v) { return shell.x[v].x() < 0; });
    });
    const Blend bare(half.surface("Bare"));
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        Vec3 s = random.direction();
        s.x() = 0.5 * size * random.uniform(0, 1);
        s.normalize();
        const ContactPoint a = whole.at(s), b = bare.at(s);
        if (a.found && b.found) worst = std::max(worst, (a.normal - b.normal).norm());
    }
    EXPECT_GT(worst, 1e4 * patch_round_off);
}

constexpr Case cases[] = {{"HalfOfQuadrilaterals", Mesh::quadrilaterals, 1, false},
                          {"HalfOfTriangles", Mesh::triangles, 1, false},
                          {"HalfOfHybrid", Mesh::hybrid, 1, false},
                          {"QuarterOfQuadrilaterals", Mesh::quadrilaterals, 2, false},
                          {"QuarterOfTriangles", Mesh::triangles, 2, false},
                          {"QuarterOfHybrid", Mesh::hybrid, 2, false},
                          {"QuarterOfIrregularHybrid", Mesh::hybrid, 2, true},
                          {"EighthOfIrregularHybrid", Mesh::hybrid, 3, true}};

INSTANTIATE_TEST_SUITE_P(Of, MirroredPart, ::testing::ValuesIn(cases),
                         [](const auto& tested) { return std::string(tested.param.name); });

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
