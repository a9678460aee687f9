#include "osculate/linear/condensed_tangent.hpp"

#include "equilibrium/press.hpp"
#include "osculate/model/rigid_motion.hpp"

#include <gtest/gtest.h>
#include <set>
#include <utility>

namespace osculate::equilibrium::OSCULATE_THIS_FILE {
namespace {

using contact::Status;
using fixtures::Press;

/// Bodies that lean on springs while their inverses are made do not lean on them in what is solved: nothing has to be
/// solved by other means.
TEST(CondensedTangent, SolvesForABodyThatContactAloneHolds) {
    Press press(LinearSolver::condensed);
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
        ASSERT_TRUE(tangent.solve(b, x, allowed));
        tangent.multiply(x, Jx);
        EXPECT_LT((Jx - b).norm(), 2 * allowed);
    }
}

/// The tangent of two bodies that nothing bears on.
struct Apart {
    explicit Apart(const linear::BlockMatrix& stiffness)
        : K(stiffness), D(slaves.size(), Mat3::Identity()), rows(*press.constraints, slaves),
          tangent(*press.constraints, K, press.plan.model.X, bodies(), contact_nodes(), slaves, 1) {
        tangent.set(none);
    }
    [[nodiscard]] bool solves() {
        const Vector b = Vector::Ones(rows.size());
        Vector x(b.size());
        return tangent.solve(rows, D, b, x, 1, press.timings);
    }

    [[nodiscard]] std::vector<linear::CondensedBody> bodies() const {
        std::vector<linear::CondensedBody> list;
        for (const model::Body& body : press.plan.model.bodies) {
            model::RigidHold hold(body, press.plan.model.X);
            for (Index node = body.first_node; node < body.first_node + body.nodes(); ++node)
                for (int k = 0; k < 3; ++k)
                    if (press.constraints->constraint(node, k) != nullptr)
                        hold.hold(press.plan.model.X[node], press.constraints->frame(node).col(k));
            list.push_back({body.first_node, body.nodes(), hold.free() > 0});
        }
        return list;
    }
    [[nodiscard]] std::vector<Index> contact_nodes() const {
        std::set<Index> nodes(slaves.begin(), slaves.end());
        const std::vector<Index>& masters = press.plan.model.pairs[0]->master_nodes();
        nodes.insert(masters.begin(), masters.end());
        return {nodes.begin(), nodes.end()};
    }

    Press press{LinearSolver::condensed};
    linear::BlockMatrix K;
    std::vector<Index> slaves = press.plan.model.pairs[0]->slaves().node;
    std::vector<linear::BearingContact> none;
    std::vector<Mat3> D;
    linear::Unknowns rows;
    linear::CondensedTangent tangent;
};

/// Whichever body it is that has no inverse, and whatever comes after it.
TEST(CondensedTangent, SaysSoWhereABodyHasNoInverse) {
    const Press press(LinearSolver::condensed);
    for (const model::Body& body : press.plan.model.bodies) {
        linear::BlockMatrix K = press.plan.model.K;
        const Index node = body.first_node + body.nodes() / 2;
        K.block(K.slot(node, node)) *= -1;
        EXPECT_FALSE(Apart(K).solves()) << body.name;
    }
    EXPECT_TRUE(Apart(press.plan.model.K).solves());
}

TEST(CondensedTangent, MakesInversesAndLawsAnewForAStepOfAnotherLength) {
    const Press press(LinearSolver::condensed);
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
} // namespace osculate::equilibrium::OSCULATE_THIS_FILE
