#include "osculate/core/error.hpp"
#include "osculate/output/fields.hpp"
#include "osculate/output/nodal_contact.hpp"
#include "output/two_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <set>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-12;

std::vector<double> values(FieldPlace where, const std::string& name, const Snapshot& snapshot, Index part) {
    return evaluate(field(where, name), snapshot, part).values;
}

Vec3 vector_at(const std::vector<double>& values, Index i) {
    return Eigen::Map<const Vec3>(values.data() + 3 * i);
}

/// Nodes at the end of the cap, on the edge between its underside and its end: friction pulls them off the end, or presses on it.
TEST(ContactPressure, OfANodeOnAnEdgeIsOnTheFaceThatContactPressesOn) {
    for (const double friction : {-30.0, 30.0, 1e-12}) {
        TwoBlocks blocks;
        for (Vec3& lambda : blocks.state.contact[0].lambda)
            if (lambda.z() > 0) lambda.x() = friction;
        const NodalContact contact = nodal_contact(blocks.model, blocks.state, blocks.contact);
        const model::ContactPair& pair = *blocks.model.pairs[0];
        for (Index j = 0; j < pair.size(); ++j) {
            const double x = blocks.slave_X(j).x(), area = x < 1 ? 0.125 : 0.25; // of the underside
            EXPECT_NEAR(contact[static_cast<std::size_t>(pair.slaves().node[j])].pressure, x > 2 ? 0 : 100 / area, 1e-9)
                << friction;
        }
    }
}

TEST(Fields, AreNamedOncePerPlace) {
    std::set<std::pair<FieldPlace, std::string>> names;
    for (const OutputField& f : all_fields()) EXPECT_TRUE(names.insert({f.where, f.name}).second) << f.name;
    EXPECT_THROW((void)field(FieldPlace::body, "gap"), InternalError);
}

TEST(Fields, FitThePointsOfTheirPlace) {
    const TwoBlocks blocks;
    const Snapshot snapshot = blocks.snapshot();
    for (const OutputField& f : all_fields()) {
        const std::size_t points = f.where == FieldPlace::body ? 12 : 6;
        EXPECT_EQ(f.values(snapshot, 0).size(), points * static_cast<std::size_t>(f.components)) << f.name;
    }
}

TEST(Fields, BodyFieldsAreThoseOfTheirBody) {
    const TwoBlocks blocks;
    std::vector<Vec3> reactions(blocks.model.X.size(), Vec3::Zero());
    reactions[12] = {1, 2, 3}; // the cap's first node
    std::vector<Vec3> rest(blocks.model.X.size(), Vec3::Zero());
    rest[13] = {4, 5, 6};
    const Snapshot snapshot(blocks.model, blocks.state, blocks.contact, reactions, rest);
    EXPECT_EQ(vector_at(values(FieldPlace::body, "displacement", snapshot, 0), 0), Vec3(0, 0, 0));
    EXPECT_EQ(vector_at(values(FieldPlace::body, "displacement", snapshot, 1), 0), TwoBlocks::shift);
    EXPECT_EQ(vector_at(values(FieldPlace::body, "reaction", snapshot, 1), 0), Vec3(1, 2, 3));
    EXPECT_EQ(vector_at(values(FieldPlace::body, "out_of_balance", snapshot, 1), 1), Vec3(4, 5, 6));
    EXPECT_EQ(vector_at(values(FieldPlace::body, "out_of_balance", blocks.snapshot(), 1), 1), Vec3(0, 0, 0));
}

TEST(Fields, StressAndVonMisesOfStretchAndShear) {
    TwoBlocks blocks;
    const double eps = 1e-3, gamma = 2e-3; // nu = 0: s_xx = E eps, s_yz = E gamma / 2
    for (Index i = 0; i < 12; ++i) {
        const Vec3& X = blocks.model.X[i];
        blocks.state.u[i] = {eps * X.x(), gamma * X.z(), 0};
    }
    const Snapshot snapshot = blocks.snapshot();
    const std::vector<double> stress = values(FieldPlace::body, "stress", snapshot, 0);
    const std::vector<double> von_mises = values(FieldPlace::body, "von_mises", snapshot, 0);
    const double s = TwoBlocks::E * eps, t = TwoBlocks::E * gamma / 2;
    for (std::size_t i = 0; i < 12; ++i) {
        const double expected[] = {s, 0, 0, 0, t, 0};
        for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(stress[6 * i + c], expected[c], 1e-9 * s);
        EXPECT_NEAR(von_mises[i], std::sqrt(s * s + 3 * t * t), 1e-9 * s);
    }
}

TEST(Fields, SlaveFieldsSayHowEachNodeTouches) {
    const TwoBlocks blocks;
    const Snapshot snapshot = blocks.snapshot();
    const auto get = [&](const char* name) { return values(FieldPlace::slave, name, snapshot, 0); };
    const auto gap = get("gap"), stress = get("normal_stress"), status = get("status"), slip = get("slip"),
               normal = get("normal"), force = get("contact_force");
    for (Index j = 0; j < 6; ++j) {
        const double x = blocks.slave_X(j).x();
        const auto k = static_cast<std::size_t>(j);
        if (x > 2) { // hangs over: no partner
            EXPECT_TRUE(std::isnan(gap[k]));
            EXPECT_EQ(status[k], 0);
            EXPECT_EQ(stress[k], 0);
            EXPECT_EQ(vector_at(slip, j), Vec3(0, 0, 0));
            EXPECT_EQ(vector_at(normal, j), Vec3(0, 0, 0));
            continue;
        }
        EXPECT_NEAR(gap[k], -0.01, round_off);
        EXPECT_EQ(status[k], x < 1 ? 1 : 2);
        EXPECT_NEAR(stress[k], 100 / 0.25, 1e-9);
        EXPECT_NEAR((vector_at(slip, j) - Vec3(0.02, 0, 0)).norm(), 0, round_off) << "only the tangential part";
        EXPECT_NEAR((vector_at(normal, j) - Vec3(0, 0, 1)).norm(), 0, round_off);
        EXPECT_EQ(vector_at(force, j), TwoBlocks::force);
    }
}

TEST(Fields, GlidingIsShownAsSlip) {
    TwoBlocks blocks;
    for (contact::Status& s : blocks.state.contact[0].status) s = contact::Status::glide;
    EXPECT_THAT(values(FieldPlace::slave, "status", blocks.snapshot(), 0), testing::Each(2));
}

TEST(Fields, MasterForcesAnswerTheSlaves) {
    const TwoBlocks blocks;
    const Snapshot snapshot = blocks.snapshot();
    const model::ContactPair& pair = *blocks.model.pairs[0];
    const std::vector<double> master = values(FieldPlace::master, "contact_force", snapshot, 0);
    Vec3 force = 4 * TwoBlocks::force, moment = Vec3::Zero();
    for (Index j = 0; j < 6; ++j) // at the foot, where master and slave meet
        if (const contact::ContactPoint& point = blocks.contact[0].point(j); point.found)
            moment += point.foot.cross(blocks.state.contact[0].lambda[j]);
    for (std::size_t i = 0; i < pair.master_nodes().size(); ++i) {
        const Vec3 f = vector_at(master, static_cast<Index>(i));
        force += f;
        moment += blocks.model.X[pair.master_nodes()[i]].cross(f);
    }
    EXPECT_NEAR(force.norm(), 0, 1e-10);
    EXPECT_NEAR(moment.norm(), 0, 1e-10);
}

TEST(Fields, StressOnTheMasterIsItsForceOverTheAreaAroundAVertex) {
    const TwoBlocks blocks; // the base's top: two squares of 1 m in a row, at z = 1
    const Snapshot snapshot = blocks.snapshot();
    const std::vector<double> force = values(FieldPlace::master, "contact_force", snapshot, 0),
                              stress = values(FieldPlace::master, "normal_stress", snapshot, 0);
    const std::vector<Index>& vertices = blocks.model.pairs[0]->master_nodes();
    ASSERT_EQ(stress.size(), vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const double area = blocks.model.X[vertices[i]].x() == 1 ? 0.5 : 0.25;
        EXPECT_NEAR(stress[i], -force[3 * i + 2] / area, 1e-10) << i;
    }
    EXPECT_GT(*std::ranges::max_element(stress), 100) << "pressed";
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
