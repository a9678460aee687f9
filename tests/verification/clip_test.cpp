/// The tutorial's clip without friction against the theory of beams.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double E = 2.4e9, nu = 0.35;                          ///< Pa
constexpr double thickness = 2e-3, width = 1e-3;                ///< of the arm, m
constexpr double crest = 19e-3, rises_to = 3.5e-3;              ///< of the head, m
constexpr double bar_x = 26.5e-3, bar_bottom = 3.7e-3 - 1.5e-3; ///< m
constexpr double push = 11e-3;                                  ///< way of the bar, m

struct Step {
    double x = 0;             ///< of the bar's centre, m
    Vec3 held = Vec3::Zero(); ///< what moves the bar, N
    double bent = 0;          ///< largest displacement of the clip, m
};

class Clip : public testing::Test {
protected:
    static const std::vector<Step>& steps() {
        static const std::vector<Step> all = snapped();
        return all;
    }

private:
    static std::vector<Step> snapped() {
        support::SceneRun run;
        support::run_scene(run, support::shipped("tutorials/clip.yaml"),
                           {{"contact.general.friction", "0"}, {"stages.pull.steps", "1"}});
        std::vector<Step> list;
        const model::Body& clip = run.plan.model.bodies[0];
        for (const support::RunStep& step : run.steps) {
            if (step.time > 1 + 1e-9) break;
            Step& kept = list.emplace_back();
            kept.x = bar_x - push * step.time;
            kept.held = step.held_force[0];
            for (Index i = 0; i < clip.nodes(); ++i)
                kept.bent = std::max(kept.bent, step.state.u[static_cast<std::size_t>(clip.first_node + i)].norm());
        }
        return list;
    }
};

TEST_F(Clip, IsAsStiffAsABeamAtTheCrest) {
    // force at the free end of a cantilever in plane strain; 4 layers of hexahedra twice as long as high lock by 2 %, the
    // head stiffens the last millimetre, and the arm shears: 0.5 %
    const double I = width * std::pow(thickness, 3) / 12;
    const double force = 3 * E / (1 - nu * nu) * I * (rises_to - bar_bottom) / std::pow(crest, 3);
    double largest = 0;
    for (const Step& step : steps()) largest = std::max(largest, std::abs(step.held.z()));
    EXPECT_NEAR(largest, force, 0.06 * force);
}

TEST_F(Clip, SnapsAndIsFree) {
    EXPECT_LT(steps().back().held.norm(), 1e-9);
    EXPECT_LT(steps().back().bent, 1e-9);
}

TEST_F(Clip, GivesBackTheWorkOfPushingIt) {
    double work = 0, largest = 0, x = bar_x, force = 0;
    for (const Step& step : steps()) {
        work += (step.held.x() + force) / 2 * (step.x - x);
        x = step.x;
        force = step.held.x();
        largest = std::max(largest, work);
    }
    const double stored = std::pow(rises_to - bar_bottom, 2) / 2 * 3 * E / (1 - nu * nu) * width *
                          std::pow(thickness, 3) / 12 / std::pow(crest, 3);
    EXPECT_NEAR(largest, stored, 0.15 * stored);
    // steps of 0.18 mm see the jump at the crest, 0.4 N, to half a step
    EXPECT_NEAR(work, 0, 0.15 * stored);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
