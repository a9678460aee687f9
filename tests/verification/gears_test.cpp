/// The tutorial's pair of gears against the theory of involute teeth.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr int teeth = 20, per_pitch = 36; ///< of each gear; steps
constexpr double module = 5e-3, torque = 30, mu = 0.05;
const double pressure_angle = 20 * degree, pitch = 2 * std::numbers::pi / teeth;
const double pitch_radius = module * teeth / 2, tip_radius = pitch_radius + module;
const double base_radius = pitch_radius * std::cos(pressure_angle);
/// Path of contact beyond the pitch point, of each gear, and its part of the contact ratio.
const double half_path =
    std::sqrt(tip_radius * tip_radius - base_radius * base_radius) - pitch_radius * std::sin(pressure_angle);
const double half_ratio = half_path / (base_radius * pitch);
/// Chords of a flank leave the involute by 2.3 um, a tenth of what the teeth bend by.
constexpr double chords = 0.015;

struct Step {
    double torque = 0;           ///< of the shaft that drives, N m
    double turned = 0;           ///< of the driven gear, rad
    double normal = 0;           ///< sum of the normal forces, N
    std::map<int, double> loads; ///< on the driver's teeth, N
};

/// The gears turn by a pitch and half a degree, in steps of half a degree.
class Gears : public testing::Test {
protected:
    static const std::vector<Step>& steps() {
        static const std::vector<Step> all = turned();
        return all;
    }
    /// The steps of one pitch.
    static std::vector<Step> one_pitch() { return {steps().end() - per_pitch, steps().end()}; }

private:
    static std::vector<Step> turned() {
        support::SceneRun run;
        support::run_scene(run, support::shipped("tutorials/spur_gears.yaml"),
                           {{"stages.turn.motion.shaft.rz", "18.5 deg"}, {"stages.turn.steps", "37"}});
        const model::Model& model = run.plan.model;
        std::vector<Step> list;
        for (const support::RunStep& step : run.steps) {
            Step& kept = list.emplace_back();
            kept.torque = step.held_moment[0].z();
            kept.turned = step.state.rigid[1].rotation.z();
            const double angle = step.state.rigid[0].rotation.z();
            for (const model::ContactHistory& pair : step.state.contact)
                for (std::size_t j = 0; j < pair.lambda.size(); ++j) {
                    const double force = pair.lambda[j].norm();
                    if (force == 0) continue;
                    const auto node = static_cast<std::size_t>(pair.pair->slaves().node[j]);
                    const Vec3 x = model.X[node] + step.state.u[node] + model.origin;
                    kept.loads[static_cast<int>(std::lround((std::atan2(x.y(), x.x()) - angle) / pitch))] += force;
                    // all that touches slides, but at the pitch point
                    kept.normal += force / std::sqrt(1 + (pair.status[j] == contact::Status::slip ? mu * mu : 0));
                }
        }
        return list;
    }
};

TEST_F(Gears, ComeBackAfterAPitch) {
    ASSERT_EQ(steps().size(), per_pitch + 2U) << "no step was cut";
    const Step &before = steps()[1], &after = steps().back();
    EXPECT_NEAR(after.turned - before.turned, -pitch, 1e-4 * degree);
    EXPECT_NEAR(after.torque, before.torque, 1e-3 * torque);
}

TEST_F(Gears, PassOnTheTorqueButForFriction) {
    // of involute gears with rigid teeth [Niemann, Winter: Maschinenelemente 2]
    const double loss = mu * pitch * (1 - 2 * half_ratio + 2 * half_ratio * half_ratio);
    double mean = 0;
    for (const Step& step : one_pitch()) {
        mean += step.torque / per_pitch;
        EXPECT_NEAR(step.torque, torque * (1 + loss), 3 * chords * torque);
    }
    EXPECT_NEAR(mean, torque * (1 + loss), 0.2 * loss * torque);
}

TEST_F(Gears, PressAlongTheLineOfAction) {
    // a force at the distance s from the pitch point has the lever r_b, and its friction another, s away from r sin(alpha)
    const double levers = chords + mu * (pitch_radius * std::sin(pressure_angle) + half_path) / base_radius;
    for (const Step& step : one_pitch())
        EXPECT_NEAR(step.torque / (step.normal * base_radius), 1, levers) << step.turned / degree;
}

TEST_F(Gears, HaveTheContactRatioOfInvolutesAndOfTeethThatBend) {
    double ratio = 0;
    for (const Step& step : one_pitch()) {
        const auto loaded =
            std::ranges::count_if(step.loads, [&](const auto& tooth) { return tooth.second > 0.01 * step.normal; });
        EXPECT_GE(loaded, 1);
        EXPECT_LE(loaded, 2);
        ratio += static_cast<double>(loaded) / per_pitch;
    }
    const double rigid = 2 * half_ratio;
    EXPECT_NEAR(rigid, 1.557, 1e-3);
    EXPECT_GT(ratio, rigid);
    EXPECT_LT(ratio, rigid + 0.15);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
