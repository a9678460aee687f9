#include "osculate/linear/condensed_tangent.hpp"

#include "equilibrium/press.hpp"

#include <gtest/gtest.h>
#include <utility>

namespace osculate::equilibrium {
namespace {

using contact::Status;
using testing::Press;

/// Bodies that lean on springs while their inverses are made do not lean on them in what is solved: nothing has to be
/// solved by other means.
TEST(CondensedTangent, SolvesForABodyThatContactAloneHolds) {
    Press press(linear::LinearSolver::condensed);
    double rear = 0;
    for (const Status status : {Status::stick, Status::slip}) {
        press.accept(press.attempt(rear, {press.all(status)}));
        EXPECT_EQ(press.kinsol->gmres_iterations(), 0) << "of the whole tangent";
        rear += 0.01;

        solve::Tangent& tangent = *press.equilibrium->tangent();
        const Vector b = Vector::LinSpaced(press.equilibrium->size(), -1, 2);
        Vector x(b.size()), Jx(b.size());
        constexpr double allowed = 1e-6;
        tangent.linearise();
        ASSERT_TRUE(tangent.solve(b.data(), x.data(), allowed));
        tangent.multiply(x.data(), Jx.data());
        EXPECT_LT((Jx - b).norm(), 2 * allowed);
    }
}

/// The tangent of two bodies that nothing bears on.
struct Apart {
    explicit Apart(const linear::BlockMatrix& stiffness)
        : K(stiffness), D(slaves.size(), Mat3::Identity()), rows(*press.constraints, slaves),
          tangent(press.plan.model, *press.constraints, K, slaves, false, 1) {
        tangent.set(none);
    }
    [[nodiscard]] bool solves() {
        const Vector b = Vector::Ones(rows.size());
        Vector x(b.size());
        return tangent.solve(rows, D, b.data(), x.data(), 1, press.timings);
    }

    Press press{linear::LinearSolver::condensed};
    linear::BlockMatrix K;
    std::vector<Index> slaves = press.plan.model.pairs[0]->slaves().node;
    std::vector<linear::BearingContact> none;
    std::vector<Mat3> D;
    linear::Unknowns rows;
    linear::CondensedTangent tangent;
};

/// Whichever body it is that has no inverse, and whatever comes after it.
TEST(CondensedTangent, SaysSoWhereABodyHasNoInverse) {
    const Press press(linear::LinearSolver::condensed);
    for (const model::Body& body : press.plan.model.bodies) {
        linear::BlockMatrix K = press.plan.model.K;
        const Index node = body.first_node + body.nodes() / 2;
        K.block(K.slot(node, node)) *= -1;
        EXPECT_FALSE(Apart(K).solves()) << body.name;
    }
    EXPECT_TRUE(Apart(press.plan.model.K).solves());
}

TEST(CondensedTangent, MakesInversesAndLawsAnewForAStepOfAnotherLength) {
    const Press press(linear::LinearSolver::condensed);
    Apart apart(press.plan.model.K);
    int made = 0; // of the bodies, and of the laws
    for (const auto& [dt, changed] : {std::pair{0.2, true}, {0.2, false}, {0.1, true}, {0.1, false}}) {
        apart.tangent.begin(dt, changed);
        EXPECT_TRUE(apart.solves());
        made += changed ? 2 : 0;
        EXPECT_EQ(apart.tangent.factorisations(), made) << dt;
    }
}

} // namespace
} // namespace osculate::equilibrium
