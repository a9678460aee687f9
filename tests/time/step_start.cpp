/// What a step starts from.

#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/mesh/surface_faces.hpp"
#include "support/small_run.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

/// A block is pressed on another, and the load stays as dynamics begin.
TEST(FirstAcceleration, IsNoneWhereContactAndLoadsBalance) {
    support::SmallModel small;
    const material::LinearElastic elastic{1e6, 0.3};
    small.add_body("lower", mesh::make_block({0, 0, -1}, {1, 1, 1}, {2, 2, 2}), elastic, 1000);
    small.add_body("upper", mesh::make_block({0.2, 0.2, 0}, {0.6, 0.6, 0.5}, {2, 2, 1}), elastic, 1000);
    small.add_pair("joint", {1, "z_min"}, {0, "z_max"}, elastic.E, 0.2);
    small.fix(0, "z_min", "xyz");
    small.fix(1, "x_min", "xy");
    small.finish(true);
    Stage press = support::small_stage(small, "press", 1);
    Field pressed(small.model.X.size());
    for (const mesh::Facet& facet : small.facets(1, "z_max"))
        fe::add_pressure_forces(mesh::plane_face(facet), small.model.X, 1e4, pressed.values());
    press.force_end = SparseField(pressed);
    Stage wait = support::small_motion(small, "wait", 0.01, 2, 0.8);
    wait.force_start = wait.force_end = press.force_end;
    Timings timings;
    Stepper stepper(small.model, {press, wait}, {}, timings);
    support::Record record;
    stepper.run(record);
    ASSERT_GE(record.steps.size(), 3U);
    const model::State &still = record.steps.front().state, &later = record.steps.back().state;
    ASSERT_GT(std::ranges::count_if(still.contact[0].status, contact::is_closed), 0);
    constexpr double solved = 1e-9; // tolerance of forces, of the load: energies come out with its square
    for (std::size_t k = 1; k < record.steps.size(); ++k)
        EXPECT_LT(record.steps[k].ledger.kinetic, solved * record.steps[k].ledger.strain);
    double largest = 0;
    for (const Vec3& u : still.u) largest = std::max(largest, u.norm());
    EXPECT_LT(largest_distance(later.u, still.u).value, 1e3 * solved * largest); // and the condition of the blocks
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
