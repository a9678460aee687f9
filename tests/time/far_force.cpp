/// Contact forces on slaves that geometry finds far from the master, whatever contact says.

#include "osculate/time/far_force.hpp"

#include "support/small_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double allowed = 0.1; // of the larger facet
constexpr double round_off = 1e-12;

/// A table, facets of 0.25 m, and a block on it, facets of 0.4 m by 0.2 m, that stands out over its edge at x = 1 m. Contact is
/// evaluated where the block lies on the table, whatever the state says: as if it took the wrong facets.
class BlockOnTable : public ::testing::TestWithParam<Discretisation> {
protected:
    BlockOnTable() {
        const material::LinearElastic elastic{1e6, 0.3};
        small.add_body("table", mesh::make_block({0, 0, -1}, {1, 1, 1}, {4, 4, 1}), elastic);
        small.add_body("block", mesh::make_block({0.3, 0.3, 0}, {1.2, 0.4, 0.5}, {3, 2, 1}), elastic);
        model::SlaveNodes slaves;
        slaves.facets = small.facets(1, "z_min");
        slaves.node = small.nodes(1, "z_min");
        slaves.area.assign(slaves.node.size(), 0.08);
        slaves.stiffness.assign(slaves.node.size(), 1);
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(small.facets(0, "z_max"), model.X);
        std::shared_ptr<const contact::MasterSurface> shape = contact::make_facets_surface(*surface);
        model::MasterNodes vertices{surface->vertex_nodes()};
        model::ContactOptions options;
        options.discretisation = GetParam();
        model.pairs.push_back(std::make_unique<const model::ContactPair>(
            "on_top", model.X, std::move(slaves), std::move(surface), std::move(vertices), std::move(shape), options));
        state = small.at_rest();
        contact = model::contact_evaluations(model::pairs_of(state.contact));
        Timings timings;
        contact[0].begin_step(model.X, state.contact[0], timings, 1);
        contact[0].evaluate(model.X, timings, 1);
    }
    /// Moves the block up from where contact has seen it.
    void lift(double by) {
        const model::Body& block = model.bodies[1];
        for (Index i = 0; i < block.nodes(); ++i) state.u[block.first_node + i].z() = by;
    }
    /// Closes the slave at x and at the side y = 0.3 m, with a force.
    Index press_at(double x) {
        const std::vector<Index>& nodes = model.pairs[0]->slaves().node;
        for (std::size_t j = 0; j < nodes.size(); ++j) {
            if ((model.X[nodes[j]] - Vec3(x, 0.3, 0)).norm() > round_off) continue;
            state.contact[0].status[j] = contact::Status::stick;
            state.contact[0].lambda[j] = {3, 0, 4};
            return static_cast<Index>(j);
        }
        return -1;
    }
    [[nodiscard]] std::optional<FarForce> farthest() const { return farthest_force(model, contact, state, allowed); }

    support::SmallModel small;
    model::Model& model = small.model;
    model::State state;
    model::ContactEvaluations contact;
};

TEST_P(BlockOnTable, IsNearWhereItTouches) {
    press_at(0.3);
    press_at(0.7);
    EXPECT_FALSE(farthest());
    lift(0.02); // less than a tenth of a facet
    EXPECT_FALSE(farthest());
}

TEST_P(BlockOnTable, IsFarWhereContactIsWrongAboutIt) {
    const Index j = press_at(0.7);
    constexpr double by = 0.05, length = 0.282842712474619; // root of 0.4 m times 0.2 m, the larger facet
    lift(by);
    const auto far = farthest();
    ASSERT_TRUE(far);
    EXPECT_EQ(far->pair, 0);
    EXPECT_EQ(far->slave, j);
    EXPECT_NEAR(far->force, 5, round_off);
    EXPECT_NEAR(far->distance, by, round_off);
    EXPECT_NEAR(far->excess, by, round_off) << "both are flat";
    EXPECT_NEAR(far->length, length, round_off);
    const Index node = model.pairs[0]->slaves().node[j] - model.bodies[1].first_node;
    EXPECT_THAT(in_words(*far, *model.pairs[0], model),
                AllOf(HasSubstr("'on_top'"), HasSubstr("5 N"),
                      HasSubstr("node " + std::to_string(node) + " of body 'block'"), HasSubstr("0.05 m")));
}

TEST_P(BlockOnTable, CountsOnlyWhereThereIsAForce) {
    lift(0.5);
    EXPECT_FALSE(farthest());
    const Index j = press_at(0.7);
    ASSERT_TRUE(farthest());
    state.contact[0].lambda[j].setZero();
    EXPECT_FALSE(farthest());
}

TEST_P(BlockOnTable, GivesTheWorstOfAll) {
    press_at(0.3);
    const Index worst = press_at(1.1);
    lift(0.05);
    for (const Index node : model.pairs[0]->slaves().node)
        if (model.X[node].x() > 0.5) state.u[node].z() = 0.06;
    ASSERT_TRUE(farthest());
    EXPECT_EQ(farthest()->slave, worst);
}

TEST_P(BlockOnTable, OfAveragesItsFacetsCount) {
    press_at(1.1); // 0.1 m past the table, one of its facets above
    const bool average = averages(GetParam());
    ASSERT_EQ(farthest().has_value(), !average);
    if (!average) {
        EXPECT_NEAR(farthest()->distance, 0.1, round_off);
    }
    lift(0.05);
    ASSERT_TRUE(farthest());
    if (average) {
        EXPECT_NEAR(farthest()->excess, 0.05, round_off) << "of the facet, not of the node";
    }
    lift(0);
    press_at(1.5); // none of its facets is
    EXPECT_TRUE(farthest());
}

INSTANTIATE_TEST_SUITE_P(Discretisations, BlockOnTable,
                         ::testing::Values(Discretisation::node, Discretisation::mortar,
                                           Discretisation::petrov_galerkin));

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
