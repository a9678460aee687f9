#include "osculate/model/contact_evaluation.hpp"

#include "osculate/mesh/generators.hpp"
#include "support/differences.hpp"
#include "support/random.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

namespace osculate::model::OSCULATE_THIS_FILE {
namespace {

using osculate::support::Random;

constexpr double round_off = 1e-10; // of patch weights, condition 1e5

/// Top of the block [0, 5] x [0, 4] as master, facets of size 0.5; slave nodes float over it, after the master's nodes.
class FlatPair : public ::testing::TestWithParam<bool> {
protected:
    void SetUp() override {
        const mesh::Mesh block = mesh::make_block({0, 0, -1}, {5, 4, 1}, {10, 8, 1});
        x = block.nodes;
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(block.surfaces.at("z_max"), block.nodes);
        std::vector<Vec3> vertices;
        for (const Index node : surface->vertex_nodes()) vertices.push_back(x[node]);
        auto master =
            GetParam() ? contact::make_rpim_surface(*surface, vertices, {}) : contact::make_facets_surface(*surface);
        SlaveNodes slaves;
        for (const Vec3& s : {Vec3(1.2, 1.3, 0.1), Vec3(2.6, 2.2, -0.05), Vec3(6, 2, 0.1)}) {
            slaves.node.push_back(static_cast<Index>(x.size()));
            slaves.area.push_back(0.25);
            slaves.stiffness.push_back(3);
            x.push_back(s);
        }
        const std::vector<Index> master_nodes = surface->vertex_nodes();
        ContactOptions options;
        options.friction = 0.3;
        pair = std::make_unique<ContactPair>("pair", x, slaves, std::move(surface), MasterNodes{master_nodes},
                                             std::move(master), options);
        evaluation = std::make_unique<ContactEvaluation>(*pair);
        evaluation->begin_step(x, pair->initial_history(), timings, 1);
        evaluation->evaluate(x, timings, 1);
    }
    [[nodiscard]] Index slave(Index j) const { return pair->slaves().node[j]; }

    std::vector<Vec3> x;
    std::unique_ptr<ContactPair> pair;
    std::unique_ptr<ContactEvaluation> evaluation;
    Timings timings;
};

TEST_P(FlatPair, FindsEachSlaveOverItsFacet) {
    ASSERT_EQ(pair->size(), 3);
    EXPECT_TRUE(evaluation->point(0).found);
    EXPECT_NEAR(evaluation->point(0).gap, 0.1, round_off);
    EXPECT_NEAR(evaluation->point(1).gap, -0.05, round_off);
    EXPECT_FALSE(evaluation->point(2).found) << "beside the master";
    EXPECT_TRUE(evaluation->point_nodes(2).empty());
    EXPECT_EQ(evaluation->facet_changes(), 0);
}

TEST_P(FlatPair, NamesPatchNodesInTheOrderOfTheirWeights) {
    for (Index j = 0; j < 2; ++j) {
        Vec3 foot = Vec3::Zero();
        for (std::size_t i = 0; i < evaluation->point_nodes(j).size(); ++i)
            foot += evaluation->point(j).weights(static_cast<Index>(i)) * x[evaluation->point_nodes(j)[i]];
        EXPECT_LT((foot - evaluation->point(j).foot).norm(), round_off);
        EXPECT_EQ(evaluation->patch_nodes(evaluation->facets()[j]), evaluation->point_nodes(j));
    }
}

TEST_P(FlatPair, HasNoDriftWhenBothSidesMoveTogether) {
    for (Vec3& p : x) p += Vec3(0.3, -0.2, 0.1);
    evaluation->evaluate(x, timings, 1);
    for (Index j = 0; j < 2; ++j) EXPECT_LT(evaluation->state(j, Vec3::Zero()).drift.norm(), round_off);
}

TEST_P(FlatPair, ComesBackFromWhereIteratesRanAway) {
    const std::vector<Vec3> start = x;
    const Index facet = evaluation->facets()[0];
    for (int k = 0; k < 6; ++k) { // more often than it takes to be latched
        x[slave(0)].x() = k % 2 == 0 ? 4.2 : 2.2;
        evaluation->evaluate(x, timings, 1);
    }
    ASSERT_TRUE(evaluation->hit(0).latched);
    evaluation->evaluate(start, timings, 1);
    EXPECT_EQ(evaluation->facets()[0], facet);
    EXPECT_NEAR(evaluation->hit(0).distance, 0.1, round_off);
    EXPECT_NEAR(evaluation->point(0).gap, 0.1, round_off);
    EXPECT_LT((evaluation->point(0).foot - Vec3(1.2, 1.3, 0)).norm(), round_off);
}

TEST_P(FlatPair, MeasuresTheDriftOfTheSlaveSinceTheStepBegan) {
    const Vec3 slip(0.04, -0.03, 0.02), lambda(1, 2, 3);
    x[slave(0)] += slip;
    evaluation->evaluate(x, timings, 1);
    const contact::ContactState state = evaluation->state(0, lambda);
    EXPECT_LT((state.drift - slip).norm(), round_off);
    EXPECT_EQ(state.lambda, lambda);
    EXPECT_EQ(state.gap, evaluation->point(0).gap);
    evaluation->begin_step(x, pair->initial_history(), timings, 1);
    evaluation->evaluate(x, timings, 1);
    EXPECT_LT(evaluation->state(0, lambda).drift.norm(), round_off) << "measured anew from the next step";
}

TEST_P(FlatPair, HasTheExactVariationOfTheDrift) {
    Random random(81);
    for (Vec3& p : x) p += random.vector(0.02); // so that feet and weights move with every node
    evaluation->evaluate(x, timings, 1);
    const double step = 1e-5, tolerance = 1e-6; // round-off 1e-12 / 1e-5 and curvature 1e-10, with a margin
    for (Index j = 0; j < 2; ++j) {
        Matrix dd;
        contact::ContactVariation variation;
        evaluation->vary(j, variation);
        evaluation->drift_variation(j, variation, dd);
        std::vector<Index> touched{slave(j)};
        touched.insert(touched.end(), evaluation->point_nodes(j).begin(), evaluation->point_nodes(j).end());
        Vector y(3 * static_cast<Index>(touched.size()));
        for (std::size_t i = 0; i < touched.size(); ++i) y.segment<3>(3 * static_cast<Index>(i)) = x[touched[i]];
        const Matrix differences = osculate::support::central_differences(
            [&](const Vector& at) -> Vector {
                std::vector<Vec3> moved = x;
                for (std::size_t i = 0; i < touched.size(); ++i)
                    moved[touched[i]] = at.segment<3>(3 * static_cast<Index>(i));
                evaluation->evaluate(moved, timings, 1);
                return evaluation->state(j, Vec3::Zero()).drift;
            },
            y, step);
        EXPECT_LT(osculate::support::relative_difference(dd, differences), tolerance);
        evaluation->evaluate(x, timings, 1);
    }
}

TEST_P(FlatPair, HeldGeometryIsThatOfTheStartAndLinear) {
    Random random(82);
    for (Vec3& p : x) p += random.vector(0.02);
    evaluation->evaluate(x, timings, 1);
    const contact::ContactPoint before = evaluation->point(0);
    contact::ContactVariation variation;
    evaluation->vary(0, variation);
    evaluation->hold_geometry();
    std::vector<Vec3> moved = x;
    for (Vec3& p : moved) p += random.vector(0.3); // beyond its facet
    evaluation->evaluate(moved, timings, 1);
    const contact::ContactPoint& held = evaluation->point(0);
    EXPECT_EQ(held.normal, before.normal);
    EXPECT_EQ(held.weights, before.weights);
    double gap = before.gap + variation.dg.head<3>().dot(moved[slave(0)] - x[slave(0)]);
    for (std::size_t i = 0; i < evaluation->point_nodes(0).size(); ++i) {
        const Index node = evaluation->point_nodes(0)[i];
        gap += variation.dg.segment<3>(3 + 3 * static_cast<Index>(i)).dot(moved[node] - x[node]);
    }
    EXPECT_NEAR(held.gap, gap, round_off);
    contact::ContactVariation of_held;
    evaluation->vary(0, of_held);
    EXPECT_EQ(of_held.dg, variation.dg);
    EXPECT_EQ(of_held.dn.norm(), 0);
    EXPECT_EQ(of_held.dweights.norm(), 0);
    model::ContactEvaluation now = *evaluation; // copies follow the master again
    now.evaluate(moved, timings, 1);
    EXPECT_NE(now.point(0).normal, before.normal);
    evaluation->begin_step(moved, pair->initial_history(), timings, 1);
    EXPECT_FALSE(evaluation->holds_geometry());
}

TEST_P(FlatPair, FollowsASlidingSlaveFromFacetToFacet) {
    const Index before = evaluation->facets()[0];
    x[slave(0)].x() += 0.5;
    evaluation->evaluate(x, timings, 2);
    EXPECT_NE(evaluation->facets()[0], before);
    EXPECT_EQ(evaluation->facet_changes(), 1);
    EXPECT_NEAR(evaluation->point(0).gap, 0.1, round_off);
}

/// Runs of slightly changed scenes beside a run: on an edge between two facets, they take the same.
TEST_P(FlatPair, TakesTheFacetsOfAnotherUntilTheNextStep) {
    std::vector<Vec3> beyond = x;
    beyond[slave(0)].x() += 0.5;
    ContactEvaluation other(*pair);
    other.begin_step(beyond, pair->initial_history(), timings, 1);
    other.evaluate(beyond, timings, 1);
    ASSERT_NE(other.facets()[0], evaluation->facets()[0]);
    evaluation->take_facets(other.held_facets());
    evaluation->evaluate(x, timings, 1);
    EXPECT_EQ(evaluation->facets(), other.facets());
    EXPECT_EQ(evaluation->hit(0).facet, other.facets()[0]);
    EXPECT_EQ(evaluation->hit(0).latched, other.hit(0).latched) << "which side of a crease counts is its own";
    evaluation->begin_step(x, pair->initial_history(), timings, 1);
    evaluation->evaluate(x, timings, 1);
    EXPECT_NE(evaluation->facets()[0], other.facets()[0]);
}

/// The projection itself does not depend on the facet on a flat master, so the latch costs nothing here.
TEST_P(FlatPair, StaysOnItsFacetAfterFourChangesInOneAttempt) {
    for (int change = 0; change < 7; ++change) {
        x[slave(0)].x() = change % 2 == 0 ? 1.6 : 1.4; // on either side of an edge
        evaluation->evaluate(x, timings, 1);
        EXPECT_EQ(evaluation->facet_changes(), change < 4) << change;
    }
    evaluation->begin_step(x, pair->initial_history(), timings, 1);
    x[slave(0)].x() = 1.4;
    evaluation->evaluate(x, timings, 1);
    EXPECT_EQ(evaluation->facet_changes(), 1) << "a new attempt is free again";
}

TEST_P(FlatPair, SearchesOpenSlavesAnewAndKeepsTheFacetsOfClosedOnes) {
    ContactHistory history = pair->initial_history();
    history.facet = evaluation->facets();
    history.status[1] = contact::Status::stick;
    const Index kept = history.facet[1];
    for (Index j = 0; j < 2; ++j) x[slave(j)] += Vec3(1.5, 0, 0);
    evaluation->begin_step(x, history, timings, 1);
    EXPECT_NE(evaluation->facets()[0], history.facet[0]);
    EXPECT_EQ(evaluation->facets()[1], kept);
}

/// Positions that are rounded leave their last digits to be added to gap and drift.
TEST_P(FlatPair, AddsTheLastDigitsThatPositionsLack) {
    const Vec3 at_the_start(1e-9, 2e-9, -3e-9), now(-4e-9, 1e-9, 5e-9), together(7e-9, -8e-9, 9e-9);
    std::vector<Vec3> start(x.size(), Vec3::Zero()), tails(x.size(), together);
    start[slave(0)] = at_the_start;
    tails[slave(0)] = together + now;
    evaluation->begin_step(x, pair->initial_history(), timings, 1, start);
    evaluation->evaluate(x, timings, 1, tails);
    const contact::ContactState state = evaluation->state(0, Vec3::Zero());
    const double last_digit = 1e-15; // of positions, m
    EXPECT_NEAR(state.gap - evaluation->point(0).gap, now.z(), last_digit);
    EXPECT_LT((state.drift - (now - at_the_start)).norm(), 10 * last_digit);
    evaluation->begin_step(x, pair->initial_history(), timings, 1);
    evaluation->evaluate(x, timings, 1);
    EXPECT_EQ(evaluation->state(0, Vec3::Zero()).gap, evaluation->point(0).gap) << "whatever was before";
}

TEST_P(FlatPair, HasEvaluationsThatKnowNothingOfOneAnother) {
    const ContactEvaluation copy = *evaluation;
    ContactEvaluation other(*pair);
    std::vector<Vec3> elsewhere = x;
    for (Index j = 0; j < 2; ++j) elsewhere[slave(j)] += Vec3(0.7, -0.4, 0.3);
    other.begin_step(elsewhere, pair->initial_history(), timings, 1);
    other.evaluate(elsewhere, timings, 1);
    for (Index j = 0; j < 2; ++j) {
        EXPECT_EQ(evaluation->point(j).gap, copy.point(j).gap);
        EXPECT_NE(other.point(j).gap, copy.point(j).gap);
    }
    evaluation->evaluate(elsewhere, timings, 1);
    other.begin_step(x, pair->initial_history(), timings, 1);
    other.evaluate(x, timings, 1);
    for (Index j = 0; j < 2; ++j) { // to the bit
        EXPECT_EQ(other.point(j).gap, copy.point(j).gap);
        EXPECT_EQ(other.point(j).weights, copy.point(j).weights);
        EXPECT_EQ(other.point_nodes(j), copy.point_nodes(j));
        EXPECT_NE(evaluation->point(j).gap, copy.point(j).gap);
        EXPECT_EQ(copy.drift(j), Vec3(Vec3::Zero()));
        EXPECT_FALSE(evaluation->drift(j).isZero(0));
    }
}

/// Patches that were fitted anew belong to a state, not to the pair: a step that is taken back has the surface it had.
TEST_P(FlatPair, TakesTheMasterSurfaceOfTheState) {
    std::vector<Vec3> vertices;
    for (const Index node : pair->master_nodes()) vertices.push_back(x[node]);
    ContactHistory history = pair->initial_history();
    EXPECT_EQ(history.master, pair->master());
    const auto before = evaluation->point_nodes(0);
    history.master = GetParam() ? contact::make_facets_surface(pair->surface())
                                : contact::make_rpim_surface(pair->surface(), vertices, {});
    evaluation->begin_step(x, history, timings, 1);
    evaluation->evaluate(x, timings, 1);
    EXPECT_EQ(evaluation->master(), history.master);
    EXPECT_NE(evaluation->point_nodes(0), before);
    EXPECT_NEAR(evaluation->point(0).gap, 0.1, round_off);
    evaluation->begin_step(x, pair->initial_history(), timings, 1);
    evaluation->evaluate(x, timings, 1);
    EXPECT_EQ(evaluation->point_nodes(0), before);
}

INSTANTIATE_TEST_SUITE_P(Of, FlatPair, ::testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Rpim" : "Facets"; });

TEST_P(FlatPair, LetsHeldSlavesStickElastically) {
    const Vec3 lambda_start(0.3, -0.2, 2), drift(0.01, 0.02, 0);
    ContactHistory history = pair->initial_history();
    history.lambda[1] = lambda_start;
    evaluation->begin_step(x, history, timings, 1);
    evaluation->hold({0, 1, 0});
    const contact::ContactState moved{lambda_start, 0, Vec3::UnitZ(), drift};
    const Vec3 exact = evaluation->law(0, lambda_start).residual(moved, contact::Status::stick).value;
    const Vec3 spring = evaluation->law(1, lambda_start).residual(moved, contact::Status::stick).value;
    EXPECT_LT((exact - evaluation->stiffness(0, lambda_start) * drift).norm(), round_off) << "no drift at all";
    EXPECT_LT((spring - 100 * evaluation->stiffness(1, lambda_start) * drift).norm(), round_off)
        << "from the force at the start";
    const contact::ContactState loaded{Vec3(1, 1, 2), 0, Vec3::UnitZ(), Vec3::Zero()};
    EXPECT_LT(evaluation->law(0, lambda_start).residual(loaded, contact::Status::stick).value.norm(), round_off)
        << "whatever its force";
    EXPECT_GT(evaluation->law(1, lambda_start).residual(loaded, contact::Status::stick).value.norm(), 1)
        << "no drift, no other force";
}

/// Motions that leave no doubt about the side of a node are small against facets and against what lies behind them.
TEST(Thinness, OfAFacetIsThatOfItsThinnestVertex) {
    const mesh::Mesh block = mesh::make_block({0, 0, -1}, {3, 3, 1}, {3, 3, 1});
    std::vector<Vec3> x = block.nodes;
    auto surface = std::make_unique<mesh::HalfEdgeSurface>(block.surfaces.at("z_max"), block.nodes);
    const Index vertices = surface->vertex_count(), slave = static_cast<Index>(x.size());
    x.emplace_back(1, 1, 1);
    for (const bool thin : {true, false}) {
        MasterNodes nodes{surface->vertex_nodes()};
        nodes.thickness.assign(static_cast<std::size_t>(vertices), 2.0);
        if (thin) nodes.thickness[0] = 0.1;
        auto master = contact::make_facets_surface(*surface);
        const ContactPair pair("pair", x, SlaveNodes{{slave}, {1}, {1}, {}},
                               std::make_unique<mesh::HalfEdgeSurface>(*surface), std::move(nodes), std::move(master),
                               {});
        EXPECT_NEAR(pair.finest(), thin ? 0.1 : 1, round_off);
        for (Index f = 0; f < surface->facet_count(); ++f) {
            const auto v = surface->facet_vertices(f);
            EXPECT_EQ(pair.thickness(f), thin && std::ranges::count(v, 0) > 0 ? 0.1 : 2);
        }
    }
}

/// A slave facet that stands upright over the master overlaps none of it; one that lies over it is seen by its averages.
TEST(UnseenGaps, AreThoseOfSlaveNodesWhoseFacetsOverlapNothing) {
    for (const bool upright : {false, true}) {
        const mesh::Mesh block = mesh::make_block({0, 0, -1}, {5, 4, 1}, {5, 4, 1});
        std::vector<Vec3> x = block.nodes;
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(block.surfaces.at("z_max"), block.nodes);
        MasterNodes nodes{surface->vertex_nodes()};
        auto master = contact::make_facets_surface(*surface);
        SlaveNodes slaves;
        for (const Vec3& s : {Vec3(1.2, 1.1, 0.1), Vec3(1.2, 2.1, 0.1), Vec3(2.2, 2.1, 0.2), Vec3(2.2, 1.1, 0.2)}) {
            slaves.node.push_back(static_cast<Index>(x.size()));
            x.push_back(s);
            if (upright) x.back().x() = 1.2;
        }
        slaves.area = slaves.stiffness = {1, 1, 1, 1};
        slaves.facets.push_back({{slaves.node[0], slaves.node[1], slaves.node[2], slaves.node[3]}, 4});
        ContactOptions options;
        options.discretisation = Discretisation::mortar;
        const ContactPair pair("pair", x, slaves, std::move(surface), std::move(nodes), std::move(master), options);
        ContactEvaluation evaluation(pair);
        Timings timings;
        evaluation.begin_step(x, pair.initial_history(), timings, 1);
        evaluation.evaluate(x, timings, 1);
        for (Index j = 0; j < 4; ++j) {
            EXPECT_EQ(evaluation.point(j).found, !upright);
            if (upright)
                EXPECT_NEAR(evaluation.unseen_gap(j), x[pair.slaves().node[j]].z(), round_off);
            else
                EXPECT_EQ(evaluation.unseen_gap(j), std::numeric_limits<double>::infinity());
        }
    }
}

/// A slave beyond the edge between two faces of a block, where it sees the face that it is farther from; its closest facet
/// stays the same.
class CreasePair : public ::testing::Test {
protected:
    void SetUp() override {
        const mesh::Mesh block = mesh::make_block({0, 0, -2}, {2, 2, 2}, {2, 2, 2});
        x = block.nodes;
        std::vector<mesh::Facet> facets = block.surfaces.at("z_max");
        for (const mesh::Facet& facet : block.surfaces.at("x_max")) facets.push_back(facet);
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(facets, block.nodes);
        std::vector<Vec3> vertices;
        for (const Index node : surface->vertex_nodes()) vertices.push_back(x[node]);
        MasterNodes nodes{surface->vertex_nodes()};
        auto master = contact::make_blend_surface(*surface, vertices, {});
        slave = static_cast<Index>(x.size());
        x.emplace_back(2.1, 0.6, 0.1);
        ContactOptions options;
        options.changes_before_latch = 2;
        pair = std::make_unique<ContactPair>("pair", x, SlaveNodes{{slave}, {0.25}, {3}, {}}, std::move(surface),
                                             std::move(nodes), std::move(master), options);
        evaluation = std::make_unique<ContactEvaluation>(*pair);
    }
    /// The facet that is seen from above the edge, or from beside it.
    Index seen_from(bool above) {
        x[slave] = {above ? 2.1 : 2.2, 0.6, above ? 0.2 : 0.1};
        evaluation->evaluate(x, timings, 1);
        EXPECT_TRUE(evaluation->point(0).found);
        return evaluation->point(0).side;
    }

    std::vector<Vec3> x;
    Index slave = 0;
    std::unique_ptr<ContactPair> pair;
    std::unique_ptr<ContactEvaluation> evaluation;
    Timings timings;
};

TEST_F(CreasePair, LatchesASlaveThatSeesNowOneSideNowTheOther) {
    evaluation->begin_step(x, pair->initial_history(), timings, 1);
    const Index above = seen_from(true), beside = seen_from(false);
    EXPECT_NE(above, beside);
    EXPECT_FALSE(evaluation->hit(0).latched) << "one change of side";
    seen_from(true);
    EXPECT_EQ(seen_from(false), above) << "two: it stays";
    EXPECT_TRUE(evaluation->hit(0).latched);
}

/// A rejected attempt leaves no trace: the next one is free to see another side at first.
TEST_F(CreasePair, ForgetsTheSideOfTheAttemptBefore) {
    evaluation->begin_step(x, pair->initial_history(), timings, 1);
    const Index above = seen_from(true);
    evaluation->begin_step(x, pair->initial_history(), timings, 1);
    EXPECT_NE(seen_from(false), above);
    seen_from(true);
    seen_from(true);
    EXPECT_FALSE(evaluation->hit(0).latched) << "one change of side in this attempt";
}

} // namespace
} // namespace osculate::model::OSCULATE_THIS_FILE
