/// Every key of a scene is used by a shipped scene, template or study, or by a test, with a value that is not its default.

#include "key_uses.hpp"
#include "support/source_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

using testing::Contains;
using testing::Not;

const std::filesystem::path root = support::source_tree();

TEST(KeyCoverage, LeavesNoKeyAndNoWordUntouched) {
    KeyUses uses;
    ASSERT_GT(uses.wanted().size(), 150u);
    for (const char* folder : {"configs", "output_templates", "tests"}) uses.read_folder(root / folder);
    std::string list;
    for (const std::string& key : uses.untouched()) list += "\n  " + key;
    EXPECT_EQ(list, "")
        << "no file of configs/, output_templates/ or tests/ gives these a value other than their default";
}

TEST(KeyCoverage, SeesScenesStudiesOverridesAndFragments) {
    KeyUses uses;
    uses.read_yaml("stages: {push: {steps: 3, analysis: dynamic, control: {growth: 3}}}\ngravity: [0, 0, 9.81]\n");
    uses.read_yaml(
        "set: {solver.tolerance: 1e-5}\naxes: {mass: {key: stages.a.analysis.dynamic.mass, values: [lumped]}}");
    uses.read_cpp(R"x(run({{"contact.touch.surface", "facets"}, {"contact.p.friction", mu}});
        const char* text = R"(
  ball:
    mesh: {ball: {grading: 1.1}}
)";)x");
    for (const char* key :
         {"stages.<stage>.steps", "stages.<stage>.analysis.dynamic", "stages.<stage>.control.growth", "gravity",
          "solver.tolerance", "stages.<stage>.analysis.dynamic.mass=lumped", "contact.<pair>.master.surface.facets",
          "contact.<pair>.friction", "bodies.<body>.mesh.ball.grading"})
        EXPECT_THAT(uses.untouched(), Not(Contains(key)));
}

TEST(KeyCoverage, CountsNeitherDefaultsNorMentions) {
    KeyUses uses;
    uses.read_yaml(
        "solver: {tolerance: 1e-9, max_iterations: 30}\nbodies: {b: {mesh: {block: {size: [1 m, 1, 100 cm]}}}}");
    uses.read_cpp(R"x(// {"solver.predictor", "false"}
        EXPECT_EQ(fault.key, "solver.smallest_step"); run({{"contact.p.friction", "0"}});)x");
    for (const char* key : {"solver.tolerance", "solver.max_iterations", "bodies.<body>.mesh.block.size",
                            "solver.predictor", "solver.smallest_step", "contact.<pair>.friction"})
        EXPECT_THAT(uses.untouched(), Contains(key));
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
