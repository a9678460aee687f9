/// The books of a dynamic run, where there is friction to be told from contact.

#include "osculate/time/ledger.hpp"

#include "osculate/mesh/surface_faces.hpp"
#include "support/small_run.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

/// A block of 50 kg, under a pressure that follows it and grows, slides on a plate that is fixed.
TEST(Ledger, AddsUpUnderFriction) {
    support::SmallModel small;
    const auto plate = mesh::make_block({0, 0, -0.2}, {2, 1, 0.2}, {4, 2, 1}),
               block = mesh::make_block({0.3, 0.2, 0}, {0.5, 0.5, 0.2}, {2, 2, 1});
    small.add_body("plate", plate, {1e9, 0.3}, 1000);
    small.add_body("block", block, {1e6, 0}, 1000);
    small.add_pair("joint", {1, "z_min"}, {0, "z_max"}, 1e6, 0.3);
    small.fix(0, "z_min", "xyz");
    small.fix(0, "z_max", "xyz");
    small.finish(true);
    for (Index i = 0; i < small.model.bodies[1].nodes(); ++i)
        small.model.initial_velocity[small.model.bodies[1].first_node + i] = Vec3::UnitX();
    Stage slide = support::small_motion(small, "slide", 0.1, 20, 0.5);
    slide.dynamics->mass_damping = 2;
    slide.dynamics->stiffness_damping = 1e-3;
    slide.weight = std::make_shared<const Field>(small.weight({0, 0, -10}));
    FollowerPressure& pressure = slide.follower_pressures.emplace_back();
    for (const mesh::Facet& facet : small.facets(1, "z_max")) pressure.faces.push_back(mesh::plane_face(facet));
    pressure.end = 500;
    slide.tangent = equilibrium::choose_tangent(small.model, small.model.pairs, LinearSolver::automatic, true, true);
    Timings timings;
    const double mass = 50, kinetic = 0.5 * mass; // kg, J
    Stepper stepper(small.model, {slide}, {}, timings);
    support::Record record;
    stepper.run(record);
    ASSERT_GE(record.steps.size(), 20U);
    constexpr double round_off = 1e-12; // relative, of sums over some ten steps
    for (const auto& [state, unbalanced, iterations, now] : record.steps)
        EXPECT_NEAR(now.kinetic + now.strain - kinetic,
                    now.external + now.contact - now.friction - now.damping - now.algorithmic + now.balance,
                    round_off * kinetic);
    const Ledger& end = record.steps.back().ledger;
    EXPECT_GT(end.friction, 0.3 * kinetic);
    EXPECT_GT(end.damping, 0.1 * kinetic);
    double by_mass = 0, before = kinetic; // mass_damping 2T dt, the block hardly vibrates
    for (const auto& [state, unbalanced, iterations, now] : record.steps) {
        by_mass += slide.dynamics->mass_damping * (before + now.kinetic) * (slide.duration / slide.steps);
        before = now.kinetic;
    }
    EXPECT_NEAR(end.damping - end.settling, by_mass, 0.02 * by_mass) << "stiffness damping apart";
    // nothing lifts off: normal forces act along no way, but for gaps within the solver's tolerance
    EXPECT_LT(std::abs(end.contact), 1e-9 * end.friction);
    EXPECT_LT(std::abs(end.balance), 1e-9 * end.friction);
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
