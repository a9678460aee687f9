#include "osculate/output/contact_resultants.hpp"
#include "osculate/output/history.hpp"
#include "output/temporary_folder.hpp"
#include "output/two_blocks.hpp"

#include <gmock/gmock.h>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

TEST(ContactResultants, SumClosedNodesOnly) {
    const TwoBlocks blocks;
    const ContactResultants sum = contact_resultants(blocks.snapshot(), 0);
    EXPECT_EQ(sum.force, 4 * TwoBlocks::force);
    EXPECT_DOUBLE_EQ(sum.normal, 400);
    EXPECT_DOUBLE_EQ(sum.friction, 120);
    EXPECT_DOUBLE_EQ(sum.area, 1);
    EXPECT_EQ(sum.open, 2);
    EXPECT_EQ(sum.stick, 2);
    EXPECT_EQ(sum.slip, 2);
    EXPECT_NEAR(sum.penetration, 0.01, 1e-15);
    // the forces attack at the moved nodes: their middle is (1.02, 0.5, 0.99)
    EXPECT_NEAR((sum.moment - Vec3(1.02, 0.5, 0.99).cross(4 * TwoBlocks::force)).norm(), 0, 1e-10);
}

TEST(ContactResultants, MomentIsAboutTheOriginOfTheScene) {
    TwoBlocks blocks;
    blocks.model.origin = {100, -50, 20};
    const Vec3 middle = blocks.model.origin + Vec3(1.02, 0.5, 0.99), moment = middle.cross(4 * TwoBlocks::force);
    constexpr double round_off = 1e-15; // relative, of sums of a few terms
    EXPECT_LT((contact_resultants(blocks.snapshot(), 0).moment - moment).norm(), 10 * round_off * moment.norm());
}

TEST(ContactResultants, PenetrationOfAnOpenPairIsNotNegative) {
    TwoBlocks blocks;
    Timings unused;
    std::vector<Vec3> x = blocks.model.X;
    for (Index i = 12; i < 24; ++i) x[i].z() += 0.3;
    blocks.contact[0].evaluate(x, unused, 1);
    EXPECT_EQ(contact_resultants(blocks.snapshot(), 0).penetration, 0);
}

TEST(ContactResultants, PenetrationIsThatOfNodesBehindTheSurfaceAsWell) {
    TwoBlocks blocks;
    Timings unused;
    constexpr double depth = 2.1; // in facets of 1 m
    std::vector<Vec3> x = blocks.model.X;
    for (Index i = 12; i < 24; ++i) x[i].z() -= depth;
    model::ContactEvaluation& evaluation = blocks.contact[0];
    evaluation.evaluate(x, unused, 1);
    bool behind = false;
    for (Index j = 0; j < evaluation.pair().size(); ++j)
        behind = behind || (evaluation.point(j).behind && !evaluation.point(j).found);
    ASSERT_TRUE(behind);
    EXPECT_NEAR(contact_resultants(blocks.snapshot(), 0).penetration, depth, 1e-14);
}

class HistoryFile : public InTemporaryFolder {};

TEST_F(HistoryFile, CountsEveryHeldDirectionForOneSet) {
    TwoBlocks blocks;
    blocks.contact.clear();
    blocks.model.pairs.clear();
    blocks.model.sets = {{"bed", 0, {0, 1}, {}}, {"side", 0, {1, 2}, {}}, {"free", 0, {3}, {}}};
    const Vec3 skew = Vec3(3, 4, 0) / 5;
    // node 1 belongs to both: x is the bed's, and asked for by the side once more; y is the side's
    const linear::Constraints constraints(blocks.model.nodes(), {{0, skew, 0, false, false, 0},
                                                                 {1, Vec3::UnitX(), 0, false, false, 0},
                                                                 {1, -Vec3::UnitX(), 0, false, false, 1},
                                                                 {1, Vec3::UnitY(), 0, false, false, 1},
                                                                 {2, Vec3::UnitZ(), 0, true, false, 1}});
    const std::vector<Vec3> unbalanced(blocks.model.X.size(), Vec3(5, 10, 20));
    const std::vector<Vec3> reactions = nodal_reactions(constraints, unbalanced);
    EXPECT_NEAR((reactions[0] - 11 * skew).norm(), 0, 1e-13);
    EXPECT_EQ(reactions[1], Vec3(5, 10, 0));
    EXPECT_EQ(reactions[3], Vec3(0, 0, 0)) << "round-off of free nodes is no reaction";
    {
        History history(folder / "history.csv", blocks.model, true, {0, 1}, false);
        history.row({blocks.model, blocks.state, blocks.contact, reactions}, constraints, 0.5, 3, nullptr);
        // bed: 11 (0.6, 0.8, 0) + (5, 0, 0); side: (0, 10, 0) + (0, 0, 20)
        EXPECT_EQ(content(folder / "history.csv"),
                  "time,dt,iterations,set.bed.reaction_x,set.bed.reaction_y,set.bed.reaction_z,set.side.reaction_x,"
                  "set.side.reaction_y,set.side.reaction_z\n2.5,0.5,3,11.6,8.8,0,0,10,20\n")
            << "readable while the run goes on";
    }
}

TEST(History, AngularMomentumIsAboutTheOriginOfTheScene) {
    TwoBlocks blocks;
    blocks.model.origin = {100, -50, 20};
    const linear::Constraints none(blocks.model.nodes(), {});
    time::Ledger ledger;
    ledger.linear = {3, 5, 7};
    ledger.angular = {1, 2, 4};
    const std::vector<std::string> columns = History::columns(blocks.model, false, {}, true);
    const std::vector<Cell> cells = History::cells(blocks.snapshot(), none, 1, 1, false, {}, true, &ledger);
    ASSERT_EQ(cells.size(), columns.size());
    // (100, -50, 20) x (3, 5, 7) = (-450, -640, 650)
    const Vec3 linear(3, 5, 7), angular(-449, -638, 654);
    for (int k = 0; k < 3; ++k) {
        const std::size_t from = columns.size() - 6 + static_cast<std::size_t>(k);
        EXPECT_EQ(columns[from], std::string("momentum.linear_") + "xyz"[k]);
        EXPECT_EQ(std::get<double>(cells[from]), linear(k));
        EXPECT_EQ(columns[from + 3], std::string("momentum.angular_") + "xyz"[k]);
        EXPECT_EQ(std::get<double>(cells[from + 3]), angular(k));
    }
}

TEST_F(HistoryFile, LeavesOutWhatIsNotAskedFor) {
    const TwoBlocks blocks;
    const History nothing(folder / "history.csv", blocks.model, false, {}, false);
    EXPECT_EQ(content(folder / "history.csv"), "time,dt,iterations\n");
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
