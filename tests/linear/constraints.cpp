#include "osculate/linear/constraints.hpp"

#include "support/random.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdexcept>

namespace osculate::linear::OSCULATE_THIS_FILE {
namespace {

using osculate::support::Random;

constexpr double round_off = 1e-14;

NodeConstraint hold(Index node, const Vec3& direction, double target = 0) {
    NodeConstraint c;
    c.node = node;
    c.direction = direction;
    c.target = target;
    c.driven = target != 0;
    return c;
}

const Vec3 slant(0.6, 0, 0.8), across(-0.8, 0, 0.6);

/// Node 0 free, 1 held along y, 2 fixed, 3 held along one slant direction, 4 along two, 5 along three.
std::vector<NodeConstraint> some_of_everything() {
    return {hold(4, slant, 0.3),    hold(1, Vec3::UnitY(), 0.1),
            hold(2, Vec3::UnitZ()), hold(2, Vec3::UnitX()),
            hold(2, Vec3::UnitY()), hold(3, slant),
            hold(4, Vec3::UnitY()), hold(5, slant),
            hold(5, across),        hold(5, Vec3::UnitY(), -0.2)};
}

TEST(Constraints, NumberTheFreeComponentsInOrderOfNodes) {
    const Constraints constraints(6, some_of_everything());
    EXPECT_EQ(constraints.nodes(), 6);
    const int expected[] = {3, 2, 0, 2, 1, 0};
    Index next = 0;
    for (Index node = 0; node < 6; ++node) {
        EXPECT_EQ(constraints.free_components(node), expected[node]) << node;
        for (int k = 0; k < 3; ++k)
            if (constraints.equation(node, k) != Constraints::held) {
                EXPECT_EQ(constraints.equation(node, k), next++);
            }
    }
    EXPECT_EQ(constraints.equations(), next);
}

TEST(Constraints, HoldNothingWhenNoneAreGiven) {
    const Constraints constraints(4, {});
    EXPECT_EQ(constraints.equations(), 12);
    EXPECT_EQ(constraints.constraint(2, 1), nullptr);
    EXPECT_EQ(constraints.reaction(2, Vec3(1, 2, 3)), Vec3::Zero());
}

TEST(Constraints, HaveOrthonormalFramesWithTheHeldDirectionsAsAxes) {
    const auto given = some_of_everything();
    const Constraints constraints(6, given);
    for (Index node = 0; node < 6; ++node) {
        const Mat3& Q = constraints.frame(node);
        EXPECT_LT((Q.transpose() * Q - Mat3::Identity()).norm(), round_off);
        EXPECT_EQ(constraints.turned(node), node >= 3) << node;
        if (!constraints.turned(node)) {
            EXPECT_EQ(Q, Mat3::Identity());
        }
        for (int k = 0; k < 3; ++k) {
            const NodeConstraint* c = constraints.constraint(node, k);
            EXPECT_EQ(c != nullptr, constraints.equation(node, k) == Constraints::held);
            if (c == nullptr) continue;
            EXPECT_EQ(c->node, node);
            EXPECT_LT((Q.col(k) - c->direction).norm(), round_off);
        }
    }
    int found = 0; // every constraint is an axis of its node, with its value
    for (const NodeConstraint& g : given)
        for (int k = 0; k < 3; ++k) {
            const NodeConstraint* c = constraints.constraint(g.node, k);
            if (c && c->direction.dot(g.direction) > 0.5) found += c->target == g.target && c->driven == g.driven;
        }
    EXPECT_EQ(found, static_cast<int>(given.size()));
}

TEST(Constraints, TurnAnOppositeDirectionWithItsValue) {
    const Constraints constraints(1, {hold(0, -Vec3::UnitY(), 0.25)});
    EXPECT_FALSE(constraints.turned(0));
    ASSERT_NE(constraints.constraint(0, 1), nullptr);
    EXPECT_EQ(constraints.constraint(0, 1)->direction, Vec3::UnitY());
    EXPECT_EQ(constraints.constraint(0, 1)->target, -0.25);
}

TEST(Constraints, MergeRepetitions) {
    NodeConstraint symmetric = hold(0, -slant, -0.25);
    symmetric.symmetry = true;
    const Constraints constraints(
        2, {hold(0, slant, 0.25), symmetric, hold(0, slant, 0.25), hold(1, Vec3::UnitX()), hold(1, -Vec3::UnitX())});
    EXPECT_EQ(constraints.free_components(0), 2);
    EXPECT_EQ(constraints.free_components(1), 2);
    EXPECT_EQ(constraints.constraint(0, 0)->target, 0.25);
    EXPECT_TRUE(constraints.constraint(0, 0)->symmetry) << "one of them carries no contact force";
}

void expect_contradiction(const std::vector<NodeConstraint>& given) {
    try {
        const Constraints constraints(10, given);
        FAIL() << "nothing thrown";
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), ::testing::HasSubstr("node 7"));
    }
}

TEST(Constraints, ThrowOnTwoValuesAlongOneDirection) {
    expect_contradiction({hold(7, slant, 0.1), hold(7, slant, 0.2)});
    expect_contradiction({hold(7, slant, 0.1), hold(7, -slant, 0.1)});
    expect_contradiction({hold(7, Vec3::UnitX()), hold(3, Vec3::UnitX(), 1), hold(7, Vec3::UnitX(), 1e-6)});
    expect_contradiction({hold(7, slant, 1e-13), hold(7, slant, 2e-13)}); // of a body small enough
}

TEST(Constraints, ThrowOnObliqueDirections) {
    expect_contradiction({hold(7, slant), hold(7, Vec3::UnitX())});
    expect_contradiction({hold(7, Vec3::UnitY()), hold(7, slant), hold(7, Vec3(1, 1, 0).normalized())});
}

TEST(Constraints, ScatterWhatTheyGather) {
    const Constraints constraints(6, some_of_everything());
    Random random(51);
    Vector unknowns(constraints.equations());
    for (double& v : unknowns) v = random.uniform();
    Field prescribed(6), u(6);
    for (Vec3& v : prescribed) v = random.vector();
    constraints.scatter(unknowns, prescribed, u);
    Vector back = Vector::Zero(unknowns.size());
    constraints.gather(u, back);
    EXPECT_LT((back - unknowns).cwiseAbs().maxCoeff(), round_off);
    for (Index node = 0; node < 6; ++node)
        for (int k = 0; k < 3; ++k)
            if (const NodeConstraint* c = constraints.constraint(node, k)) {
                EXPECT_NEAR(c->direction.dot(u[node]), prescribed[node](k), round_off);
            }
}

TEST(Constraints, TurnVectorsThereAndBack) {
    const Constraints constraints(6, some_of_everything());
    const Vec3 v(1, -2, 0.5);
    for (Index node = 0; node < 6; ++node) {
        const Vec3 local = constraints.to_local(node, v);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(local(k), constraints.frame(node).col(k).dot(v), round_off);
        EXPECT_LT((constraints.to_global(node, local) - v).norm(), round_off);
    }
}

TEST(Constraints, CarryReactionsAlongHeldDirectionsOnly) {
    const auto given = some_of_everything();
    const Constraints constraints(6, given);
    const Vec3 v(1, -2, 0.5);
    for (Index node = 0; node < 6; ++node) {
        Vec3 expected = Vec3::Zero();
        for (const NodeConstraint& c : given)
            if (c.node == node) expected += c.direction * c.direction.dot(v);
        EXPECT_LT((constraints.reaction(node, v) - expected).norm(), round_off) << node;
    }
}

} // namespace
} // namespace osculate::linear::OSCULATE_THIS_FILE
