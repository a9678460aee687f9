/// Schemas of the repository, and tutorials that are written anew.

#include "scenes/program.hpp"

#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Schema : public Program {};

TEST_F(Schema, OfTheRepositoryIsWhatTheProgramPrints) {
    for (const std::string kind : {"scene", "study", "template"}) {
        const Outcome printed = osculate({"schema", kind});
        EXPECT_EQ(printed.code, 0);
        EXPECT_TRUE(printed.out == content(scene_file("docs/schema/" + kind + ".schema.json")))
            << kind << ": scripts/pages/scene_reference writes it anew";
    }
    EXPECT_EQ(osculate({"schema"}).out, content(scene_file("docs/schema/scene.schema.json")));
    EXPECT_EQ(osculate({"schema", "scenes"}).code, 2);
}

class Init : public Program {};

TEST_F(Init, ListsEveryTutorialWithWhatItShows) {
    const std::string list = osculate({"init", "--list"}).out;
    for (const auto& entry : std::filesystem::directory_iterator(scene_file("configs/tutorials"))) {
        if (entry.path().extension() != ".yaml") continue;
        EXPECT_THAT(list, testing::ContainsRegex(entry.path().stem().string() + " +[A-Z][^\n]+\\.\n"));
    }
}

TEST_F(Init, WritesASceneWithItsMeshThatRunsWhereItIs) {
    const Outcome outcome = osculate({"init", "pad_from_file", "-o", "mine/pad.yaml"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "mine/pad.yaml written, its mesh mine/meshes/pad.vtu; run it: osculate run mine/pad.yaml\n");
    const std::string text = content(folder / "mine/pad.yaml");
    EXPECT_THAT(text, AllOf(HasSubstr("#   osculate run mine/pad.yaml\n"), Not(HasSubstr("configs/tutorials"))));
    EXPECT_THAT(text, testing::StartsWith("# yaml-language-server: $schema="));
    const std::size_t path = text.find('=') + 1;
    EXPECT_TRUE(std::filesystem::is_regular_file(text.substr(path, text.find('\n') - path)));
    EXPECT_EQ(osculate({"check", "mine/pad.yaml"}).code, 0);
}

/// Two pads of one mesh.
TEST_F(Init, WritesAMeshOnceThatBodiesShare) {
    std::string text = content(scene_file("configs/tutorials/pad_from_file.yaml"));
    const std::size_t pad = text.find("  pad:"), slab = text.find("  slab:");
    text.insert(slab, "  upper:" + text.substr(pad + 6, slab - pad - 6));
    std::filesystem::create_directories(folder / "shipped/meshes");
    std::ofstream(folder / "shipped/two_pads.yaml") << text;
    std::filesystem::copy_file(scene_file("configs/tutorials/meshes/pad.vtu"), folder / "shipped/meshes/pad.vtu");
    const std::string shipped = (folder / "shipped").string();
    const Outcome outcome = osculate({"init", "two_pads", "-o", "mine/pads.yaml"},
                                     [&] { setenv("OSCULATE_TUTORIALS", shipped.c_str(), 1); });
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out,
              "mine/pads.yaml written, its mesh mine/meshes/pad.vtu; run it: osculate run mine/pads.yaml\n");
    EXPECT_EQ(content(folder / "mine/meshes/pad.vtu"), content(folder / "shipped/meshes/pad.vtu"));
}

TEST_F(Init, OverwritesNothing) {
    std::ofstream(folder / "press_block.yaml") << "mine";
    const Outcome outcome = osculate({"init", "press_block"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("press_block.yaml: expected a file that is not there yet"));
    EXPECT_EQ(content(folder / "press_block.yaml"), "mine");
    std::filesystem::create_directories(folder / "meshes");
    std::ofstream(folder / "meshes/pad.vtu") << "mine";
    EXPECT_EQ(osculate({"init", "pad_from_file"}).code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder / "pad_from_file.yaml")) << "half of a tutorial";
}

TEST_F(Init, NamesTheNearestTutorial) {
    const Outcome outcome = osculate({"init", "bouncing_bal"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("press_block"), HasSubstr("(did you mean 'bouncing_ball'?)")));
    EXPECT_EQ(osculate({"init"}).code, 2);
}

/// What bash offers for the last word.
std::string completed(const std::string& words, int last) {
    const std::filesystem::path program = OSCULATE_PROGRAM;
    const std::string command = "PATH=" + program.parent_path().string() + ":$PATH bash -c 'source " +
                                scene_file("scripts/completion.bash") + "; COMP_WORDS=(" + words +
                                "); COMP_CWORD=" + std::to_string(last) + "; _osculate; echo ${COMPREPLY[@]}'";
    FILE* pipe = popen(command.c_str(), "r");
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    pclose(pipe);
    return text;
}

TEST(Completion, OffersCommandsOptionsTutorialsAndKeys) {
    EXPECT_EQ(completed("osculate exp", 1), "explain\n");
    EXPECT_EQ(completed("osculate init press_b", 2), "press_block\n");
    EXPECT_EQ(completed("osculate run a.yaml --thr", 3), "--threads\n");
    EXPECT_EQ(completed("osculate run a.yaml --set solver.tol", 4), "solver.tolerance\n");
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
