/// Edges that cross edges: gap, normal, shares and their variations.

#include "osculate/contact/edge_crossing.hpp"

#include "support/differences.hpp"
#include "support/random.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using osculate::support::central_differences;
using osculate::support::Random;
using osculate::support::relative_difference;

/// A roof whose ridge runs along y from (0, -1, 0) to (0, 1, 0), its faces at 45 degrees; and one upside down above it, whose
/// ridge runs along x, at a height.
struct Roofs {
    std::vector<Vec3> vertices{{0, -1, 0}, {0, 1, 0}, {1, -1, -1}, {1, 1, -1}, {-1, -1, -1}, {-1, 1, -1}};
    std::vector<Vec3> slaves; // (ridge from, to, then the corners of its faces)
    mesh::HalfEdgeSurface surface;
    std::vector<EdgesThatMeet> edges;
    // of the ridge below from either end
    std::unique_ptr<const MasterSurface> none = make_facets_surface(surface);
    FacetSearch search{surface};
    FacetTracking tracking;
    std::vector<ContactPoint> points;
    std::unique_ptr<Discretisation> discretisation;

    static std::vector<mesh::Facet> facets() {
        mesh::Facet right, left;
        right.count = left.count = 4;
        right.nodes = {0, 2, 3, 1};
        left.nodes = {0, 1, 5, 4};
        return {right, left};
    }

    explicit Roofs(double height, double along = 0.3)
        : slaves{{-along, 0.1, height},        {1 - along, 0.1, height},   {-along, 1.1, height + 1},
                 {1 - along, 1.1, height + 1}, {-along, -0.9, height + 1}, {1 - along, -0.9, height + 1}},
          surface(facets(), vertices) {
        Index ridge = -1;
        for (Index h = 0; h < static_cast<Index>(surface.half_edges().size()); ++h)
            if (surface.is_feature_edge(h) && ridge < 0) ridge = h;
        EdgesThatMeet& one = edges.emplace_back();
        one.end = 1;
        one.wings = {{{0, 1, 3, 2}, {0, 1, 5, 4}}};
        one.half_edge = ridge;
        one.reverse = 1;
        EdgesThatMeet& other = edges.emplace_back(edges[0]); // from its other end
        other.end = other.reverse = 0;
        tracking.facet.assign(2, -1);
        tracking.changes.assign(2, 0);
        tracking.hits.resize(2);
        points.resize(2);
        discretisation = make_edge_discretisation(surface, edges);
    }
    [[nodiscard]] PairPositions at() const { return {*none, search, slaves, vertices}; }
    const ContactPoint& begin_and_evaluate() {
        discretisation->begin(at(), tracking, 1);
        return evaluate();
    }
    const ContactPoint& evaluate() {
        discretisation->evaluate(at(), tracking, points, 1);
        return points[0];
    }
};

TEST(EdgeCrossing, HasTheDistanceOfTheRidgesAndSharesByTheLever) {
    for (const double height : {0.01, -0.01}) {
        Roofs roofs(height);
        const ContactPoint& point = roofs.begin_and_evaluate();
        ASSERT_TRUE(point.found);
        EXPECT_NEAR(point.gap, height, 1e-15);
        EXPECT_LT((point.normal - Vec3::UnitZ()).norm(), 1e-15);
        // the crossing is at 0.3 of the slave's edge and at 0.55 of the ridge
        const Vec3 lambda(0, 0, 0.7);
        EXPECT_NEAR(point.force(0, lambda).z(), 0.3, 1e-14);
        const double first = roofs.vertices[static_cast<std::size_t>(point.nodes[1])].y() < 0 ? 0.45 : 0.55;
        EXPECT_NEAR(point.force(1, lambda).z(), -first, 1e-14);
        EXPECT_NEAR(point.force(2, lambda).z(), -(1 - first), 1e-14);
    }
}

TEST(EdgeCrossing, IsThatOfTheNearerEndAndOfConesThatMeet) {
    EXPECT_TRUE(Roofs(0.01, 0.49).begin_and_evaluate().found);
    EXPECT_FALSE(Roofs(0.01, 0.51).begin_and_evaluate().found); // the item of the other end has it
    EXPECT_FALSE(Roofs(0.01, -0.1).begin_and_evaluate().found); // beside the edge
    EXPECT_FALSE(Roofs(-0.9).begin_and_evaluate().found);       // through the body
    Roofs upright(0.01);                                        // both roofs open downwards
    for (std::size_t k = 2; k < 6; ++k) upright.slaves[k].z() = -1;
    EXPECT_FALSE(upright.begin_and_evaluate().found);
}

TEST(EdgeCrossing, BesideTheEdgesHasTheGapOfTheirLines) {
    Roofs roofs(-0.01, -0.1);
    const ContactPoint& point = roofs.begin_and_evaluate();
    EXPECT_FALSE(point.found);
    EXPECT_NEAR(point.gap, -0.01, 1e-15);
    EXPECT_EQ(Roofs(0.01, 0.51).begin_and_evaluate().gap, std::numeric_limits<double>::infinity());
}

TEST(EdgeCrossing, ThatIsDeepIsOneThatWasThereBefore) {
    Roofs roofs(-0.05);
    EXPECT_FALSE(roofs.begin_and_evaluate().found); // the lines cross, but the edges have not met
    roofs.tracking.facet[0] = 0;
    EXPECT_TRUE(roofs.begin_and_evaluate().found);
}

TEST(EdgeCrossing, KeepsItsSideWithinAnAttempt) {
    Roofs roofs(0.2);
    roofs.begin_and_evaluate();
    for (Vec3& x : roofs.slaves) x.z() -= 0.9;
    EXPECT_NEAR(roofs.evaluate().gap, -0.7, 1e-14);
}

TEST(EdgeCrossing, ForcesAndMomentsAddUpToNone) {
    Random random(5);
    for (int k = 0; k < 20; ++k) {
        Roofs roofs(0.4);
        for (auto* list : {&roofs.slaves, &roofs.vertices})
            for (Vec3& x : *list) x += random.vector(0.1);
        const ContactPoint& point = roofs.begin_and_evaluate();
        ASSERT_TRUE(point.found);
        const Vec3 lambda = 2 * point.normal; // a force along the normal has no moment at any gap
        Vec3 sum = lambda, moment = roofs.slaves[0].cross(lambda);
        for (Index i = 0; i < 3; ++i) {
            const Index v = point.nodes[static_cast<std::size_t>(i)], count = roofs.surface.vertex_count();
            const Vec3& x = v < count ? roofs.vertices[static_cast<std::size_t>(v)]
                                      : roofs.slaves[static_cast<std::size_t>(v - count)];
            sum += point.force(i, lambda);
            moment += x.cross(point.force(i, lambda));
        }
        EXPECT_LT(sum.norm(), 1e-13);
        EXPECT_LT(moment.norm(), 1e-13);
    }
}

TEST(EdgeCrossing, HasTheVariationsThatDifferencesGive) {
    constexpr double step = 1e-6, tolerance = 1e-8; // step^2 of curvature, 1e-15 / step of round-off
    Random random(7);
    for (int k = 0; k < 20; ++k) {
        Roofs roofs(0.4);
        for (auto* list : {&roofs.slaves, &roofs.vertices})
            for (Vec3& x : *list) x += random.vector(0.1);
        const ContactPoint at = roofs.begin_and_evaluate();
        ASSERT_TRUE(at.found);
        ContactVariation variation;
        roofs.discretisation->vary(0, roofs.at(), roofs.tracking.hits[0], at, variation);
        const auto place = [&](Index i) -> Vec3& {
            const Index v = i == 0 ? roofs.surface.vertex_count() : at.nodes[static_cast<std::size_t>(i - 1)];
            const Index count = roofs.surface.vertex_count();
            return v < count ? roofs.vertices[static_cast<std::size_t>(v)]
                             : roofs.slaves[static_cast<std::size_t>(v - count)];
        };
        Vector y(12);
        for (Index i = 0; i < 4; ++i) y.segment<3>(3 * i) = place(i);
        const Matrix J = central_differences(
            [&](const Vector& moved) -> Vector {
                for (Index i = 0; i < 4; ++i) place(i) = moved.segment<3>(3 * i);
                const ContactPoint& point = roofs.evaluate();
                Vector values(1 + 3 + 3 + 9);
                values << point.gap, point.normal, point.weights, MatrixX3(point.pressing).transpose().reshaped();
                for (Index i = 0; i < 4; ++i) place(i) = y.segment<3>(3 * i);
                return values;
            },
            y, step);
        EXPECT_LT(relative_difference(variation.dg, J.topRows(1)), tolerance);
        EXPECT_LT(relative_difference(variation.dn, J.middleRows(1, 3)), tolerance);
        EXPECT_LT(relative_difference(variation.dweights, J.middleRows(4, 3)), tolerance);
        EXPECT_LT(relative_difference(variation.dpressing, J.bottomRows(9)), tolerance);
        // pressing is dg/dx over |dg/ds|
        for (Index i = 0; i < 3; ++i)
            EXPECT_LT(
                (at.pressing.row(i) - variation.dg.middleCols<3>(3 + 3 * i) / variation.dg.leftCols<3>().norm()).norm(),
                1e-14);
    }
}

TEST(EdgePassage, IsFoundWhereEdgesCrossOnTheirWay) {
    const auto roof = [](double x, double height, double down) { // ridge along y, or along x upside down
        return down > 0 ? sharp_edge({Vec3(x, -1, 0), Vec3(x, 1, 0)}, {Vec3(x + 1, 0, -1), Vec3(x - 1, 0, -1)})
                        : sharp_edge({Vec3(x - 1, 0, height), Vec3(x + 1, 0, height)},
                                     {Vec3(x, 1, height + 1), Vec3(x, -1, height + 1)});
    };
    const SharpEdge below = roof(0, 0, 1);
    const auto passage = first_passage(roof(0.2, 0.3, -1), below, roof(0.2, -0.1, -1), below);
    ASSERT_TRUE(passage);
    EXPECT_NEAR(passage->time, 0.75, 1e-12);
    EXPECT_NEAR(passage->before, 0.3, 1e-12);
    EXPECT_NEAR(passage->after, -0.1, 1e-12);
    EXPECT_FALSE(first_passage(roof(0.2, 0.3, -1), below, roof(0.2, 0.1, -1), below));  // stays above
    EXPECT_FALSE(first_passage(roof(2.2, 0.3, -1), below, roof(2.2, -0.1, -1), below)); // beside it
    EXPECT_FALSE(first_passage(roof(0.2, -0.1, -1), below, roof(0.2, 0.3, -1), below)); // comes out
    // the same from a long way off, past the other edge and back up: it ends outside
    EXPECT_FALSE(first_passage(roof(-3, 0.3, -1), below, roof(3, 0.3, -1), below));
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
