/// Study files: what is read, and what is said of those that cannot be.

#include "osculate/scene/study.hpp"
#include "small_study.hpp"

#include <gmock/gmock.h>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(StudyFile, IsACartesianProductLessWhatIsLeftOut) {
    const Study study = read(small_study);
    std::vector<std::string> ids;
    for (const Combination& c : study.combinations()) ids.push_back(study.id(c));
    EXPECT_THAT(ids, ElementsAre("surface=facets,mesh=coarse", "surface=blend-ring-3,mesh=coarse",
                                 "surface=blend-ring-3,mesh=fine"));
    EXPECT_EQ(study.refine, 1);
    EXPECT_THAT(study.colour_by, ElementsAre(0));
}

TEST(StudyFile, SettingsComeInTheirOrderAndOutputLast) {
    const Study study = read(small_study);
    const std::vector<Override> list =
        study.overrides_of({1, 1}, {{"output.frame_every", "1"}, {"gravity", "[0, 0, 0]"}});
    ASSERT_GT(list.size(), 5U);
    EXPECT_EQ(list[0].key + "=" + list[0].value, "stages.load.steps=3");
    EXPECT_EQ(list[1].key + "=" + list[1].value, "contact.joint.surface={blend: {ring: 3}}");
    EXPECT_EQ(list[2].key + "=" + list[2].value, "bodies.cap.mesh.block.divisions=[2, 2, 2]");
    const Scene scene = read_scene(study.scene, list);
    EXPECT_EQ(std::get<BlendSurface>(scene.contact[0].second.master.surface).ring, 3);
    EXPECT_EQ(scene.output.frame_every, 1000000) << "the first frame and the last";
    EXPECT_EQ(scene.output.slave_fields.size(), 7U);
    EXPECT_TRUE(scene.output.body_fields.empty());
}

TEST(StudyFile, ConstantsFollowFromParameters) {
    const Study study = read(small_study);
    const Numbers numbers = numbers_of(study, {1, 1}, functions, std::vector<double>(run_numbers().size(), 7));
    const auto number = [&](const std::string& name) {
        const auto at = std::ranges::find(numbers.names, name);
        return at == numbers.names.end() ? -1 : numbers.values[static_cast<std::size_t>(at - numbers.names.begin())];
    };
    EXPECT_EQ(number("h"), 0.5);
    EXPECT_EQ(number("F"), 2.5);
    EXPECT_EQ(number("G"), 5);
    EXPECT_EQ(number("mesh_index"), 1);
    EXPECT_EQ(number("dofs"), 7);
}

TEST(StudyFile, NumbersOfAnAxisAreItsParameterAndHideColumns) {
    const std::string text =
        replaced(small_study, "  mesh:\n", "  dt: {key: stages.load.duration, values: [1, 2]}\n  mesh:\n");
    const Study study = read(replaced(text, "abs(pair.joint.force_x)", "dt * pair.joint.force_x"));
    const Scene scene = read_scene(study.scene);
    const Numbers numbers = numbers_of(study, {1, 1, 1}, functions, {});
    EXPECT_EQ(numbers.values[static_cast<std::size_t>(std::ranges::find(numbers.names, "dt") - numbers.names.begin())],
              2);
    EXPECT_EQ(std::ranges::count(visible_columns(study.quantities[1], scene, numbers.names), "dt"), 0);
    EXPECT_EQ(std::ranges::count(visible_columns(study.quantities[1], scene, {}), "dt"), 1);
}

TEST(StudyFile, MisspeltKeysNameTheNearest) {
    EXPECT_THAT(
        faults(replaced(small_study, "refine: mesh", "refine: mseh")),
        ElementsAre("study.yaml:22:9: refine: expected one of the axes surface, mesh, found 'mseh' (did you mean "
                    "'mesh'?)"));
    EXPECT_THAT(
        faults(replaced(small_study, "reduce: max", "reduce: maxx")),
        ElementsAre(AllOf(HasSubstr("study.yaml:21:13: quantities.force.reduce: "), HasSubstr("did you mean 'max'?"))));
    EXPECT_THAT(
        faults(replaced(small_study, "constants:", "constatns:")),
        testing::Contains(AllOf(HasSubstr("study.yaml:4:1: constatns:"), HasSubstr("did you mean 'constants'?"))));
    EXPECT_THAT(faults(replaced(small_study, "mesh: [fine]", "mesh: [fien]")),
                ElementsAre(AllOf(HasSubstr("study.yaml:13:30: leave_out.mesh: "), HasSubstr("did you mean 'fine'?"))));
}

TEST(StudyFile, FormulasAreReadBeforeAnythingIsRun) {
    EXPECT_THAT(faults(replaced(small_study, "twice(F)", "twcie(F)")),
                ElementsAre(AllOf(HasSubstr("study.yaml:6:6: constants.G: expected a formula, found 'twcie(F)'"),
                                  HasSubstr("did you mean 'twice'?"))));
    EXPECT_THAT(faults(replaced(small_study, "max(normal_stress)", "max(normal_strees)")),
                ElementsAre(AllOf(HasSubstr("study.yaml:17:12: quantities.peak.value:"),
                                  HasSubstr("did you mean 'normal_stress'?"))));
    EXPECT_THAT(faults(replaced(small_study, "pair.joint.force_x", "pair.jiont.force_x")),
                ElementsAre(AllOf(HasSubstr("study.yaml:20:14: quantities.force.history:"),
                                  HasSubstr("did you mean 'pair.joint.force_x'?"))));
    EXPECT_THAT(faults(replaced(small_study, "contact: joint", "contact: jiont")),
                ElementsAre(HasSubstr("found 'jiont' (did you mean 'joint'?)")));
}

TEST(StudyFile, FaultsOfScenesAreThoseOfEverySettingAtItsPlace) {
    EXPECT_THAT(
        faults(replaced(small_study, "values: [facets, {blend: {ring: 3}}]", "values: [fecets, {blend: {ring: 9}}]")),
        testing::IsSupersetOf({AllOf(HasSubstr("study.yaml:8:"), HasSubstr("did you mean 'facets'?")),
                               AllOf(HasSubstr("study.yaml:8:"), HasSubstr("whole number in [1, 3]"))}));
    EXPECT_THAT(faults(replaced(small_study, "stages.load.steps: 3", "stages.laod.steps: 3")),
                ElementsAre(AllOf(HasSubstr("study.yaml:3:7: "), HasSubstr("did you mean 'load'?"))));
    EXPECT_THAT(faults(small_study, {{"solver.tolerance", "7"}}), ElementsAre(HasSubstr("--set: solver.tolerance")));
    EXPECT_THAT(
        faults(replaced(small_study, "scene: small.yaml", "scene: smal.yaml")),
        testing::Contains(HasSubstr("study.yaml:2:8: scene: expected a scene file that exists, found 'smal.yaml'")));
}

TEST(StudyFile, AllFaultsAreToldAtOnce) {
    std::string text = replaced(small_study, "reduce: max", "reduce: maxx");
    text = replaced(text, "twice(F)", "twcie(F)");
    text = replaced(text, "refine: mesh", "refine: mseh");
    EXPECT_EQ(faults(text).size(), 3U);
}

TEST(StudyFile, ContradictionsAreFaults) {
    EXPECT_THAT(faults(replaced(small_study, ", parameters: {h: 1 / 2}", "")),
                testing::Contains(HasSubstr("the same parameters for all values: h")));
    EXPECT_THAT(faults(replaced(small_study, "    value: max(normal_stress)\n", "")),
                testing::Contains(HasSubstr("quantities.peak.value: expected it or of, found neither")));
    EXPECT_THAT(faults(replaced(small_study, "    contact: joint\n", "    contact: joint\n    body: cap\n")),
                testing::Contains(HasSubstr("only one of contact, body, history")));
    EXPECT_THAT(faults(replaced(small_study, "value: max(normal_stress)", "of: normal_stress")),
                testing::Contains(HasSubstr("quantities.peak.order_by: expected one for reduce: last of nodes")));
    EXPECT_THAT(faults(replaced(small_study, "reduce: max", "value: 1")),
                testing::Contains(HasSubstr("quantities.force.history: expected all, as value says")));
    EXPECT_THAT(faults(replaced(small_study, "  F: 5 * h", "  h: 5")),
                testing::Contains(HasSubstr("constants.h: expected a name")));
}

TEST(StudyFile, AnAxisMayBeAllScenesOfAFolder) {
    for (const char* name : {"b_2.yaml", "a_1.yaml", "c.txt", "other.yaml", "._1.yaml"})
        support::scene_file(name, small_scene);
    const auto with = [](const std::string& pattern) {
        return "axes:\n  scene: {scenes: " + pattern + "}\nquantities:\n  steps: {value: steps + 0 * penetration}\n";
    };
    const Study study = read(with("'./?_*.yaml'"));
    std::vector<std::string> ids;
    for (const Combination& c : study.combinations()) ids.push_back(study.id(c));
    EXPECT_THAT(ids, ElementsAre("scene=a_1", "scene=b_2"));
    EXPECT_EQ(study.scene_of({1}), support::temporary("b_2.yaml"));
    EXPECT_THAT(faults(with("nothing_*.yaml")),
                ElementsAre("study.yaml:2:19: axes.scene.scenes: expected scene files, * and ? in their name, found "
                            "'nothing_*.yaml'"));
}

TEST(StudyFile, OneOfSurfacesIsAnother) {
    EXPECT_TRUE(is_run_study(file_with(small_study)));
    EXPECT_FALSE(is_run_study(support::scene_file("surfaces.yaml", "surfaces: {ball: {}}\n")));
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
