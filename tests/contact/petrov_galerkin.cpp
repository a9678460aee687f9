/// Gaps at slave nodes over a filtered master, forces by dual weights, without bodies around them.

#include "contact/pairing.hpp"
#include "osculate/contact/master_filter.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using fixtures::Pairing;
using fixtures::Slave;
using fixtures::Surface;
using osculate::support::Random;

auto on(const Surface& master) {
    return
        [&](const Slave& slave) { return make_petrov_galerkin(master.topology, master.x, slave.facets, slave.X, {}); };
}

Vec3 shaken(double by, Random& random) {
    return by * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

struct Case {
    mesh::BlockPattern master, slave;
    double x = 1.1; ///< where the slave begins: the master ends at 5
};
class PetrovGalerkin : public ::testing::TestWithParam<Case> {};

TEST_P(PetrovGalerkin, VariesAsItsDifferencesSay) {
    // the slave's facets are finer than the master's, so that the filter acts; in some cases it ends beyond the master
    Surface master = fixtures::block_top(GetParam().master);
    Random random(11);
    for (Vec3& x : master.x) x += shaken(0.02, random);
    Pairing pairing(master, make_blend_surface(master.topology, master.x, {}),
                    Slave({GetParam().x, 0.9, 0.02}, {1.2, 1.2, 1}, {4, 5}, GetParam().slave), on(master));
    std::vector<Vec3> s = pairing.slave.X;
    for (Vec3& at : s) at += shaken(0.02, random);
    int tried = 0;
    pairing.evaluate(s, master.x);
    const std::vector<ContactPoint> points = pairing.points;
    for (const Index j : {7, 12, 20})
        if (points[static_cast<std::size_t>(j)].found) {
            fixtures::expect_variations(pairing, s, master.x, j);
            ++tried;
        }
    EXPECT_GT(tried, 0);
}

TEST_P(PetrovGalerkin, LosesNothingOfAPressureOnThePartAboveTheMaster) {
    const Surface master = fixtures::block_top(GetParam().master);
    const double begin = GetParam().x, end = std::min(5.0, begin + 1.2);
    const Pairing pairing(master, make_blend_surface(master.topology, master.x, {}),
                          Slave({begin, 0.9, 0}, {1.2, 1.2, 1}, {4, 5}, GetParam().slave), on(master));
    DualWeights weights(master.topology, pairing.slave.facets, pairing.slave.X, 1e-3);
    for (Index f = 0; f < weights.facet_count(); ++f) {
        std::vector<Index> all;
        for (Index m = 0; m < master.topology.facet_count(); ++m) all.push_back(m);
        weights.update(f, pairing.at(pairing.slave.X, master.x), all);
    }
    // the resultant and the moments of a unit pressure over the part above the master
    double force = 0;
    Vec3 moment = Vec3::Zero(), of_slaves = Vec3::Zero();
    for (std::size_t j = 0; j < pairing.points.size(); ++j) {
        const double D = weights.share(static_cast<Index>(j));
        if (!(D > 0)) continue;
        ASSERT_TRUE(pairing.points[j].found) << j;
        EXPECT_NEAR(pairing.points[j].gap, 0, 1e-12);
        force += D;
        of_slaves += D * pairing.slave.X[j];
        for (Index i = 0; i < pairing.carriers(static_cast<Index>(j)); ++i)
            moment += D * pairing.points[j].weights(i) * master.x[pairing.points[j].nodes[i]];
    }
    const double area = (end - begin) * 1.2;
    EXPECT_NEAR(force, area, 1e-10);
    double loaded = 0;
    for (Index j = 0; j < static_cast<Index>(pairing.points.size()); ++j)
        loaded += pairing.discretisation->loaded_area(j, 0); // 0 for those that no part stands for
    EXPECT_NEAR(loaded, area, 1e-10);
    EXPECT_LT((moment - area * Vec3((begin + end) / 2, 1.5, 0)).norm(), 1e-10);
    EXPECT_LT((of_slaves - moment).norm(), 1e-10);
}

TEST_P(PetrovGalerkin, AVertexThatNoneOfItsFacetsCarriesPressesOnTheSmoothSurface) {
    // the slave's facets stand on an edge and face away from the master
    Surface master = fixtures::block_top(GetParam().master);
    Random random(5);
    for (Vec3& x : master.x) x += shaken(0.02, random);
    Slave slave({1.1, 0.9, 0.02}, {1.2, 1.2, 1}, {4, 5}, GetParam().slave);
    std::vector<Index> edge;
    for (Vec3& at : slave.X) {
        const double from_edge = at.x() - 1.1;
        if (from_edge < 1e-9) edge.push_back(static_cast<Index>(&at - slave.X.data()));
        at = Vec3(1.1 + std::cos(2.1) * from_edge, at.y(), 0.02 + std::sin(2.1) * from_edge);
    }
    Pairing pairing(master, make_blend_surface(master.topology, master.x, {}), slave, on(master));
    std::vector<Vec3> s = slave.X;
    pairing.evaluate(s, master.x);
    ASSERT_GE(edge.size(), 6u);
    for (const Index j : edge) {
        const ContactPoint& point = pairing.points[static_cast<std::size_t>(j)];
        ASSERT_TRUE(point.found);
        EXPECT_NEAR(point.weights.sum(), 1, 1e-14);
        EXPECT_EQ(pairing.discretisation->loaded_area(j, 0.7), 0.7);
        // whichever of the facets around a vertex of the closest one counts as the closest: it may be either of two
        const auto weights = [&] {
            Vector all = Vector::Zero(master.topology.vertex_count());
            for (std::size_t i = 0; i < point.nodes.size(); ++i)
                all(point.nodes[i]) += point.weights(static_cast<Index>(i));
            return all;
        };
        const Vector before = weights();
        const FacetHit hit = pairing.tracking.hits[static_cast<std::size_t>(j)];
        for (const Index f : master.topology.vertex_facets(master.topology.facet_vertices(hit.facet)[0])) {
            pairing.tracking.facet[static_cast<std::size_t>(j)] = f;
            pairing.tracking.hits[static_cast<std::size_t>(j)] =
                pairing.search.closest_on(f, s[static_cast<std::size_t>(j)], master.x);
            pairing.move(s, master.x);
            ASSERT_TRUE(point.found);
            EXPECT_LT((weights() - before).cwiseAbs().maxCoeff(), 1e-12);
        }
        pairing.tracking.facet[static_cast<std::size_t>(j)] = hit.facet;
        pairing.tracking.hits[static_cast<std::size_t>(j)] = hit;
    }
    for (const Index j : {edge[1], edge[3]}) fixtures::expect_variations(pairing, s, master.x, j);
}

INSTANTIATE_TEST_SUITE_P(Meshes, PetrovGalerkin,
                         ::testing::Values(Case{mesh::BlockPattern::triangle, mesh::BlockPattern::triangle},
                                           Case{mesh::BlockPattern::quad, mesh::BlockPattern::quad},
                                           Case{mesh::BlockPattern::hybrid, mesh::BlockPattern::quad},
                                           Case{mesh::BlockPattern::triangle, mesh::BlockPattern::triangle, 4.33},
                                           Case{mesh::BlockPattern::quad, mesh::BlockPattern::quad, 4.33},
                                           Case{mesh::BlockPattern::quad, mesh::BlockPattern::hybrid, 4.45}));

// ---- the filter -------------------------------------------------------------------------------------------------------

/// Of a slave mesh far finer than the master's: Theta is 1 everywhere but on borders.
MasterFilter strongest(const Surface& surface) {
    return {surface.topology, surface.x, Mat3::Identity() / (0.01 * 0.01)};
}

std::vector<Vec3> filtered(const MasterFilter& filter, const std::vector<Vec3>& x) {
    std::vector<Vec3> result, none;
    filter.apply(x, {}, result, none);
    return result;
}

TEST(MasterFilter, IsIdleUnderASlaveMeshAsCoarseAsTheMaster) {
    const Surface surface = fixtures::block_top(mesh::BlockPattern::quad);
    EXPECT_FALSE(MasterFilter(surface.topology, surface.x, Mat3::Identity() / (0.51 * 0.51)).active());
    EXPECT_TRUE(MasterFilter(surface.topology, surface.x, Mat3::Identity() / (0.49 * 0.49)).active());
}

TEST(MasterFilter, LetsMotionsOfARigidBodyPass) {
    for (const Surface& surface : fixtures::all_surfaces()) {
        const MasterFilter filter = strongest(surface);
        ASSERT_TRUE(filter.active());
        const Mat3 turn = Eigen::AngleAxisd(1.3, Vec3(1, 2, -1).normalized()).toRotationMatrix();
        std::vector<Vec3> x;
        for (const Vec3& X : surface.x) x.push_back(turn * X + Vec3(100, -20, 3));
        const std::vector<Vec3> result = filtered(filter, x);
        for (std::size_t v = 0; v < x.size(); ++v) EXPECT_LT((result[v] - x[v]).norm(), 1e-11) << surface.name;
    }
}

TEST(MasterFilter, LetsStretchesOfAPlanePass) {
    for (const auto pattern : {mesh::BlockPattern::quad, mesh::BlockPattern::triangle, mesh::BlockPattern::hybrid}) {
        const Surface surface = fixtures::block_top(pattern);
        const MasterFilter filter = strongest(surface);
        std::vector<Vec3> x;
        for (const Vec3& X : surface.x)
            x.emplace_back(1.1 * X.x() + 0.2 * X.y(), 0.9 * X.y(), 0.03 * X.x() - 0.05 * X.y());
        const std::vector<Vec3> result = filtered(filter, x);
        for (std::size_t v = 0; v < x.size(); ++v) EXPECT_LT((result[v] - x[v]).norm(), 1e-12);
    }
}

TEST(MasterFilter, RemovesWavesOfTwoFacetsAndKeepsLongOnes) {
    const Surface surface = fixtures::block_top(mesh::BlockPattern::quad); // facets of 0.5 m
    const MasterFilter filter = strongest(surface);
    const auto left = [&](double wavelength) { // of a wave of unit height along x, in the middle
        std::vector<Vec3> x = surface.x;
        for (Vec3& at : x) at.z() += 1e-3 * std::cos(2 * std::numbers::pi * (at.x() - 2.5) / wavelength);
        const std::vector<Vec3> result = filtered(filter, x);
        for (std::size_t v = 0; v < x.size(); ++v)
            if ((surface.x[v] - Vec3(2.5, 2, 0)).norm() < 1e-9) return result[v].z() / 1e-3;
        return 0.0;
    };
    EXPECT_NEAR(left(1), 0, 1e-12);
    // B of a wave along a mesh line is (1 + cos kh) / 2, so Q = 1 - sin^4(kh/2)
    EXPECT_NEAR(left(10), 1 - std::pow(std::sin(std::numbers::pi * 0.5 / 10), 4), 1e-12);
}

TEST(MasterFilter, ActsFromVerticesInsideTheBoundaryAlone) {
    const Surface surface = fixtures::block_top(mesh::BlockPattern::quad);
    MasterFilter filter = strongest(surface);
    filter.differentiate(surface.x);
    const auto at = [&](const Vec3& where) {
        Index v = 0;
        while ((surface.x[v] - where).norm() > 1e-9) ++v;
        return v;
    };
    const Index edge =
        at({2.5, 0, 0}); // L is -1/8 from the vertex behind it, -1/16 from those beside that; m is half theirs
    Mat3 own = Mat3::Zero();
    for (std::size_t k = 0; k < filter.row(edge).size(); ++k)
        if (filter.row(edge)[k] == edge) own = filter.derivatives(edge)[k];
    EXPECT_LT((own - (1 - (1.0 / 64 + 2.0 / 256) * 2) * Mat3::Identity()).norm(), 1e-12);
}

TEST(MasterFilter, MovesPositionsAsItsDerivativesSay) {
    for (const Surface& surface : fixtures::all_surfaces()) {
        MasterFilter filter = strongest(surface);
        Random random(3);
        std::vector<Vec3> x = surface.x, dx, ahead, behind;
        for (Vec3& at : x) at += shaken(0.05, random);
        constexpr double h = 1e-6;
        for (const Vec3& at : x) {
            const Vec3 way = dx.emplace_back(shaken(1, random));
            ahead.emplace_back(at + h * way);
            behind.emplace_back(at - h * way);
        }
        filter.differentiate(x);
        ahead = filtered(filter, ahead);
        behind = filtered(filter, behind);
        for (Index v = 0; v < surface.topology.vertex_count(); ++v) {
            Vec3 expected = Vec3::Zero();
            for (std::size_t k = 0; k < filter.row(v).size(); ++k)
                expected += filter.derivatives(v)[k] * dx[static_cast<std::size_t>(filter.row(v)[k])];
            EXPECT_LT(((ahead[v] - behind[v]) / (2 * h) - expected).norm(), 1e-8) << surface.name;
        }
    }
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
