#include "osculate/scene/keys.hpp"
#include "osculate/scene/writer.hpp"
#include "scene_text.hpp"
#include "support/source_tree.hpp"

#include <Eigen/Geometry>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <numbers>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr double round_off = 1e-14; // of unit vectors' components

Scene read_small(const std::vector<Override>& overrides = {}) {
    return parse_scene(small_scene, "small.yaml", overrides);
}

/// Written and read back.
Scene again(const Scene& scene) {
    return parse_scene(write_scene(scene), "again.yaml");
}

const MasterSpec& master(const Scene& scene) {
    return scene.contact.front().second.master;
}

TEST(Reader, TurnsEveryQuantityIntoSi) {
    const Scene scene = read_small();
    EXPECT_EQ(scene.name, "small");
    const auto& cap = scene.bodies[1].second;
    EXPECT_EQ(std::get<BlockMesh>(cap.mesh.source).size, Vec3(1, 1, 0.5));
    EXPECT_EQ(std::get<LinearElastic>(cap.material).E, 10e6);
    const Stage& load = scene.stages.front().second;
    EXPECT_EQ(load.duration, 60);
    EXPECT_EQ(load.pressure.front().second, 5e3);
    EXPECT_EQ(load.body_force.front().second, (std::array<Course, 3>{0.0, 0.0, -2e3}));
    EXPECT_EQ(load.displacement.front().second[0], 1e-3);
    EXPECT_FALSE(load.displacement.front().second[1]);
}

TEST(Reader, KeepsTheOrderOfTheFile) {
    std::vector<std::string> sets;
    for (const auto& [name, set] : read_small().sets) sets.push_back(name);
    EXPECT_THAT(sets, ElementsAre("bed", "ground", "under", "top"));
}

TEST(Reader, FillsOutputFromTheTemplateAndLetsTheSceneWin) {
    const Output output = read_small().output;
    EXPECT_THAT(output.body_fields, ElementsAre("displacement"));
    EXPECT_TRUE(output.slave_fields.empty());
    EXPECT_TRUE(output.history_pairs);
    EXPECT_FALSE(output.history_reactions);
    EXPECT_TRUE(output.iterations);
}

TEST(Reader, TakesTheContactTemplateWhenNoneIsNamed) {
    const Scene scene = parse_scene(replaced(small_scene, "output:", "description: none\nsolver: {}\n#"), "s.yaml");
    EXPECT_EQ(scene.output.template_name, "contact");
    EXPECT_EQ(scene.output.slave_fields.size(), 6u);
    EXPECT_TRUE(scene.output.history_reactions);
}

TEST(Reader, AsksBodiesWhatSlavesAreAskedWhereGeneralContactFindsThese) {
    const std::vector<Override> asked{{"output.body_fields", "[displacement, contact_gap]"},
                                      {"output.slave_fields", "[gap, status, area]"}};
    EXPECT_THAT(read_small(asked).output.body_fields, ElementsAre("displacement", "contact_gap"));
    std::vector<Override> general = asked;
    general.emplace_back("contact.general", "{}");
    EXPECT_THAT(read_small(general).output.body_fields, ElementsAre("displacement", "contact_gap", "contact_status"));
}

TEST(Reader, SelectsTheSurfaceByABareWord) {
    const Scene scene = parse_scene(replaced(small_scene, "{rpim: {ring: 1}}", "facets"), "s.yaml");
    EXPECT_TRUE(std::holds_alternative<FacetsSurface>(master(scene).surface));
}

/// yaml.org/type/merge.html: what a map says itself wins, then the first of several.
TEST(Reader, MergesMaps) {
    const std::string merged = replaced(replaced(small_scene, "{linear_elastic: {E: 30 MPa, nu: 0.2}}",
                                                 "{linear_elastic: &soil {E: 30 MPa, nu: 0.2, density: 2000 kg/m3}}"),
                                        "{E: 10 MPa, nu: 0.3}", "{<<: [{nu: 0.3}, *soil], E: 10 MPa}");
    const std::string written =
        replaced(replaced(small_scene, "{E: 30 MPa, nu: 0.2}", "{E: 30 MPa, nu: 0.2, density: 2000 kg/m^3}"),
                 "{E: 10 MPa, nu: 0.3}", "{E: 10 MPa, nu: 0.3, density: 2000 kg/m^3}");
    EXPECT_EQ(parse_scene(merged, "scene.yaml"), parse_scene(written, "scene.yaml"));
}

TEST(Reader, AcceptsTheSurfaceDirectlyUnderThePair) {
    const Scene scene = parse_scene(replaced(replaced(small_scene, ", surface: {rpim: {ring: 1}}", ""), "friction: 0.3",
                                             "surface: {rpim: {ring: 3}}"),
                                    "s.yaml");
    EXPECT_EQ(std::get<RpimSurface>(master(scene).surface).ring, 3);
}

TEST(Reader, MakesAxesOrthonormal) {
    const Scene scene =
        parse_scene(replaced(small_scene, "{fix: [x, y, z]}", "{fix: [x], axes: [[0, 2, 0], [1, 1, 0]]}"), "s.yaml");
    const Support& support = scene.supports.front().second;
    Mat3 expected;
    expected << 0, 1, 0, 1, 0, 0, 0, 0, -1;
    EXPECT_TRUE(support.axes.isApprox(expected, round_off)) << support.axes;
    EXPECT_EQ(support.fixed, (std::array{true, false, false}));
}

TEST(Reader, PutsTheMirrorsNormalFirst) {
    const Scene scene = parse_scene(replaced(small_scene, "{fix: [x, y, z]}", "{symmetry: [0, 3, 4]}"), "s.yaml");
    const Support& support = scene.supports.front().second;
    EXPECT_TRUE(support.symmetry);
    EXPECT_TRUE(support.axes.col(0).isApprox(Vec3(0, 0.6, 0.8), round_off));
    EXPECT_TRUE((support.axes.transpose() * support.axes).isIdentity(round_off));
    EXPECT_NEAR(support.axes.determinant(), 1, round_off);
}

TEST(Reader, ExpectsNothingUnlessTold) {
    EXPECT_FALSE(read_small().expect);
    EXPECT_FALSE(again(read_small()).expect);
    const Scene plain = read_small({{"expect", "{}"}});
    EXPECT_EQ(plain.expect, Expectation{});
    EXPECT_EQ(again(plain), plain);
    const Scene scene = read_small({{"expect", "{outcome: gives_up, cause: no support, penetration: 0.01}"}});
    ASSERT_TRUE(scene.expect);
    EXPECT_EQ(scene.expect->outcome, Outcome::gives_up);
    EXPECT_EQ(scene.expect->cause, "no support");
    EXPECT_EQ(scene.expect->penetration, 0.01);
    EXPECT_EQ(again(scene).expect, scene.expect);
}

TEST(Reader, FindsAMeshFileBesideTheScene) {
    const fs::path folder = fs::path(testing::TempDir()) / "scene_with_mesh";
    fs::create_directories(folder);
    std::ofstream(folder / "part.vtu") << "<VTKFile/>";
    std::ofstream(folder / "s.yaml") << replaced(small_scene, "{block: {origin: [0, 0, 1 m], size: [1 m, 1 m, 50 cm]}}",
                                                 "{file: {path: part.vtu}}");
    const Scene scene = read_scene((folder / "s.yaml").string());
    EXPECT_EQ(std::get<FileMesh>(scene.bodies[1].second.mesh.source).path, (folder / "part.vtu").lexically_normal());
    EXPECT_EQ(again(scene).bodies, scene.bodies);
}

TEST(Reader, FindsATemplateBesideTheScene) {
    const fs::path folder = fs::path(testing::TempDir()) / "scene_with_template";
    fs::create_directories(folder);
    std::ofstream(folder / "mine.yaml") << "history: [reactions]\nframe_every: 7\n";
    std::ofstream(folder / "s.yaml") << replaced(small_scene, "minimal", "mine");
    const Scene scene = read_scene((folder / "s.yaml").string());
    EXPECT_EQ(scene.output.frame_every, 7);
    EXPECT_FALSE(scene.output.history_pairs);
    EXPECT_EQ(again(scene).output, scene.output); // from another folder
}

TEST(Reader, FindsATemplateInTheFolderOfTheEnvironment) {
    const fs::path folder = fs::path(testing::TempDir()) / "templates_of_the_environment";
    fs::create_directories(folder);
    std::ofstream(folder / "elsewhere.yaml") << "frame_every: 3\n";
    ASSERT_EQ(setenv("OSCULATE_TEMPLATES", folder.c_str(), 1), 0);
    const Output output = parse_scene(replaced(small_scene, "minimal", "elsewhere"), "s.yaml").output;
    unsetenv("OSCULATE_TEMPLATES");
    EXPECT_EQ(output.frame_every, 3);
    EXPECT_EQ(output.template_name, "elsewhere");
}

TEST(Reader, DoesNotTakeASceneForATemplate) {
    const fs::path folder = fs::path(testing::TempDir()) / "scene_called_minimal";
    fs::create_directories(folder);
    std::ofstream(folder / "minimal.yaml") << small_scene;
    EXPECT_EQ(read_scene((folder / "minimal.yaml").string()).output.template_name, "minimal");
}

TEST(Overrides, ReplaceAndGoInside) {
    const auto ring = [](const std::vector<Override>& overrides) {
        return std::get<RpimSurface>(master(read_small(overrides)).surface).ring;
    };
    EXPECT_EQ(ring({{"contact.joint.master.surface", "{rpim: {ring: 3}}"}}), 3);
    EXPECT_EQ(ring({{"contact.joint.master.surface.rpim.ring", "3"}}), 3);
    EXPECT_EQ(ring({{"contact.joint.surface.rpim.ring", "2"}, {"contact.joint.surface.rpim.ring", "3"}}), 3);
    EXPECT_EQ(ring({{"contact.joint.surface", "rpim"}}), RpimSurface{}.ring);
}

TEST(Overrides, SwitchTheSurface) {
    for (const Override& change : {Override{"contact.joint.surface", "facets"},
                                   {"contact.joint.surface", "{facets: {}}"},
                                   {"contact.joint.surface.facets.hysteresis", "0.03"}})
        EXPECT_TRUE(std::holds_alternative<FacetsSurface>(master(read_small({change})).surface)) << change.value;
}

TEST(Overrides, MakeTheMapsOnTheirWay) {
    EXPECT_EQ(read_small({{"solver.max_iterations", "7"}}).solver.max_iterations, 7);
    EXPECT_EQ(read_small({{"bodies.cap.mesh.rotate.angle", "90 deg"}}).bodies[1].second.mesh.placement.angle,
              std::numbers::pi / 2);
}

TEST(Writer, GivesAnEqualSceneBack) {
    Scene scene = read_small({{"bodies.cap.mesh.rotate", "{axis: [1, 2, 0.1], angle: 33 deg}"},
                              {"bodies.cap.mesh.translate", "[0.1, 0.2, 0.3]"},
                              {"bodies.cap.hex_formulation", "incompatible_modes"},
                              {"sets.shell", "{body: cap, cylinder: {point: [0,0,0], axis: [0,0,1], radius: 0.1 mm}}"},
                              {"sets.corner", "{body: cap, box: {min: [0,0,0], max: [1,1,1]}}"},
                              {"sets.up", "{body: cap, normal: {direction: [0,0.1,1]}}"},
                              {"sets.nodes", "{body: cap, nodes: chosen}"},
                              {"supports.shell", "{axes: [[1, 2, 3], [1, 0.3, 1]], fix: [y]}"},
                              {"supports.corner", "{symmetry: [1, 2, 3]}"},
                              {"stages.hold", "{ramp: step}"},
                              {"solver", "{tolerance: 1e-7, predictor: false}"}});
    scene.description = "colon: \"quotes\" #\\ and\na second line";
    scene.stages.front().second.duration = 0.1 + 0.2; // needs 17 digits
    EXPECT_EQ(again(scene), scene) << write_scene(scene);
    EXPECT_EQ(write_scene(again(scene)), write_scene(scene));
}

TEST(Writer, GivesAxesBackToTheLastBit) {
    for (int i = 1; i <= 200; ++i) {
        const auto text = [&](int a) { return "[" + std::to_string(a) + ", " + std::to_string(7 - a) + ", 3.1]"; };
        const Scene scene = read_small({{"supports.top.symmetry", text(i)},
                                        {"supports.under.axes", "[" + text(i) + ", " + text(2 * i + 1) + "]"},
                                        {"stages.load.displacement", "{}"}});
        ASSERT_EQ(again(scene), scene) << write_scene(scene);
    }
}

TEST(Writer, FillsInEveryDefault) {
    const std::string text = write_scene(read_small());
    for (const char* line : {"closing_tolerance: 0.02", "hex_formulation: full", "ramp: linear", "E: 3.0e+07",
                             "smallest_step: 0.001", "coordinates: equal_length", "body_fields: [displacement]"})
        EXPECT_THAT(text, HasSubstr(line));
}

TEST(Keys, AreListedWithUnitRangeAndDefault) {
    EXPECT_EQ(describe_keys("bodies.tube.material.linear_elastic.E"),
              "bodies.<body>.material.linear_elastic.E\n    pressure in Pa, > 0; required. Young's modulus.\n");
    EXPECT_THAT(describe_keys("solver"),
                HasSubstr("solver.max_iterations\n    whole number, in [1, 1000]; default 30"));
    EXPECT_EQ(describe_keys("contact.p.surface.rpim"), describe_keys("contact.<pair>.master.surface.rpim"));
    EXPECT_THAT(describe_keys("solver"), HasSubstr("solver\n    map. Nonlinear solution."));
    EXPECT_EQ(describe_keys("no.such.key"), "");
}

TEST(Reading, AnAllowedInterpenetrationIsAFractionOrALength) {
    const std::string key = "stages.load.control.allowed_interpenetration";
    for (const auto& [text, value] :
         {std::pair{"0.02", RelativeLength{0.02, false}}, {"2 mm", RelativeLength{0.002, true}}}) {
        const Scene scene = parse_scene(small_scene, "good.yaml", {{key, text}});
        ASSERT_TRUE(scene.stages[0].second.control.allowed_interpenetration);
        EXPECT_EQ(*scene.stages[0].second.control.allowed_interpenetration, value);
        EXPECT_EQ(again(scene), scene) << text;
    }
}

/// Every scene that is shipped reads, and says the same after a round trip.
TEST(ShippedScenes, AreValid) {
    int count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(support::source_tree()) / "configs")) {
        if (entry.path().extension() != ".yaml" || entry.path().parent_path().filename() == "studies") continue;
        ++count;
        Scene scene = read_scene(entry.path().string());
        EXPECT_EQ(scene.name, entry.path().stem());
        scene.directory = fs::current_path().string();
        EXPECT_EQ(again(scene), scene) << entry.path();
    }
    EXPECT_GE(count, 20);
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
