/// Edges that cross edges, in an attempt at a step.

#include "osculate/model/contact_evaluation.hpp"

#include <gtest/gtest.h>

namespace osculate::model::OSCULATE_THIS_FILE {
namespace {

/// A roof with its ridge along y from (0, -1, 0) to (0, 1, 0), and one upside down with its ridge along x from (0.1, 0.1, height):
/// it ends beside the other.
struct Roofs {
    std::vector<Vec3> x;
    std::unique_ptr<ContactPair> pair;
    std::unique_ptr<ContactEvaluation> evaluation;
    Timings timings;

    explicit Roofs(double height)
        : x{{0, -1, 0},
            {0, 1, 0},
            {1, -1, -1},
            {1, 1, -1},
            {-1, -1, -1},
            {-1, 1, -1},
            {0.1, 0.1, height},
            {1.1, 0.1, height},
            {0.1, 1.1, height + 1},
            {1.1, 1.1, height + 1},
            {0.1, -0.9, height + 1},
            {1.1, -0.9, height + 1}} {
        mesh::Facet right, left;
        right.count = left.count = 4;
        right.nodes = {0, 2, 3, 1};
        left.nodes = {0, 1, 5, 4};
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(std::vector{right, left}, x);
        Index ridge = 0;
        while (!surface->is_feature_edge(ridge)) ++ridge;
        SlaveNodes slaves;
        slaves.node = {6, 7};
        slaves.area = {0, 0};
        slaves.stiffness = {1, 1};
        CrossingEdges& edges = slaves.edges.emplace();
        edges.others = {8, 9, 10, 11};
        for (const Index end : {1, 0}) {
            edges.half_edges.push_back({0, ridge});
            contact::EdgesThatMeet& one = edges.meet.emplace_back();
            one.end = end;
            one.reverse = end;
            one.half_edge = ridge;
            one.wings = {{{0, 1, 3, 2}, {0, 1, 5, 4}}};
        }
        const std::vector<Index> master_nodes = surface->vertex_nodes();
        auto master = contact::make_facets_surface(*surface);
        pair = std::make_unique<ContactPair>("edges", x, std::move(slaves), std::move(surface),
                                             MasterNodes{master_nodes}, std::move(master), ContactOptions{});
        evaluation = std::make_unique<ContactEvaluation>(*pair);
        evaluation->begin_step(x, pair->initial_history(), timings, 1);
    }
    void move_slave(const Vec3& by) {
        for (std::size_t node = 6; node < x.size(); ++node) x[node] += by;
        evaluation->evaluate(x, timings, 1);
    }
    [[nodiscard]] double gap() const { return evaluation->state(0, Vec3::Zero()).gap; }
};

TEST(CrossingEdges, ThatWereDeepBesideOneAnotherAreNotPushedOutAtOnce) {
    constexpr double round_off = 1e-14;
    Roofs roofs(-0.01);
    roofs.evaluation->keep_depths(0.9, roofs.x, roofs.timings, 1);
    ASSERT_FALSE(roofs.evaluation->point(0).found);
    roofs.move_slave({-0.2, 0, 0});
    ASSERT_TRUE(roofs.evaluation->point(0).found);
    EXPECT_NEAR(roofs.evaluation->point(0).gap, -0.01, round_off);
    EXPECT_NEAR(roofs.gap(), -0.001, round_off);
}

TEST(CrossingEdges, ThatWereApartKeepNoDepth) {
    constexpr double round_off = 1e-14;
    Roofs roofs(0.01);
    roofs.evaluation->keep_depths(0.9, roofs.x, roofs.timings, 1);
    roofs.move_slave({-0.2, 0, -0.03});
    ASSERT_TRUE(roofs.evaluation->point(0).found);
    EXPECT_NEAR(roofs.gap(), -0.02, round_off);
}

} // namespace
} // namespace osculate::model::OSCULATE_THIS_FILE
