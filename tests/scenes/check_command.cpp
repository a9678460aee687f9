/// What `osculate check` finds odd, which is no fault.

#include "scenes/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

class Check : public Program {
protected:
    /// What is said of a scene of the repository with changes; it is expected to be valid.
    std::string checked(const std::string& scene, const std::vector<std::string>& changes = {}) const {
        std::vector<std::string> arguments{"check", scene_file(scene)};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        const Outcome outcome = osculate(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return outcome.out;
    }
    Json as_json(const std::string& scene, const std::vector<std::string>& changes = {}) const {
        std::vector<std::string> arguments{"check", "--json", scene_file(scene)};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        const Outcome outcome = osculate(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return Json::parse(outcome.out);
    }
    const std::string press = "tests/scenes/press.yaml";
};

TEST_F(Check, SaysWhatProcessesWouldHold) {
    const auto asked = [&](const std::string& scene, const std::string& processes, bool json = false) {
        std::vector<std::string> words{"check", scene_file(scene), "--processes", processes};
        if (json) words.emplace_back("--json");
        return osculate(words);
    };
    EXPECT_THAT(asked(press, "2").out,
                AllOf(HasSubstr("2 processes, estimates of memory: "), HasSubstr("shared by nodes")));
    const auto of_one = [&](const std::string& processes) {
        return Json::parse(asked(press, processes, true).out).at("processes").at("memory_bytes_of_one").get<double>();
    };
    const double one = of_one("1"), two = of_one("2"), four = of_one("4");
    EXPECT_GT(two, four);
    EXPECT_NEAR(one - two, 2 * (two - four), 1e-9 * one); // what they share is halved
    EXPECT_EQ(asked(press, "0").code, 2);
}

TEST_F(Check, OfASoundSceneWarnsOfNothing) {
    for (const char* scene : {"tests/scenes/press.yaml", "configs/tutorials/bouncing_ball.yaml",
                              "configs/tutorials/two_bars.yaml", "configs/tutorials/ring_on_cylinder.yaml"})
        EXPECT_THAT(checked(scene), Not(HasSubstr("warning:"))) << scene;
}

TEST_F(Check, WarnsOfValuesThatAreWrongByPowersOfTen) {
    const std::string E = "bodies.cap.material.linear_elastic.E",
                      density = "bodies.cap.material.linear_elastic.density";
    const auto warning = [&](const std::string& change) { return checked(press, {change}); };
    EXPECT_THAT(warning(E + "=10 Pa"), HasSubstr("warning: " + E + ": 10 Pa: softer than any gel"));
    EXPECT_THAT(warning(E + "=2e12"), HasSubstr("warning: " + E + ": 2000 GPa: stiffer than diamond"));
    EXPECT_THAT(warning(density + "=0.5"), HasSubstr("warning: " + density + ": 0.5 kg/m^3: lighter"));
    EXPECT_THAT(warning(density + "=7.85e6"), HasSubstr("warning: " + density + ": 7.85e+06 kg/m^3: heavier"));
    EXPECT_THAT(warning("contact.joint.friction=30"), HasSubstr("warning: contact.joint.friction: 30: "));
    const auto heavy = [&](const std::string& gravity) {
        return checked(press, {gravity, density + "=2000", "bodies.base.material.linear_elastic.density=2000"});
    };
    EXPECT_THAT(heavy("gravity=[0, 0, -9810]"), HasSubstr("warning: gravity: 9810 m/s^2: on the Earth it is 9.81"));
    EXPECT_THAT(heavy("gravity=[0, 0, -1.62]"), Not(HasSubstr("warning:"))) << "the Moon";
    EXPECT_THAT(warning("stages.press.pressure.top=20 MPa"),
                HasSubstr("warning: stages.press.pressure.top: 2e+07 Pa on a body of E = 1e+07 Pa"));
    EXPECT_THAT(warning("stages.press.pressure.top={table: [[0 s, 0], [0.5 s, 20 MPa], [1 s, 0]]}"),
                HasSubstr("warning: stages.press.pressure.top: 2e+07 Pa"));
    EXPECT_THAT(checked(press, {"bodies.cap.mesh.scale=1e-5", "bodies.cap.mesh.translate=[0.5, 0.5, 1]"}),
                HasSubstr("bodies that differ in size by a factor of "));
}

/// The rear of the cap is 1 m from its front: held there, a pull of 2 m stretches it to three times its length.
TEST_F(Check, WarnsOfStrainsThatAreDriven) {
    const std::vector<std::string> front{"sets.front={body: cap, surface: x_max}", "supports.front={fix: [x]}"};
    auto torn = front;
    torn.push_back("stages.pull.displacement.rear.x=-2 m");
    EXPECT_THAT(checked(press, torn),
                HasSubstr("warning: stages.pull.displacement.rear.x: -2 m against front, which is 1 m away"));
    EXPECT_THAT(checked(press, front), Not(HasSubstr("warning:"))) << "0.1 m";
    EXPECT_THAT(checked(press, {"stages.pull.displacement.rear.x=20 m"}), Not(HasSubstr("warning:")))
        << "nothing holds it";
}

TEST_F(Check, ListsRigidMotionsThatNothingHolds) {
    // the cap's rear face is driven along x and lies flat on the base: y is left
    EXPECT_THAT(checked(press), HasSubstr("free: cap slides along y; friction alone can hold that\n"));
    EXPECT_THAT(checked(press, {"contact.joint.friction=0"}),
                HasSubstr("free: cap slides along y; neither supports nor contact hold that\n"));
    EXPECT_THAT(checked(press, {"sets.side_wall={body: cap, surface: y_min}", "supports.side_wall={fix: [y]}"}),
                Not(HasSubstr("free:")));
    EXPECT_THAT(
        checked(press, {"bodies.cap.mesh.translate=[0, 0, 3 m]"}),
        AllOf(HasSubstr("free: cap slides along y, slides along z, turns about the axis along x through (0.8, 0.95, "
                        "4.25) m; nothing holds that until contact is made\n")));
}

TEST_F(Check, FindsTheAxisThatABodyTurnsAbout) {
    // the contactor lies in the half-tube, whose axis is y through the origin
    EXPECT_THAT(
        checked("configs/paper/half_tube.yaml", {"contact.sliding.friction=0"}),
        testing::ContainsRegex("free: contactor turns about the axis along y through \\(0, 2\\.5, -?[0-9.e-]+\\) m; "
                               "neither supports nor contact hold that\n"));
    // one edge held: a hinge along it
    std::ofstream(folder / "hinge.yaml") << R"(bodies:
  plate:
    mesh: {block: {origin: [0, 0, -3], size: [9, 9, 1]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0}}
  door:
    mesh: {block: {origin: [1, 2, 0], size: [2, 3, 4]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0}}
sets:
  bed: {body: plate, surface: z_min}
  top: {body: plate, surface: z_max}
  sill: {body: door, surface: z_min}
  hinge: {body: door, box: {min: [0.9, 1.9, -9], max: [1.1, 2.1, 9]}}
supports:
  bed: {fix: [x, y, z]}
  hinge: {fix: [x, y, z]}
contact:
  gap: {slave: sill, master: {set: top}}
stages:
  wait: {}
)";
    EXPECT_THAT(osculate({"check", "hinge.yaml"}).out,
                HasSubstr("free: door turns about the axis along z through (1, 2, 2) m; nothing holds that until "
                          "contact is made\n"));
}

TEST_F(Check, SaysWhenBodiesAreFreeTogether) {
    // without the bed both bodies rest on one another and on nothing
    const std::string text =
        checked(press, {"supports.bed={fix: [x, y]}", "contact.joint.friction=0", "stages.pull.displacement={}"});
    EXPECT_THAT(text, HasSubstr("free: base, cap slides along z, as one"));
}

TEST_F(Check, NamesFacetsThatLookTheWrongWay) {
    // the cap's top as slave of the ground: its facets look up, as those of the ground do
    EXPECT_THAT(checked(press, {"contact.joint.slave=top"}),
                HasSubstr("warning: contact.joint.master.set: 9 of 9 slave facets do not face the master"));
    EXPECT_THAT(checked(press), Not(HasSubstr("look")));
}

TEST_F(Check, AdvisesToTakeTheSofterSideAsSlave) {
    const std::vector<std::string> turned{"contact.joint.slave=ground", "contact.joint.master.set=under",
                                          "contact.joint.discretisation=node"};
    EXPECT_THAT(checked(press, turned), HasSubstr("advice: the slave is 3 times as stiff as the master"));
    EXPECT_THAT(checked(press), Not(HasSubstr("as stiff as")));
}

TEST_F(Check, ListsOverlapsWithTheirPlaces) {
    const std::vector<std::string> sunk{"bodies.cap.mesh.block.origin=[0.3 m, 0.45 m, 0.99 m]"};
    EXPECT_THAT(
        checked(press, sunk),
        AllOf(HasSubstr("    node 0 of body 'cap' at (0.3, 0.45, 0.99) m overlaps facet 0 of the master by 0.01 m\n"),
              HasSubstr("    and 11 more\n")));
    const Json json = as_json(press, sunk);
    ASSERT_EQ(json["pairs"][0]["overlaps"].size(), 16u);
    EXPECT_EQ(json["pairs"][0]["overlaps"][0]["body"], "cap");
    EXPECT_NEAR(json["pairs"][0]["overlaps"][0]["depth"], 0.01, 1e-12);
    EXPECT_NEAR(json["pairs"][0]["overlaps"][0]["master_point"][2], 1, 1e-12);
}

TEST_F(Check, AsJsonHoldsTheSameFigures) {
    const Json json = as_json(press, {"contact.joint.friction=3"});
    EXPECT_EQ(json["scene"], "press");
    EXPECT_EQ(json["bodies"][1], (Json{{"name", "cap"}, {"nodes", 48}, {"elements", 18}}));
    EXPECT_EQ(json["dofs"], 272);
    EXPECT_EQ(json["unknowns"], 272 + 3 * 16);
    EXPECT_EQ(json["pairs"][0]["slave_nodes"], 16);
    EXPECT_EQ(json["free_motions"][0],
              (Json{{"bodies", "cap"}, {"motion", "slides along y"}, {"held_by", "friction"}}));
    EXPECT_EQ(json["warnings"][0]["key"], "contact.joint.friction");
    EXPECT_EQ(json["estimate"]["steps"], 4);
    EXPECT_GT(json["estimate"]["cpu_seconds"], 0);
    EXPECT_GT(json["estimate"]["memory_bytes"], 1e7);
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
