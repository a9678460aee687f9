/// Two free blocks that meet off their centres, in flight along all three axes: nothing else acts, so momentum stays.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

std::string two_blocks(const std::string& surface, const std::string& friction, int steps, bool finite,
                       const std::string& element) {
    const std::string integrator = finite ? "generalised_alpha: {rho_inf: 1}" : "newmark: {}";
    const std::string material = finite ? "saint_venant_kirchhoff" : "linear_elastic";
    return R"(
bodies:
  flying:
    mesh: {block: {size: [0.4 m, 0.3 m, 0.3 m], divisions: [5, 2, 2], element: )" +
           element + R"(}, translate: [-0.401 m, 0.07 m, 0.05 m]}
    material: {)" +
           material +
           R"(: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}
    initial_velocity: [0.1, 0.03, -0.01]
  waiting:
    mesh: {block: {size: [0.4 m, 0.4 m, 0.4 m], divisions: [2, 2, 2], element: )" +
           element + R"(}}
    material: {)" +
           material + R"(: {E: 1 MPa, nu: 0.3, density: 500 kg/m^3}}
sets:
  nose: {body: flying, surface: x_max}
  face: {body: waiting, surface: x_min}
contact:
  meeting: {slave: nose, master: {set: face, surface: )" +
           surface + "}, friction: " + friction + R"(}
stages:
  impact:
    analysis: {dynamic: {integrator: {)" +
           integrator + R"(}}}
    duration: 0.06 s
    steps: )" +
           std::to_string(steps) + "\n";
}

/// Largest changes over the run; those of angular momentum relative to `arm` times the impulse.
struct Changes {
    double impulse = 0;  ///< exchanged, N s
    double linear = 0;   ///< of linear momentum, of the impulse
    double angular = 0;  ///< of angular momentum
    double internal = 0; ///< what internal forces have made of it
    double rest = 0;     ///< the difference of these two
    double moment = 0;   ///< sum of the moments of contact forces, of the moment on one side
};
constexpr double arm = 0.1; // m, from the line of the centres to that of the impact, roughly

/// Small strain takes moments about the reference positions X, where internal forces have none; about X + u they have one.
Vec3 internal_impulse(const model::Model& model, const support::RunStep& from, const support::RunStep& to) {
    const Field u = weighted(0.5, from.state.u, 0.5, to.state.u);
    Field force(u.size());
    model.K.multiply_add(u, force, 1);
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < u.size(); ++i) sum -= (to.time - from.time) * u[i].cross(force[i]);
    return sum;
}

Changes meet(const std::string& surface, const std::string& friction, int steps, bool finite,
             const std::string& element = "hex8") {
    support::SceneRun run;
    support::run_scene(run,
                       support::scene_file("two_blocks.yaml", two_blocks(surface, friction, steps, finite, element)));
    Changes changes;
    const time::Ledger& start = run.steps.front().ledger; // in flight
    EXPECT_EQ(run.steps.front().pairs[0].normal, 0);
    double moment = 0;
    Vec3 internal = Vec3::Zero();
    for (std::size_t k = 1; k < run.steps.size(); ++k) {
        const support::RunStep &from = run.steps[k - 1], &to = run.steps[k];
        const support::PairForces& pair = to.pairs[0];
        changes.impulse += (to.time - from.time) * pair.on_slave.norm();
        internal += internal_impulse(run.plan.model, from, to);
        const Vec3 angular = to.ledger.angular - start.angular;
        changes.linear = std::max(changes.linear, (to.ledger.linear - start.linear).norm());
        changes.angular = std::max(changes.angular, angular.norm());
        changes.internal = std::max(changes.internal, internal.norm());
        changes.rest = std::max(changes.rest, (angular - internal).norm());
        changes.moment = std::max(changes.moment, (pair.moment_on_slave + pair.moment_on_master).norm());
        moment = std::max(moment, pair.moment_on_slave.norm());
        EXPECT_LT((pair.on_slave + pair.on_master).norm(), 1e-13 * (1 + pair.on_slave.norm()));
    }
    EXPECT_EQ(run.steps.back().pairs[0].normal, 0) << "they have not parted";
    changes.linear /= changes.impulse;
    changes.moment /= moment;
    for (double* part : {&changes.angular, &changes.internal, &changes.rest}) *part /= arm * changes.impulse;
    std::printf("%s strain, %s, friction %s, %d steps: linear %.1e, angular %.1e, by internal forces %.1e, rest %.1e, "
                "moment %.1e\n",
                finite ? "finite" : "small", surface.c_str(), friction.c_str(), steps, changes.linear, changes.angular,
                changes.internal, changes.rest, changes.moment);
    return changes;
}

TEST(TwoBlocks, ExchangeMomentumAndLoseNone) {
    const double round_off = 1e-11; // relative, of some hundred steps; measured: 1e-12
    for (const char* surface : {"facets", "blend"})
        for (const char* friction : {"0", "0.1"}) {
            const Changes coarse = meet(surface, friction, 120, false), fine = meet(surface, friction, 240, false);
            for (const Changes& changes : {coarse, fine}) {
                EXPECT_GT(changes.impulse, 0.5 * 36 * 0.1) << "of 36 kg at 0.1 m/s";
                EXPECT_LT(changes.linear, round_off);
                EXPECT_LT(changes.moment, round_off); // where the master is flat; curved blends have 1e-8 with friction
                EXPECT_LT(changes.angular, 0.01);     // as small as the turn of the bodies, small strain's own error
            }
            // What internal forces leave over is the way of the contact points within a step.
            EXPECT_LT(coarse.rest, 1e-5);
            const double slack = 0.3; // of a slope measured between two steps
            EXPECT_NEAR(std::log2(coarse.rest / fine.rest), 2, slack);
        }
}

TEST(TwoBlocks, KeepTheirAngularMomentumAtFiniteStrain) {
    for (const char* friction : {"0", "0.1"}) {
        const Changes coarse = meet("facets", friction, 120, true), fine = meet("facets", friction, 240, true);
        EXPECT_LT(coarse.linear, 1e-7) << "the solver's tolerance";
        // Inertia takes moments in the middle of the step, contact forces act at its end, half a slip further on.
        EXPECT_LT(coarse.angular, 1e-4);
        EXPECT_NEAR(std::log2(coarse.angular / fine.angular), 1, 0.3);
    }
}

TEST(TwoBlocks, OfQuadraticElementsKeepTheirMomentaToo) {
    const Changes small = meet("blend", "0.1", 24, false, "hex20"), finite = meet("facets", "0.1", 30, true, "tet10");
    EXPECT_LT(small.linear, 1e-11);
    EXPECT_LT(small.moment, 1e-10); // each force acts on some thirty nodes
    EXPECT_LT(small.angular, 0.01);
    EXPECT_LT(finite.linear, 1e-7);
    EXPECT_LT(finite.angular, 3e-4); // of first order in the step, which is four times as long as above
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
