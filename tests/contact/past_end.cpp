/// Slave nodes past the end of a curved master.

#include "osculate/contact/past_end.hpp"

#include "contact/pairing.hpp"

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using fixtures::Pairing;
using fixtures::Slave;
using fixtures::Surface;

constexpr double radius = 3, height = 0.01;

/// (x, y, z) of a block's top to a cylinder about an axis along x: y becomes an arc.
Vec3 rolled(const Vec3& at, double r = radius) {
    const double angle = (at.y() - 2) / radius;
    return {at.x(), r * std::sin(angle), r * std::cos(angle) - radius};
}

Surface cylinder(mesh::BlockPattern pattern) {
    Surface surface = fixtures::block_top(pattern);
    for (Vec3& x : surface.x) x = rolled(x);
    return surface;
}

class PastEnd : public ::testing::TestWithParam<mesh::BlockPattern> {};

TEST_P(PastEnd, ACylinderGoesOnAsACylinder) {
    const Surface master = cylinder(GetParam());
    Slave slave({4.33, 0.9, 0}, {1.2, 1.2, 1}, {4, 5}, mesh::BlockPattern::quad); // the master ends at 5
    for (Vec3& at : slave.X) at = rolled(at, radius + height);
    const Pairing pairing(master, make_blend_surface(master.topology, master.x, {}), slave, [&](const Slave& own) {
        return make_petrov_galerkin(master.topology, master.x, own.facets, own.X, {});
    });
    int past = 0;
    for (std::size_t j = 0; j < slave.X.size(); ++j) {
        if (slave.X[j].x() < 5 || !(pairing.discretisation->loaded_area(static_cast<Index>(j), 0) > 0)) continue;
        ++past;
        const ContactPoint& point = pairing.points[j];
        ASSERT_TRUE(point.found);
        const Vec3 outward = Vec3(0, slave.X[j].y(), slave.X[j].z() + radius).normalized();
        constexpr double sagitta = 0.5 * 0.5 / (8 * radius); // by which facets are lower
        EXPECT_LT(std::abs(point.gap - height), 0.05 * sagitta);
        EXPECT_LT((point.normal - outward).norm(), 0.01); // on facets up to half their turn, 0.08
    }
    EXPECT_GE(past, 5);
}

TEST_P(PastEnd, VariesAsItsDifferencesSay) {
    Surface master = cylinder(GetParam());
    osculate::support::Random random(3);
    const auto shaken = [&](double by) -> Vec3 {
        return by * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    for (Vec3& x : master.x) x += shaken(0.02);
    // past a side as well as past a corner of the master
    Slave slave({4.33, 3.37, 0}, {1.2, 1.2, 1}, {4, 5}, mesh::BlockPattern::quad);
    for (Vec3& at : slave.X) at = rolled(at, radius + height) + shaken(0.01);
    Pairing pairing(master, make_blend_surface(master.topology, master.x, {}), slave, [&](const Slave& own) {
        return make_petrov_galerkin(master.topology, master.x, own.facets, own.X, {});
    });
    const std::vector<Vec3> s = slave.X;
    const FacetTracking tracking = pairing.tracking;
    int tried = 0;
    for (std::size_t j = 0; j < s.size(); ++j) {
        if (tracking.hits[j].beyond < 0.05 || !(pairing.discretisation->loaded_area(static_cast<Index>(j), 0) > 0))
            continue;
        fixtures::expect_variations(pairing, s, master.x, static_cast<Index>(j));
        ++tried;
    }
    EXPECT_GE(tried, 6);
}

/// A diverged iterate: on such a facet Newton's method finds a foot from some starts only.
TEST(PastEndOfAWarpedFacet, VariesWithTheStartOfItsEvaluation) {
    const std::vector<Vec3> x{{-5.4157043546402441, -5.1869859305111579, -4.7349265767297695},
                              {-3.9809992350759806, -6.8549849185452771, -3.8772838355737944},
                              {8.1490233390705242, 7.6042325698138526, 1.1026632327467831},
                              {9.5236322189038844, 12.574104797975338, 5.5256563904572573}};
    const Vec3 s{94.299463921563643, 7.0879431997363049, 18.501366209219615};
    mesh::Facet facet;
    facet.count = 4;
    for (int c = 0; c < 4; ++c) facet.nodes[c] = c;
    const mesh::HalfEdgeSurface surface({facet}, x, mesh::default_feature_angle);
    const auto master = make_facets_surface(surface);
    const FacetSearch search(surface);
    const std::vector<Vec3> slaves{s};
    const PairPositions at{*master, search, slaves, x};
    FacetHit hit = search.closest_on(0, s, x);
    ContactPoint elsewhere;
    FacetHit inside = hit;
    inside.beyond = 0;
    master->evaluate(s, inside, x, elsewhere);
    ASSERT_FALSE(elsewhere.found);
    hit.u = {-0.69072331969483569, 1};

    const contact::PastEnd end(surface);
    contact::PastEnd::Point place;
    ContactPoint point;
    end.evaluate(s, hit, at, place, point);
    ASSERT_TRUE(place.facet.found);
    ASSERT_TRUE(point.found);
    ContactVariation variation;
    end.vary(s, at, place, point, variation);
    EXPECT_EQ(variation.dg.cols(), 15);
    EXPECT_TRUE(variation.dg.allFinite());
}

INSTANTIATE_TEST_SUITE_P(Meshes, PastEnd,
                         ::testing::Values(mesh::BlockPattern::quad, mesh::BlockPattern::triangle,
                                           mesh::BlockPattern::hybrid));

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
