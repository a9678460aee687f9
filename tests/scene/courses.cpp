/// Loads and motions that change over a stage, as a scene says them.

#include "osculate/scene/keys.hpp"
#include "osculate/scene/writer.hpp"
#include "scene_text.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* sine = "{expression: \"0.1*sin(2*pi*50*t)\", unit: mm}";
constexpr const char* rows = "{table: [[0 s, 0 m], [1 ms, 2 mm], [4 ms, -1 mm]]}";

/// The small scene with something else for its displacement of top.x.
std::string driven(const std::string& course) {
    return replaced(small_scene, "x: 1 mm", "x: " + course);
}

Course driven_course(const std::string& course) {
    return *parse_scene(driven(course), "s.yaml").stages.front().second.displacement.front().second[0];
}

void expect_fault(const std::string& text, const std::string& message) {
    EXPECT_THAT(messages(faults_of(text)), ElementsAre(message));
}

TEST(Table, IsLinearBetweenItsRowsAndConstantBeyond) {
    const auto f = driven_course(rows).function();
    const double round_off = 1e-18;
    EXPECT_EQ(f(0), 0);
    EXPECT_NEAR(f(0.5e-3), 1e-3, round_off);
    EXPECT_EQ(f(1e-3), 2e-3);
    EXPECT_NEAR(f(2e-3), 1e-3, round_off);
    EXPECT_EQ(f(4e-3), -1e-3);
    EXPECT_EQ(f(1), -1e-3);
    EXPECT_THAT(driven_course(rows).corners(), ElementsAre(0, 1e-3, 4e-3));
}

TEST(Expression, IsAFunctionOfTimeInItsUnit) {
    const auto f = driven_course(sine).function();
    const double round_off = 1e-18;
    for (const double t : {0.0, 1e-3, 7.3e-3, 60.0})
        EXPECT_NEAR(f(t), 1e-4 * std::sin(2 * std::numbers::pi * 50 * t), round_off);
    EXPECT_EQ(driven_course("{expression: \"t < 0.5 ? 1 : e\"}").function()(1), std::numbers::e);
    EXPECT_EQ(driven_course("{expression: -t^2}").function()(3), -9);
    EXPECT_THAT(driven_course(sine).corners(), IsEmpty());
}

TEST(Courses, StandForPressuresAndComponentsOfBodyForces) {
    std::string text = replaced(small_scene, "top: 5 kPa", "top: {table: [[0, 0], [1 s, 5 kPa]]}");
    text = replaced(text, "[0, 0, -2 kN/m^3]", "[0, 1 N/m^3, {expression: -t, unit: kN/m^3}]");
    const Stage stage = parse_scene(text, "s.yaml").stages.front().second;
    EXPECT_EQ(stage.pressure.front().second.function()(0.5), 2500);
    const auto& force = stage.body_force.front().second;
    EXPECT_EQ(force[0], 0.0);
    EXPECT_EQ(force[1], 1.0);
    EXPECT_EQ(force[2].function()(2), -2000);
}

TEST(Courses, SurviveARoundTrip) {
    std::string text = replaced(driven(sine), "top: 5 kPa", "top: {table: [[0, 0], [0.1 s, 3.3333 kPa]]}");
    text =
        replaced(text, "[0, 0, -2 kN/m^3]", "[0, {table: [[0, 1], [1e-3, 2]]}, {expression: \"t > 1 ? t : rint(t)\"}]");
    Scene scene = parse_scene(text, "s.yaml");
    const Scene again = parse_scene(write_scene(scene), "again.yaml");
    scene.name = again.name;
    EXPECT_EQ(again, scene) << write_scene(scene);
    EXPECT_THAT(write_scene(scene), HasSubstr("{expression: \"0.1*sin(2*pi*50*t)\", unit: mm}"));
}

TEST(Courses, AreReplacedByAnOverride) {
    const auto top = [](const std::vector<Override>& changes) {
        return *parse_scene(driven(rows), "s.yaml", changes).stages.front().second.displacement.front().second[0];
    };
    const std::string key = "stages.load.displacement.top.x";
    EXPECT_EQ(top({{key, "3 mm"}}), 3e-3);
    EXPECT_EQ(top({{key, "{expression: t}"}}).function()(2), 2);
    EXPECT_EQ(top({{key + ".expression", "t"}}).function()(2), 2);
    EXPECT_EQ(top({{key + ".table", "[[0, 1], [1, 3]]"}}).function()(0.5), 2);
}

TEST(Courses, AreInTheListOfKeys) {
    EXPECT_EQ(
        describe_keys("stages.s.pressure.top"),
        "stages.<stage>.pressure.<set>\n    pressure in Pa, or {table: [[time, value], ...]} or {expression: formula "
        "in t, unit: its unit}; required. Positive pushes into the body.\n");
}

TEST(BadCourse, Formula) {
    const std::string place = "bad.yaml:26:42: stages.load.displacement.top.x.expression: expected an expression in t, "
                              "the seconds since the stage's start, found ";
    expect_fault(driven("{expression: 0.1*sni(t)}"), place + "'0.1*sni(t)' (Unexpected token \"sni\" found at "
                                                             "position 4.) (did you mean 'sin'?)");
    expect_fault(driven("{expression: (t}"), place + "'(t' (Missing parenthesis)");
    expect_fault(driven("{expression: t = 2}"), place + "'t = 2' ('=' assigns; == compares)");
    expect_fault(driven("{expression: [t]}"), place + "a list of 1");
    for (const char* text : {"''", "\"t, 2*t\"", "t mm", "x", "\"'a'\""})
        EXPECT_EQ(faults_of(driven("{expression: " + std::string(text) + "}")).size(), 1u) << text;
}

TEST(BadCourse, Unit) {
    expect_fault(driven("{expression: t, unit: kN}"),
                 "bad.yaml:26:51: stages.load.displacement.top.x.unit: expected a unit of length such as m, found 'kN' "
                 "(force)");
    expect_fault(driven("{expression: t, unit: mn}"),
                 "bad.yaml:26:51: stages.load.displacement.top.x.unit: expected a unit of length such as m, found 'mn' "
                 "(unknown unit 'mn') (did you mean 'm'?)");
    expect_fault(
        driven("{table: [[0 s, 0 m], [1 mm, 2 mm]]}"),
        "bad.yaml:26:51: stages.load.displacement.top.x.table: expected a time (s) >= 0, found '1 mm' (length)");
    expect_fault(
        driven("{table: [[0 s, 0 m], [1 s, 2 Pa]]}"),
        "bad.yaml:26:56: stages.load.displacement.top.x.table: expected a length (m) in [-1e+09, 1e+09], found "
        "'2 Pa' (pressure)");
}

TEST(BadCourse, TimesThatDoNotAscend) {
    const std::string message = "stages.load.displacement.top.x.table: expected times that ascend, here more than 1 s, "
                                "found '1'";
    expect_fault(driven("{table: [[0, 0], [1, 1], [1, 2]]}"), "bad.yaml:26:55: " + message);
    EXPECT_EQ(faults_of(driven("{table: [[0, 0], [-1, 1]]}")).size(), 1u);
}

TEST(BadCourse, Shape) {
    const std::string expected = ": expected two or more rows [time (s), a length (m) in [-1e+09, 1e+09]], found ";
    expect_fault(driven("{table: [[0, 0]]}"),
                 "bad.yaml:26:37: stages.load.displacement.top.x.table" + expected + "a list of 1");
    expect_fault(driven("{table: [[0, 0], 3]}"),
                 "bad.yaml:26:46: stages.load.displacement.top.x.table" + expected + "'3'");
    expect_fault(driven("[0, 1]"), "bad.yaml:26:29: stages.load.displacement.top.x: expected a length (m) in [-1e+09, "
                                   "1e+09], or a map with table or expression, found a list of 2");
    expect_fault(driven("{tabel: [[0, 0], [1, 1]]}"),
                 "bad.yaml:26:30: stages.load.displacement.top.x.tabel: expected one of the keys table, expression, "
                 "found unknown key 'tabel' (did you mean 'table'?)");
    expect_fault(driven("{}"), "bad.yaml:26:29: stages.load.displacement.top.x: expected one of table, expression, "
                               "found none");
    expect_fault(driven("{expression: t, table: [[0, 0], [1, 1]]}"),
                 "bad.yaml:26:29: stages.load.displacement.top.x: expected only one of table, expression, found table "
                 "and expression");
}

/// Where it is evaluated in any case: at the ends of the stage's two steps of 30 s.
TEST(BadCourse, ValuesThatAreNone) {
    const std::string place = "bad.yaml:26:42: stages.load.displacement.top.x.expression: expected finite values in "
                              "[-1e+09, 1e+09] over the stage, found ";
    expect_fault(driven("{expression: sqrt(20-t)}"), place + "-nan at t = 30 s");
    expect_fault(driven("{expression: 1/(t-60)}"), place + "inf at t = 60 s");
    expect_fault(driven("{expression: 1e8*t}"), place + "3e+09 at t = 30 s");
    EXPECT_THAT(messages(faults_of(driven("{expression: 1/t}"))), IsEmpty()) << "statics asks for nothing at the start";
    expect_fault(
        replaced(small_scene, "-2 kN/m^3]", "{expression: 1/(t-30)}]"),
        "bad.yaml:25:43: stages.load.body_force.cap.expression: expected finite values over the stage, found inf "
        "at t = 30 s");
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
