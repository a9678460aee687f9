/// Pairs whose master ends at symmetry planes 60 degrees apart: products of the two reflections are turns, whose transpose
/// is another image.

#include "osculate/model/contact_evaluation.hpp"
#include "support/random.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::model::OSCULATE_THIS_FILE {
namespace {

using osculate::support::Random;

constexpr double sector = std::numbers::pi / 3;

enum class Master { facets, rpim, blend, mortar, petrov_galerkin };

/// Whether forces are averaged over a slave facet, on a master of facets.
bool averaged(Master master) {
    return master == Master::mortar || master == Master::petrov_galerkin;
}

/// A sixth of a shallow bowl, between the planes through z at 0 and 60 degrees, and slave nodes over it and, where round-off
/// or an iterate would not take them, over its images.
class ObliquePlanes : public ::testing::TestWithParam<Master> {
protected:
    static constexpr int rings = 4, cuts = 3;

    void SetUp() override {
        const auto on_bowl = [](double r, double angle) {
            return Vec3(r * std::cos(angle), r * std::sin(angle), 0.04 * r * r);
        };
        x.push_back(on_bowl(0, 0));
        for (int ring = 1; ring <= rings; ++ring)
            for (int cut = 0; cut <= cuts; ++cut) x.push_back(on_bowl(ring, sector * cut / cuts));
        const auto at = [](int ring, int cut) { return static_cast<Index>(1 + (ring - 1) * (cuts + 1) + cut); };
        std::vector<mesh::Facet> facets;
        for (int cut = 0; cut < cuts; ++cut) {
            facets.push_back({{0, at(1, cut), at(1, cut + 1), -1}, 3});
            for (int ring = 1; ring < rings; ++ring)
                facets.push_back({{at(ring, cut), at(ring + 1, cut), at(ring + 1, cut + 1), at(ring, cut + 1)}, 4});
        }
        const std::vector<contact::SymmetryPlane> planes{{Vec3::Zero(), Vec3::UnitY()},
                                                         {Vec3::Zero(), Vec3(-std::sin(sector), std::cos(sector), 0)}};
        const contact::MirroredSurface mirrored = contact::mirror(facets, x, planes, 100);
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(mirrored.facets, mirrored.positions);
        ASSERT_EQ(surface->facet_count(), 6 * static_cast<Index>(facets.size()));
        MasterNodes nodes;
        std::vector<Vec3> vertices;
        for (const Index v : surface->vertex_nodes()) {
            nodes.node.push_back(mirrored.original[v]);
            nodes.image.push_back(mirrored.image[v]);
            vertices.push_back(mirrored.positions[v]);
        }
        nodes.images = mirrored.images;

        SlaveNodes slaves;
        std::vector<Vec3> s{{0.25, 0.2, 0.1}, {1.3, 0.1, 0.15}, {0.5, 1.1, 0.12},
                            {-0.3, 0.2, 0.1}, {-0.7, 1.1, 0.2}, {-1.2, -0.4, 0.1}};
        if (averaged(GetParam())) s = {{0.3, 0.2, 0.3}, {0.2, 1.1, 0.3}, {-0.6, 0.2, 0.3}, {-0.3, 1.3, 0.3}};
        for (const Vec3& p : s) {
            slaves.node.push_back(static_cast<Index>(x.size()));
            slaves.area.push_back(0.25);
            slaves.stiffness.push_back(3);
            x.push_back(p);
        }
        ContactOptions options;
        options.friction = 0.3;
        options.hysteresis = 0;
        if (averaged(GetParam())) {
            options.discretisation =
                GetParam() == Master::mortar ? Discretisation::mortar : Discretisation::petrov_galerkin;
            const auto& n = slaves.node;
            slaves.facets.push_back({{n[0], n[1], n[3], n[2]}, 4}); // seen from above it runs clockwise
            std::reverse(slaves.facets[0].nodes.begin(), slaves.facets[0].nodes.end());
        }
        auto master = GetParam() == Master::rpim    ? contact::make_rpim_surface(*surface, vertices, {})
                      : GetParam() == Master::blend ? contact::make_blend_surface(*surface, vertices, {})
                                                    : contact::make_facets_surface(*surface);
        pair = std::make_unique<ContactPair>("pair", x, slaves, std::move(surface), std::move(nodes), std::move(master),
                                             options);
        evaluation = std::make_unique<ContactEvaluation>(*pair);
        for (Vec3& p : x) p += random.vector(0.03); // images follow: a surface without any regularity
        evaluation->begin_step(x, pair->initial_history(), timings, 1);
        for (Vec3& p : x) p += random.vector(0.02);
        evaluation->evaluate(x, timings, 1);
        for (std::size_t i = 0; i < x.size(); ++i) way.push_back(random.vector(1));
        std::vector<char> all(slaves.node.size(), 1);
        evaluation->prepare_variations(all, 1);
        for (Index j = 0; j < pair->size(); ++j) ASSERT_TRUE(evaluation->point(j).found) << j;
    }

    /// Motion along `way` of the nodes of slave j's contact, (3+3n).
    [[nodiscard]] Vector motion(Index j) const {
        const auto& nodes = evaluation->point_nodes(j);
        Vector dy(3 + 3 * static_cast<Index>(nodes.size()));
        dy.head<3>() = way[pair->slaves().node[j]];
        for (std::size_t i = 0; i < nodes.size(); ++i) dy.segment<3>(3 + 3 * static_cast<Index>(i)) = way[nodes[i]];
        return dy;
    }
    /// Central difference of f with all nodes moving along `way`.
    [[nodiscard]] Vector difference(const auto& f) {
        constexpr double step = 1e-5;
        const auto at = [&](double t) -> Vector {
            std::vector<Vec3> moved = x;
            for (std::size_t i = 0; i < x.size(); ++i) moved[i] += t * way[i];
            evaluation->evaluate(moved, timings, 1);
            return f();
        };
        const Vector ahead = at(step), behind = at(-step);
        evaluation->evaluate(x, timings, 1);
        return (ahead - behind) / (2 * step);
    }
    [[nodiscard]] Vector master_forces(Index j, const Vec3& lambda) const {
        Vector f(3 * evaluation->carriers(j));
        for (Index i = 0; i < evaluation->carriers(j); ++i)
            f.segment<3>(3 * i) = evaluation->master_force(j, i, lambda);
        return f;
    }

    /// Relative: step^2 times third derivatives of the bumps, a few 1e4. Of mortar's weights, what its rule of
    /// integration misses where facets warp as much as here.
    [[nodiscard]] static double differences() { return averaged(GetParam()) ? 1e-3 : 1e-5; }
    static constexpr double round_off = 1e-12;

    std::vector<Vec3> x, way;
    std::unique_ptr<ContactPair> pair;
    std::unique_ptr<ContactEvaluation> evaluation;
    Timings timings;
    Random random{91};
};

TEST_P(ObliquePlanes, AUnitNormalForceDoesTheWorkOfTheGap) {
    if (averaged(GetParam())) GTEST_SKIP() << "forces averaged over facets are not those of the gap at a node";
    for (Index j = 0; j < pair->size(); ++j) {
        const Vec3 n = evaluation->point(j).normal;
        contact::ContactVariation variation;
        evaluation->vary(j, variation);
        double work = n.dot(way[pair->slaves().node[j]]);
        const Vector forces = master_forces(j, n);
        for (Index i = 0; i < evaluation->carriers(j); ++i)
            work += forces.segment<3>(3 * i).dot(way[evaluation->point_nodes(j)[i]]);
        const double by_gap = difference([&] { return Vector::Constant(1, evaluation->point(j).gap); })(0);
        EXPECT_NEAR(variation.dg.leftCols<3>().norm() * work, by_gap, differences()) << j;
    }
}

TEST_P(ObliquePlanes, ForcesOnTheMasterAndTheirDerivativesByTheForceAgree) {
    for (Index j = 0; j < pair->size(); ++j) {
        const Vec3 lambda = random.vector(1);
        contact::MatrixX3 E = evaluation->master_force_by_lambda(j);
        Matrix A = Matrix::Zero(3, 3 + 3 * static_cast<Index>(evaluation->point_nodes(j).size()));
        evaluation->fold(j, A, E);
        EXPECT_LT((E * lambda - master_forces(j, lambda)).norm(), round_off) << j;
    }
}

TEST_P(ObliquePlanes, ForcesOnTheMasterChangeAsTheirDerivativesSay) {
    for (Index j = 0; j < pair->size(); ++j) {
        const Vec3 lambda = random.vector(1);
        const Vector expected = difference([&] { return master_forces(j, lambda); });
        contact::ContactVariation variation;
        evaluation->vary(j, variation);
        Matrix G;
        evaluation->master_force_by_y(j, lambda, variation, G);
        evaluation->fold(j, G);
        EXPECT_LT((G * motion(j) - expected).norm(), differences() * expected.norm()) << j;
        Vector dy = motion(j), df;
        evaluation->master_force_along(j, lambda, variation, dy, df);
        EXPECT_LT((df - expected).norm(), differences() * expected.norm()) << j;
    }
}

TEST_P(ObliquePlanes, TheDriftChangesAsItsDerivativesSay) {
    for (Index j = 0; j < pair->size(); ++j) {
        const Vector expected = difference([&]() -> Vector { return evaluation->drift(j); });
        contact::ContactVariation variation;
        evaluation->vary(j, variation);
        Matrix dd;
        contact::MatrixX3 E = evaluation->master_force_by_lambda(j);
        evaluation->drift_variation(j, variation, dd);
        evaluation->fold(j, dd, E);
        EXPECT_LT((dd * motion(j) - expected).norm(), differences() * expected.norm()) << j;
    }
}

/// The images meet in the line of both planes: along it they all move alike.
TEST_P(ObliquePlanes, FollowingTheMasterIsToMoveAsItsImagesDo) {
    for (Index j = 0; j < pair->size(); ++j) {
        std::vector<Index> nodes;
        std::vector<Mat3> follow;
        evaluation->follow_master(j, nodes, follow);
        Vec3 closest = Vec3::Zero(), lifted = Vec3::Zero();
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            lifted += follow[i] * Vec3::UnitZ();
            closest += follow[i] * x[nodes[i]];
        }
        EXPECT_LT((lifted - Vec3::UnitZ()).norm(), round_off) << j;
        if (averaged(GetParam())) continue;
        // every image is linear here: of the positions themselves it makes the closest point
        EXPECT_NEAR((closest - x[pair->slaves().node[j]]).norm(), evaluation->hit(j).distance, round_off) << j;
    }
}

std::string name_of(const ::testing::TestParamInfo<Master>& tested) {
    constexpr const char* names[] = {"Facets", "Rpim", "Blend", "Mortar", "PetrovGalerkin"};
    return names[static_cast<int>(tested.param)];
}
INSTANTIATE_TEST_SUITE_P(Of, ObliquePlanes,
                         ::testing::Values(Master::facets, Master::rpim, Master::blend, Master::mortar,
                                           Master::petrov_galerkin),
                         name_of);

} // namespace
} // namespace osculate::model::OSCULATE_THIS_FILE
