/// Mortar weighting of a flat and of a curved interface, without bodies around them.

#include "osculate/contact/mortar.hpp"

#include "contact/pairing.hpp"
#include "contact/surfaces.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>
#include <map>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using fixtures::Surface;
using osculate::support::Random;

using fixtures::Pairing;
using fixtures::Slave;

auto mortar_on(const Surface& master) {
    return [&](const Slave& slave) {
        return std::make_unique<Mortar>(master.topology, slave.facets, slave.X, std::vector<Mat3>{});
    };
}

constexpr double round_off = 1e-12;

struct Case {
    mesh::BlockPattern master, slave;
};
class FlatMortar : public ::testing::TestWithParam<Case> {
protected:
    Surface master = fixtures::block_top(GetParam().master); // [0, 5] x [0, 4], 0.5 m
    static Slave slave(const Vec3& origin, const Vec3& size) { return {origin, size, {7, 3}, GetParam().slave}; }
};

TEST_P(FlatMortar, HandsAConstantPressureToTheMasterAsItsElementsTakeIt) {
    // both surfaces end together: every master node must get int N_i dA
    const Pairing pairing(master, make_blend_surface(master.topology, master.x, {}), slave({0, 0, 0}, {5, 4, 1}),
                          mortar_on(master));
    Vector got = Vector::Zero(master.topology.vertex_count());
    for (std::size_t j = 0; j < pairing.points.size(); ++j) {
        const ContactPoint& point = pairing.points[j];
        ASSERT_TRUE(point.found);
        EXPECT_NEAR(point.weights.sum(), 1, round_off);
        for (Index i = 0; i < pairing.carriers(static_cast<Index>(j)); ++i)
            got(point.nodes[i]) += pairing.slave.area[j] * point.weights(i);
    }
    Vector exact = Vector::Zero(got.size());
    for (Index f = 0; f < master.topology.facet_count(); ++f) {
        std::vector<Vec3> corner;
        for (const Index v : master.topology.facet_vertices(f)) corner.push_back(master.x[v]);
        for (const Index v : master.topology.facet_vertices(f))
            exact(v) += SlavePlane(corner).area() / static_cast<double>(corner.size());
    }
    EXPECT_LT((got - exact).cwiseAbs().maxCoeff(), round_off);
}

TEST_P(FlatMortar, ReproducesLinearGapsAtTheNodes) {
    const auto linear = [](const Vec3& X) { return 0.01 + 0.002 * X.x() - 0.003 * X.y(); };
    Slave tilted = slave({0.6, 0.3, 0}, {4, 3, 1});
    std::vector<Vec3> s = tilted.X;
    for (Vec3& x : s) x.z() = linear(x);
    Pairing pairing(master, make_facets_surface(master.topology), tilted, mortar_on(master));
    pairing.evaluate(s, master.x);
    for (std::size_t j = 0; j < s.size(); ++j) {
        ASSERT_TRUE(pairing.points[j].found);
        EXPECT_NEAR(pairing.points[j].gap, s[j].z(), round_off);
        EXPECT_LT((pairing.points[j].normal - Vec3::UnitZ()).norm(), round_off);
    }
}

TEST_P(FlatMortar, ComesBackFromWhereIteratesRanAway) {
    Surface bent = master;
    for (Vec3& p : bent.x) p.z() = 0.02 * p.x() * p.x();
    const Slave above = slave({0.6, 0.3, 0.3}, {2, 3, 1});
    Pairing pairing(bent, make_facets_surface(bent.topology), above, mortar_on(bent));
    std::vector<double> gaps;
    for (const ContactPoint& point : pairing.points) gaps.push_back(point.gap);
    std::vector<Vec3> s = above.X;
    for (int k = 0; k < 6; ++k) { // more often than it takes to be latched
        for (std::size_t j = 0; j < s.size(); ++j) s[j].x() = above.X[j].x() + (k % 2 == 0 ? 1 : 2);
        pairing.move(s, bent.x);
    }
    pairing.move(above.X, bent.x);
    // a latched point may stay a quarter of a facet beyond one, whose neighbour turns by 0.02; from where it ran to, it is 0.02
    constexpr double beyond = 0.25 * 0.5 * 0.02 * 1.5;
    for (std::size_t j = 0; j < gaps.size(); ++j) EXPECT_NEAR(pairing.points[j].gap, gaps[j], beyond);
}

TEST_P(FlatMortar, ActsOnOneLine) {
    // sum_i W_ji x_i lies below slave node j, so that the forces on both sides have no moment
    const Pairing pairing(master, make_facets_surface(master.topology), slave({0.6, 0.3, 0.1}, {4, 3, 1}),
                          mortar_on(master));
    for (std::size_t j = 0; j < pairing.points.size(); ++j)
        EXPECT_LT((pairing.points[j].foot + Vec3(0, 0, 0.1) - pairing.slave.X[j]).norm(), round_off);
}

TEST_P(FlatMortar, KeepsToThePartThatLiesOverTheMaster) {
    // a fifth of the slave overhangs; nodes whose facets still touch the master keep exact gaps and balanced forces
    const Pairing pairing(master, make_facets_surface(master.topology), slave({1.2, 0.4, 0.2}, {4.75, 3, 1}),
                          mortar_on(master));
    int found = 0, lost = 0;
    for (std::size_t j = 0; j < pairing.points.size(); ++j) {
        if (!pairing.points[j].found) {
            EXPECT_GT(pairing.slave.X[j].x(), 5.0);
            ++lost;
            continue;
        }
        ++found;
        EXPECT_NEAR(pairing.points[j].gap, 0.2, round_off);
        EXPECT_NEAR(pairing.points[j].weights.sum(), 1, round_off);
        EXPECT_LT((pairing.points[j].foot + Vec3(0, 0, 0.2) - pairing.slave.X[j]).norm(), 1e-10); // small facets left
    }
    EXPECT_GT(found, 20);
    EXPECT_GT(lost, 0);
}

INSTANTIATE_TEST_SUITE_P(Patterns, FlatMortar,
                         ::testing::Values(Case{mesh::BlockPattern::quad, mesh::BlockPattern::quad},
                                           Case{mesh::BlockPattern::triangle, mesh::BlockPattern::quad},
                                           Case{mesh::BlockPattern::hybrid, mesh::BlockPattern::triangle},
                                           Case{mesh::BlockPattern::quad, mesh::BlockPattern::hybrid}));

TEST(Mortar, CountsAFacetThatTwoFifthsOfAreOverTheMasterAndNoSliver) {
    const Surface master = fixtures::block_top(mesh::BlockPattern::quad); // up to x = 5
    for (const double over : {0.8, 0.04}) {
        const Pairing pairing(master, make_facets_surface(master.topology),
                              Slave({5 - over, 1, 0.2}, {2, 2, 1}, {1, 1}, mesh::BlockPattern::quad),
                              mortar_on(master));
        for (std::size_t j = 0; j < pairing.points.size(); ++j) {
            ASSERT_EQ(pairing.points[j].found, over > 0.1) << over;
            if (!pairing.points[j].found) continue;
            EXPECT_NEAR(pairing.points[j].gap, 0.2, round_off);
            EXPECT_NEAR(pairing.points[j].weights.sum(), 1, 10 * round_off); // dual functions of a part are large
            EXPECT_LT((pairing.points[j].foot + Vec3(0, 0, 0.2) - pairing.slave.X[j]).norm(), 100 * round_off);
        }
    }
}

TEST(Mortar, VariesAsItsDifferencesSay) {
    // a shaken block of triangles above a shaken plane of triangles: the weights are integrated exactly there
    Surface master = fixtures::block_top(mesh::BlockPattern::triangle);
    Random random(11);
    for (Vec3& x : master.x) x += 0.03 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    Pairing pairing(master, make_blend_surface(master.topology, master.x, {}),
                    Slave({1.1, 0.9, 0.02}, {2, 2, 1}, {3, 4}, mesh::BlockPattern::triangle), mortar_on(master));
    std::vector<Vec3> s = pairing.slave.X;
    for (Vec3& at : s) at += 0.02 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    fixtures::expect_variations(pairing, s, master.x, 7);
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
