#include "scene_text.hpp"

#include <filesystem>
#include <gmock/gmock.h>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Expects exactly one fault.
void expect_fault(const std::string& text, const std::string& message, const std::vector<Override>& overrides = {}) {
    EXPECT_THAT(messages(faults_of(text, overrides)), ElementsAre(message));
}

void expect_override_fault(const Override& change, const std::string& message) {
    expect_fault(small_scene, message, {change});
}

TEST(BadScene, TheUnspoiltOneHasNoFault) {
    EXPECT_THAT(messages(faults_of(small_scene)), IsEmpty());
}

TEST(BadScene, UnknownKeyNamesTheNearest) {
    const std::vector<Fault> faults = faults_of(replaced(small_scene, "friction: 0.3", "frcition: 0.3"));
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].file, "bad.yaml");
    EXPECT_EQ(faults[0].line, 19);
    EXPECT_EQ(faults[0].column, 5);
    EXPECT_EQ(faults[0].key, "contact.joint.frcition");
    EXPECT_EQ(
        faults[0].expected,
        "one of the keys slave, master, between, discretisation, friction, static_friction, pressure_overclosure, "
        "damping, tangential_damping, stick_stiffness, adjust, closing_tolerance, "
        "initial_overlap_limit, stiffness_scale");
    EXPECT_EQ(faults[0].found, "unknown key 'frcition'");
    EXPECT_EQ(faults[0].nearest, "friction");
}

TEST(BadScene, WrongUnit) {
    expect_fault(replaced(small_scene, "30 MPa", "3 m"), "bad.yaml:4:36: bodies.base.material.linear_elastic.E: "
                                                         "expected a pressure (Pa) > 0, found '3 m' (length)");
    expect_fault(replaced(small_scene, "30 MPa", "30 Mpa"),
                 "bad.yaml:4:36: bodies.base.material.linear_elastic.E: expected a pressure (Pa) > 0, found '30 Mpa' "
                 "(unknown unit 'Mpa') (did you mean 'MPa'?)");
}

TEST(BadScene, MissingNames) {
    expect_fault(replaced(small_scene, "set: ground", "set: gruond"),
                 "bad.yaml:18:19: contact.joint.master.set: expected the name of a set: bed, ground, under, top, found "
                 "'gruond' (did you mean 'ground'?)");
    expect_fault(replaced(small_scene, "body: base", "body: bases"),
                 "bad.yaml:9:15: sets.bed.body: expected the name of a body: base, cap, found 'bases' (did you mean "
                 "'base'?)");
    expect_fault(
        replaced(small_scene, "  bed: {fix", "  bde: {fix"),
        "bad.yaml:14:3: supports.bde: expected the name of a set: bed, ground, under, top, found 'bde' (did you "
        "mean 'bed'?)");
    expect_fault(replaced(small_scene, ", surface: z_min", ""),
                 "bad.yaml:9:8: sets.bed: expected one of surface, nodes, plane, cylinder, box, normal, node_numbers, "
                 "nearest, node, "
                 "found none");
}

TEST(BadScene, MissingAndDoubleKeys) {
    expect_fault(replaced(small_scene, "E: 30 MPa, ", ""), "bad.yaml:4:32: bodies.base.material.linear_elastic.E: "
                                                           "expected a pressure (Pa) > 0, found nothing");
    expect_fault(
        replaced(small_scene, "slave: under", "slave: under\n    friction: 0.1"),
        "bad.yaml:20:5: contact.joint.friction: expected every key once, found 'friction' again (first in line "
        "18)");
}

TEST(BadScene, ANameInPlaceOfAMasterIsThatOfItsSet) {
    const std::string master = "{set: ground, surface: {rpim: {ring: 1}}}";
    expect_fault(replaced(small_scene, master, "gruond"),
                 "bad.yaml:18:13: contact.joint.master.set: expected the name of a set: bed, ground, under, top, found "
                 "'gruond' (did you mean 'ground'?)");
    const Scene scene = parse_scene(replaced(small_scene, master, "ground"), "good.yaml");
    EXPECT_EQ(scene.contact.front().second.master.set, "ground");
    EXPECT_EQ(parse_scene(small_scene, "changed", {{"contact.joint.master", "top"}}).contact.front().second.master.set,
              "top");
}

TEST(BadScene, PairsHaveEitherRolesOrTwoSides) {
    const std::string roles = "    slave: under\n    master: {set: ground, surface";
    const std::string pair = "bad.yaml:17:5: contact.joint";
    expect_fault(replaced(small_scene, roles, "    between: [under, ground]\n    master: {set: ground, surface"),
                 "bad.yaml:18:19: contact.joint.master.set: expected between, or slave and master, found both");
    expect_fault(replaced(small_scene, roles, "    slave: under\n    between: [under, ground]\n    master: {surface"),
                 "bad.yaml:17:12: contact.joint.slave: expected between, or slave and master, found both");
    expect_fault(replaced(small_scene, roles, "    between: [under, under]\n    master: {surface"),
                 "bad.yaml:17:14: contact.joint.between: expected two sets, found 'under' twice");
    expect_fault(replaced(small_scene, roles, "    between: [under]\n    master: {surface"),
                 "bad.yaml:17:14: contact.joint.between: expected a list of the names of two sets, found a list of 1");
    expect_fault(replaced(small_scene, roles, "    between: [under, gruond]\n    master: {surface"),
                 "bad.yaml:17:22: contact.joint.between: expected the name of a set: bed, ground, under, top, found "
                 "'gruond' (did you mean 'ground'?)");
    expect_fault(replaced(small_scene, roles, "    master: {set: ground, surface"),
                 pair + ".slave: expected the name of a set, or between with two, found nothing");
    expect_fault(replaced(small_scene, roles, "    slave: under\n    master: {surface"),
                 "bad.yaml:18:13: contact.joint.master.set: expected the name of a set, or between with two, found "
                 "nothing");
    EXPECT_THAT(messages(faults_of(replaced(small_scene, roles, "    between: [under, ground]\n    master: {surface"))),
                IsEmpty());
}

TEST(BadScene, AnOverrideThatNamesASideReplacesTheOtherWay) {
    const Scene roles = parse_scene(small_scene, "roles", {{"contact.joint.between", "[ground, under]"}});
    EXPECT_EQ(roles.contact[0].second.slave, "");
    EXPECT_EQ(roles.contact[0].second.between[1], "under");
    const std::string sides = replaced(small_scene, "    slave: under\n    master: {set: ground, surface",
                                       "    between: [under, ground]\n    master: {surface");
    const Scene named =
        parse_scene(sides, "sides", {{"contact.joint.slave", "ground"}, {"contact.joint.master.set", "under"}});
    EXPECT_EQ(named.contact[0].second.slave, "ground");
    EXPECT_EQ(named.contact[0].second.between[0], "");
}

TEST(BadScene, NumbersOutOfRange) {
    expect_fault(replaced(small_scene, "30 MPa", "-30 MPa"), "bad.yaml:4:36: bodies.base.material.linear_elastic.E: "
                                                             "expected a pressure (Pa) > 0, found '-30 MPa'");
    expect_fault(replaced(small_scene, "nu: 0.2", "nu: 0.5"), "bad.yaml:4:48: bodies.base.material.linear_elastic.nu: "
                                                              "expected a number in (-1, 0.5), found '0.5'");
    expect_fault(replaced(small_scene, "steps: 2", "steps: 0"),
                 "bad.yaml:22:12: stages.load.steps: expected a whole number in [1, 1e+06], found '0'");
    expect_override_fault(
        {"contact.joint.surface.rpim.q", "2"},
        "--set: contact.joint.master.surface.rpim.q: expected a number in [-4, 3], not whole, found '2' (whole)");
}

TEST(BadScene, RadialBasisThatItsPolynomialsCannotCarry) {
    expect_override_fault({"contact.joint.surface", "{rpim: {q: 2.5, m: 3}}"},
                          "--set: contact.joint.master.surface.rpim.q: expected at most 2 with m = 3, found 2.5");
    expect_override_fault({"contact.joint.surface", "{rpim: {q: 0.5, R: 0}}"},
                          "--set: contact.joint.master.surface.rpim.q: expected more than 1 with R = 0, found 0.5");
    EXPECT_THAT(messages(faults_of(small_scene, {{"contact.joint.surface", "{rpim: {q: 2.5, R: 0}}"}})), IsEmpty());
}

TEST(BadScene, SyntaxStandsAlone) {
    expect_fault("bodies: [1, 2\nsets: 3: 4\n",
                 "bad.yaml:2:5: expected valid YAML, found end of sequence flow not found");
}

TEST(BadScene, TabsAndOpenQuotesAreNamed) {
    EXPECT_THAT(
        messages(faults_of(replaced(small_scene, "    slave: under", "\t    slave: under"))),
        testing::Contains("bad.yaml:17:1: expected valid YAML, found a tab in front of a line; YAML takes spaces"));
    EXPECT_THAT(messages(faults_of(replaced(small_scene, "bed: {body: base", "bed: {body: \"base"))),
                testing::Contains("bad.yaml:9:15: expected valid YAML, found a quote that this line does not close"));
}

TEST(BadScene, QuotesInCommentsAreNoSuspects) {
    EXPECT_THAT(messages(faults_of("# a 5\" pipe\nbodies: [1, 2 # of 5\"\nsets: 3: 4\n")),
                ElementsAre("bad.yaml:3:1: expected valid YAML, found end of sequence flow not found"));
}

TEST(BadScene, LongValuesAreCutShort) {
    const auto faults = faults_of(replaced(small_scene, "slave: under", "slave: " + std::string(100000, 'x')));
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_LT(faults.front().message().size(), 300u);
}

TEST(BadScene, MergesOfWhatIsNoMap) {
    expect_fault(replaced(small_scene, "    friction: 0.3", "    friction: 0.3\n    <<: 3"),
                 "bad.yaml:20:9: contact.joint.<<: expected a map to merge, or a list of maps, found something else");
}

TEST(BadScene, TextAfterTheDocument) {
    expect_fault(small_scene + "---\nname: second\n",
                 "bad.yaml:28:1: expected the end of the document, found more text");
    expect_fault(replaced(small_scene, "[2, 2, 1]}}", "[2, 2, 1]}}}"),
                 "bad.yaml:3:65: expected valid YAML, found illegal flow end");
    expect_fault("," + small_scene, "bad.yaml:1:1: expected the end of the document, found more text");
}

TEST(BadScene, NotANumber) {
    expect_fault(replaced(small_scene, "friction: 0.3", "friction: .nan"),
                 "bad.yaml:19:15: contact.joint.friction: expected a number >= 0, found '.nan' (not finite)");
    expect_fault(replaced(small_scene, "friction: 0.3", "friction: .inf"),
                 "bad.yaml:19:15: contact.joint.friction: expected a number >= 0, found '.inf' (not finite)");
}

TEST(BadScene, AbsurdSizes) {
    const std::string place = "bad.yaml:3:27: bodies.base.mesh.block.size: ";
    for (const char* size : {"0", "-2 m", "1e10 m", "1e-4 nm"})
        expect_fault(replaced(small_scene, "2 m", size),
                     place + "expected a list of three, each a length (m) in [1e-12, 1e+09], found '" + size + "'");
    expect_fault(replaced(small_scene, "[2, 2, 1]", "[5000, 5000, 1]"),
                 "bad.yaml:3:54: bodies.base.mesh.block.divisions: expected at most 2e+07 elements, found 2.5e+07");
}

TEST(BadScene, UnknownTemplate) {
    expect_fault(replaced(small_scene, "minimal", "minmal"),
                 "bad.yaml:27:20: output.template: expected an output "
                 "template: contact, dynamics, everything, minimal, paper, found 'minmal' (did you mean "
                 "'minimal'?)");
}

TEST(BadScene, NothingInIt) {
    EXPECT_THAT(messages(faults_of("")),
                ElementsAre("bad.yaml:1:1: bodies: expected a map of names, at least one, found "
                            "nothing",
                            "bad.yaml:1:1: stages: expected a map of names, at least one, found "
                            "nothing"));
}

TEST(BadScene, ParametersOfAnotherBasis) {
    expect_override_fault(
        {"contact.joint.surface", "{blend: {basis: r5, q: 1.5}}"},
        "--set: contact.joint.master.surface.blend.q: expected basis multiquadric with q, found another "
        "basis");
    expect_override_fault({"contact.joint.surface", "{rpim: {basis: r5, m: 3}}"},
                          "--set: contact.joint.master.surface.rpim.m: expected 6 with basis r5, found 3");
    EXPECT_THAT(messages(faults_of(small_scene, {{"contact.joint.surface", "{rpim: {basis: r3, m: 3}}"}})), IsEmpty());
}

TEST(BadScene, DynamicsWithoutMass) {
    const std::vector<std::string> faults =
        messages(faults_of(replaced(small_scene, "steps: 2", "steps: 2\n    analysis: dynamic")));
    ASSERT_EQ(faults.size(), 2u); // one a body
    EXPECT_THAT(faults[0],
                ::testing::HasSubstr("bodies.base.material: expected a density, which dynamic stage 'load' needs"));
}

TEST(BadScene, BoundsOfStepControl) {
    const std::string key = "stages.load.control.allowed_interpenetration",
                      expected =
                          ": expected a number in (0, 1], or a length (m) in [1e-12, 1e+09] with its unit, found ";
    EXPECT_THAT(faults_of(small_scene, {{key, "0.1"}}), IsEmpty());
    EXPECT_THAT(faults_of(small_scene, {{key, "2 mm"}}), IsEmpty());
    expect_override_fault({key, "1.5"}, "--set: " + key + expected + "'1.5'");
    expect_override_fault({key, "0 mm"}, "--set: " + key + expected + "'0 mm'");
    expect_override_fault({key, "2 s"}, "--set: " + key + expected + "'2 s' (time)");
    expect_override_fault({"stages.load.control.error_tolerance", "1 mm"},
                          "--set: stages.load.control.error_tolerance: expected a dynamic stage, found a static one");
}

TEST(BadScene, ExpectationsThatContradict) {
    expect_override_fault({"expect.cause", "no support"},
                          "--set: expect.cause: expected outcome gives_up with a cause, found outcome completed");
    expect_override_fault({"expect.outcome", "gave_up"}, "--set: expect.outcome: expected one of completed, gives_up, "
                                                         "found 'gave_up' (did you mean 'gives_up'?)");
    expect_override_fault({"expect.penetration", "0"}, "--set: expect.penetration: expected a number > 0, found '0'");
    EXPECT_THAT(messages(faults_of(small_scene, {{"expect", "{outcome: gives_up, cause: no support}"}})), IsEmpty());
}

TEST(BadScene, AllFaultsAtOnceInOrder) {
    std::string text = replaced(small_scene, "nu: 0.3", "nu: 3");
    text = replaced(text, "steps: 2", "stpes: 2");
    text = replaced(text, "top: 5 kPa", "tpo: 5 kN");
    text = replaced(text, "slave: under", "slave: ground");
    EXPECT_THAT(
        messages(faults_of(text, {{"solver.tolerance", "1"}})),
        ElementsAre(
            "bad.yaml:7:48: bodies.cap.material.linear_elastic.nu: expected a number in (-1, 0.5), found "
            "'3'",
            "bad.yaml:17:12: contact.joint.slave: expected another set than the master's, found 'ground' "
            "for both",
            "bad.yaml:22:5: stages.load.stpes: expected one of the keys analysis, duration, steps, control, ramp, "
            "displacement, pressure, follower_pressure, body_force, release, friction, pressure_overclosure, pairs, "
            "temperature, "
            "centrifugal, "
            "nodal_force, motion, "
            "force, moment, "
            "found unknown "
            "key 'stpes' "
            "(did "
            "you mean 'steps'?)",
            "bad.yaml:24:16: stages.load.pressure.tpo: expected the name of a set: bed, ground, under, "
            "top, found 'tpo' (did you mean 'top'?)",
            "bad.yaml:24:21: stages.load.pressure.tpo: expected a pressure (Pa), found '5 kN' (force)",
            "--set: solver.tolerance: expected a number in (0, 0.01], found '1'"));
}

TEST(BadScene, FaultInAnOverride) {
    expect_override_fault({"contact.joint.friction", "-0.1"},
                          "--set: contact.joint.friction: expected a number >= 0, found '-0.1'");
    expect_override_fault(
        {"contact.jiont.friction", "0.1"},
        "--set: contact.jiont: expected the name of a pair: joint, found 'jiont' (did you mean 'joint'?)");
    expect_override_fault({"contact.joint.friction", "[1"},
                          "--set: contact.joint.friction: expected valid YAML, found end of sequence flow not found");
    expect_override_fault({"contact..friction", "1"},
                          "--set: contact..friction: expected key.path=value, found 'contact..friction'");
    expect_override_fault({"contact.joint.ring", "1"},
                          "--set: contact.joint.ring: expected one of the keys slave, master, between, discretisation, "
                          "friction, static_friction, pressure_overclosure, "
                          "damping, tangential_damping, stick_stiffness, adjust, closing_tolerance, "
                          "initial_overlap_limit, stiffness_scale, found unknown key 'ring'");
}

TEST(BadScene, OptionOfAnotherChoice) {
    expect_override_fault(
        {"contact.joint.surface", "{facets: {ring: 1}}"},
        "--set: contact.joint.master.surface.facets.ring: expected one of the keys hysteresis, found unknown key "
        "'ring'");
    expect_fault(replaced(small_scene, "{rpim: {ring: 1}}", "{rpim: {}, facets: {}}"),
                 "bad.yaml:18:36: contact.joint.master.surface: expected only one of automatic, facets, rpim, blend, "
                 "found facets "
                 "and rpim");
    expect_fault(
        replaced(small_scene, "{rpim: {ring: 1}}", "{rpmi: {}}"),
        "bad.yaml:18:37: contact.joint.master.surface.rpmi: expected one of the keys automatic, facets, rpim, blend, "
        "found unknown "
        "key 'rpmi' (did you mean 'rpim'?)");
}

TEST(BadScene, SupportsThatContradict) {
    expect_fault(replaced(small_scene, "[x, y, z]", "[x, y, w]"),
                 "bad.yaml:14:21: supports.bed.fix: expected a list of x, y, z, found 'w'");
    expect_fault(replaced(small_scene, "{fix: [x, y, z]}", "{fix: [x], axes: [[1, 0, 0], [-2, 0, 0]]}"),
                 "bad.yaml:14:25: supports.bed.axes: expected a list of two directions that are not parallel, found "
                 "parallel directions");
    expect_override_fault({"supports.bed.symmetry", "[0, 0, 0]"},
                          "--set: supports.bed.symmetry: expected a list of three numbers, "
                          "not all zero, found a zero vector");
    expect_fault(replaced(small_scene, "top: {x: 1 mm}", "bed: {x: 1 mm}"),
                 "bad.yaml:26:29: stages.load.displacement.bed.x: expected a component that supports.bed leaves free, "
                 "found x, which is held");
}

TEST(BadScene, InterfacesThatCannotBe) {
    using testing::Contains;
    using testing::HasSubstr;
    EXPECT_THAT(messages(faults_of(replaced(small_scene, "friction: 0.3", "stick_stiffness: 1e9 N/m^3"))),
                ElementsAre(HasSubstr(
                    "contact.joint.stick_stiffness: expected friction above 0 beside it, found no friction")));
    const std::string soft =
        replaced(small_scene, "friction: 0.3", "pressure_overclosure: {linear: {stiffness: 1e9 N/m^3}}");
    EXPECT_THAT(messages(faults_of(soft)), IsEmpty());
    const auto table = [](const std::string& rows) {
        return replaced(small_scene, "friction: 0.3", "pressure_overclosure: {tabular: {table: " + rows + "}}");
    };
    EXPECT_THAT(messages(faults_of(table("[[-1 mm, 0 Pa], [0 mm, 1 MPa]]"))), IsEmpty());
    EXPECT_THAT(
        messages(faults_of(table("[[0 mm, 1 Pa], [1 mm, 1 MPa], [2 mm, 1 MPa]]"))),
        ElementsAre(HasSubstr("tabular.table: expected a first row without pressure, where it begins, found 1 Pa"),
                    HasSubstr("expected pressures that grow from row to row, found one of 1e+06 Pa that does not")));
    EXPECT_THAT(messages(faults_of(table("[[0 s, 0 Pa], [1 mm, 1 MPa]]"))), ElementsAre(HasSubstr("a length (m)")));
    EXPECT_THAT(messages(faults_of(table("[[0 mm, 0 Pa]]"))),
                ElementsAre(HasSubstr("two or more rows [overclosure (m), a pressure (Pa) >= 0]")));
    EXPECT_THAT(messages(faults_of(table("[[1 mm, 0 Pa], [0 mm, 1 MPa]]"))),
                ElementsAre(HasSubstr("overclosures that ascend, here more than 0.001 m")));
    EXPECT_THAT(messages(faults_of(soft, {{"stages.load.pressure_overclosure", "{joint: exact}"}})),
                ElementsAre(HasSubstr("expected a law that gives way, as that of the pair, found exact")));
    EXPECT_THAT(
        messages(faults_of(soft, {{"contact.joint.damping", "1 Pa s/m"}})),
        ElementsAre(HasSubstr("contact.joint.damping: expected none where no stage is dynamic, found 1 Pa s/m")));
    EXPECT_THAT(messages(faults_of(small_scene, {{"contact.joint.damping", "1 Pa s/m"}})),
                Contains(HasSubstr("expected a pressure_overclosure beside it that gives way, found exact contact")));
    EXPECT_THAT(messages(faults_of(small_scene, {{"contact.joint.tangential_damping", "1 Pa s/m"}})),
                ElementsAre(HasSubstr("contact.joint.tangential_damping: expected none where no stage is dynamic")));
    EXPECT_THAT(messages(faults_of(small_scene, {{"contact.joint.static_friction", "0.2"}})),
                ElementsAre(HasSubstr("contact.joint.static_friction: expected at least friction, 0.3, found 0.2")));
    EXPECT_THAT(messages(faults_of(replaced(small_scene, "friction: 0.3", "static_friction: 0.3"))),
                ElementsAre(HasSubstr("static_friction: expected friction above 0 beside it, found no friction")));
    const std::string two = replaced(small_scene, "friction: 0.3", "friction: 0.3\n    static_friction: 0.4");
    EXPECT_THAT(messages(faults_of(two)), IsEmpty());
    for (const char* other : {"0", "0.5"})
        EXPECT_THAT(messages(faults_of(two, {{"stages.load.friction", std::string("{joint: ") + other + "}"}})),
                    ElementsAre(HasSubstr("expected above 0, at most the pair's static_friction, 0.4")));
    const std::string slips = replaced(small_scene, "friction: 0.3", "friction: 0.3\n    stick_stiffness: 1e9 N/m^3");
    EXPECT_THAT(messages(faults_of(slips)), IsEmpty());
    EXPECT_THAT(messages(faults_of(slips, {{"stages.load.analysis", "dynamic"}})),
                Contains(HasSubstr("contact.joint.stick_stiffness: expected none where a stage is dynamic")));
}

TEST(BadScene, ShapesThatCannotBe) {
    expect_override_fault({"bodies.cap.mesh", "{contactor: {width: 7 m}}"},
                          "--set: bodies.cap.mesh.contactor.width: expected at most twice the radius, 6 m, found 7 m");
    expect_override_fault(
        {"bodies.cap.mesh.block", "{pattern: hybrid, element: tet4}"},
        "--set: bodies.cap.mesh.block.pattern: expected pattern hybrid with element hex8, found another element");
    for (const std::string element : {"tet4", "tet10"})
        expect_override_fault({"bodies.cap.mesh.block", "{pattern: triangle, element: " + element + "}"},
                              "--set: bodies.cap.mesh.block.pattern: expected pattern quad with element " + element +
                                  ", found another pattern");
    for (const std::string body : {"ball", "cylinder"})
        expect_override_fault({"bodies.cap.mesh", "{" + body + ": {divisions: [7, 4, 4]}}"},
                              "--set: bodies.cap.mesh." + body +
                                  ".divisions: expected an even number of elements around a quarter, found 7");
    expect_override_fault({"sets.top", "{body: cap, box: {min: [0, 0, 2], max: [1, 1, 1]}}"},
                          "--set: sets.top.box: expected min at most max in every component, found min above max");
}

TEST(BadScene, FilesThatAreNotThere) {
    const std::string part = (std::filesystem::current_path() / "part.vtu").string();
    expect_override_fault({"bodies.cap.mesh", "{file: {path: part.vtu}}"},
                          "--set: bodies.cap.mesh.file.path: expected a file that exists, found '" + part + "'");
    EXPECT_THROW(static_cast<void>(read_scene("no_such_scene.yaml")), SceneError);
}

/// Aliases of aliases: ten to the sixth values from six lines.
TEST(BadScene, BillionLaughs) {
    std::string text = "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
    for (char c = 'b'; c < 'i'; ++c) {
        const std::string last(1, static_cast<char>(c - 1)), name(1, c);
        text += name + ": &" + name + " [";
        for (int i = 0; i < 10; ++i) text += "*" + last + (i < 9 ? ", " : "]\n");
    }
    EXPECT_FALSE(faults_of(text).empty());
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
