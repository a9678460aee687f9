/// What stages hold that their scene does not say.

#include "osculate/app/compile.hpp"

#include "osculate/scene/reader.hpp"

#include <gtest/gtest.h>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

const std::string base = R"(
bodies:
  block:
    mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [1, 1, 1]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}
sets:
  bed: {body: block, surface: z_min}
supports:
  bed: {fix: [x, y, z]}
stages:
)";

time::StepLimits limits_of(const std::string& stage) {
    const scene::Scene scene = scene::parse_scene(base + "  only: " + stage + "\n", "scene.yaml");
    Timings timings;
    return compile(scene, build_meshes(scene), 1, timings).stages.at(0).limits;
}

/// In facet sizes. Statics look for it once a step of their size was cut, and hold what they accept to more.
TEST(CompiledStages, AllowAnInterpenetrationThatIsUsualInStaticsAndInDynamics) {
    const time::StepLimits statics = limits_of("{steps: 1}"), dynamics = limits_of("{analysis: dynamic}");
    EXPECT_EQ(statics.allowed_interpenetration, 0.5);
    EXPECT_TRUE(statics.usual_bound);
    EXPECT_FALSE(statics.in_metres);
    EXPECT_EQ(dynamics.allowed_interpenetration, 0.05);
    EXPECT_FALSE(dynamics.usual_bound);
    EXPECT_FALSE(dynamics.in_metres);
}

TEST(CompiledStages, TakeTheInterpenetrationTheySay) {
    for (const std::string analysis : {"static", "dynamic"}) {
        const time::StepLimits share =
            limits_of("{analysis: " + analysis + ", control: {allowed_interpenetration: 0.2}}");
        EXPECT_EQ(share.allowed_interpenetration, 0.2);
        EXPECT_FALSE(share.in_metres);
        EXPECT_FALSE(share.usual_bound) << "asked for: trials are solved in statics, too";
        const time::StepLimits length =
            limits_of("{analysis: " + analysis + ", control: {allowed_interpenetration: 3 mm}}");
        EXPECT_DOUBLE_EQ(length.allowed_interpenetration, 3e-3);
        EXPECT_TRUE(length.in_metres);
        EXPECT_FALSE(length.usual_bound);
    }
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
