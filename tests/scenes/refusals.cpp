#include "scenes/program.hpp"

#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

struct Refusal {
    const char* scene;
    std::vector<const char*> lines; ///< one per fault: place, key and the words that matter
};

class BadScene : public Program, public testing::WithParamInterface<Refusal> {};

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST_P(BadScene, IsRefusedWithPlaceKeyAndReason) {
    const std::string path = scene_file("tests/scenes/bad/" + std::string(GetParam().scene) + ".yaml");
    for (const char* command : {"check", "run"}) {
        const Outcome outcome = osculate({command, path});
        EXPECT_EQ(outcome.code, 2);
        EXPECT_EQ(outcome.out, "");
        const std::vector<std::string> lines = lines_of(outcome.err);
        ASSERT_EQ(lines.size(), GetParam().lines.size()) << outcome.err;
        for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i], path + ":" + GetParam().lines[i]);
        EXPECT_FALSE(std::filesystem::exists(folder / "out")) << "a refused scene leaves files";
    }
}

INSTANTIATE_TEST_SUITE_P(
    All, BadScene,
    testing::Values(
        Refusal{
            "unknown_key",
            {"34:5: contact.joint.frcition: expected one of the keys slave, master, between, discretisation, friction, "
             "static_friction, pressure_overclosure, damping, tangential_damping, stick_stiffness, adjust, "
             "closing_tolerance, initial_overlap_limit, "
             "stiffness_scale, found "
             "unknown key 'frcition' (did you mean 'friction'?)"}},
        Refusal{"wrong_unit",
                {"9:27: bodies.base.material.linear_elastic.E: expected a pressure (Pa) > 0, found '30 m' (length)"}},
        Refusal{"missing_surface",
                {"19:33: sets.ground.surface: expected a surface or node set of body 'base' (it has x_max, x_min, "
                 "y_max, y_min, z_max, z_min), found 'z_mxa' (did you mean 'z_max'?)"}},
        Refusal{"negative_modulus",
                {"9:27: bodies.base.material.linear_elastic.E: expected a pressure (Pa) > 0, found '-30 MPa'"}},
        Refusal{"overlapping_bodies",
                {"29:3: contact.joint: expected bodies that overlap by less than 0.1 of the facet size at the start, "
                 "found an overlap of 0.2 m at slave node 0 of body 'cap', 0.4 of the facet size"}},
        Refusal{"empty_set",
                {"20:3: sets.under: expected at least one node of body 'cap', found an empty set: nothing lies "
                 "there"}},
        Refusal{
            "sections",
            {"10:22: bodies.base.hex_formulation: expected full or b_bar with a material at finite strain, found "
             "incompatible_modes",
             "12:19: bodies.base.sections.away.box: expected a min below its max in every component, found one that "
             "is not",
             "14:13: bodies.base.sections.both: expected only one of elements, box, found elements and box",
             "15:13: bodies.base.sections.none.material: expected a map of keys, found nothing",
             "21:7: bodies.tool.sections: expected a body that deforms, found a rigid one",
             "25:39: sets.few.node_numbers: expected a list, each a whole number in [0, 2147483647], found '0.5'"}},
        Refusal{"bad_yaml", {"7:82: expected valid YAML, found illegal flow end"}},
        Refusal{"unsupported_body",
                {"10:3: bodies.cap: expected supports or contact that hold the body, found free rigid-body motions: "
                 "add supports, or a contact pair that touches it"}},
        Refusal{"not_a_number",
                {"39:21: stages.press.pressure.top: expected a pressure (Pa), found '.nan' (not finite)"}},
        Refusal{"absurd_size",
                {"7:74: bodies.base.mesh.block.divisions: expected at most 2e+07 elements, found 6.4e+10",
                 "12:52: bodies.cap.mesh.block.size: expected a list of three, each a length (m) in [1e-12, 1e+09], "
                 "found '1e10 m'"}},
        Refusal{"twice_the_same_key",
                {"35:5: contact.joint.friction: expected every key once, found 'friction' again (first in line 34)"}},
        Refusal{"misspelt_unit",
                {"39:21: stages.press.pressure.top: expected a pressure (Pa), found '100 KPa' (unknown unit 'KPa') "
                 "(did you mean 'Pa'?)"}},
        Refusal{"missing_modulus",
                {"14:23: bodies.cap.material.linear_elastic.E: expected a pressure (Pa) > 0, found nothing"}},
        Refusal{"two_meshes",
                {"12:7: bodies.cap.mesh: expected only one of block, half_tube, contactor, ball, cylinder, tube, file, "
                 "cad, found block and ball"}},
        Refusal{"misspelt_surface",
                {"33:16: contact.joint.master.surface.belnd: expected one of the keys automatic, facets, rpim, blend, "
                 "found "
                 "unknown key 'belnd' (did you mean 'blend'?)"}},
        Refusal{"word_for_a_list", {"26:15: supports.side.fix: expected a list of x, y, z, found 'x'"}},
        Refusal{"number_for_a_vector",
                {"36:10: gravity: expected a list of three, each an acceleration (m/s^2) in [-1e+09, 1e+09], found "
                 "'-9.81 m/s^2'"}},
        Refusal{"half_a_step", {"42:12: stages.pull.steps: expected a whole number in [1, 1e+06], found '2.5'"}},
        Refusal{"key_one_level_too_high",
                {"46:1: pressure: expected one of the keys name, description, bodies, sets, imperfections, supports, "
                 "couplings, ties, "
                 "cyclic, equations, contact, "
                 "gravity, stages, solver, output, expect, found unknown key 'pressure'"}},
        Refusal{"incompressible",
                {"9:39: bodies.base.material.linear_elastic.nu: expected a number in (-1, 0.5), found '0.5'"}},
        Refusal{"unit_of_another_kind",
                {"44:58: stages.pull.displacement.rear.x.unit: expected a unit of length such as m, found 'kPa' "
                 "(pressure)"}},
        Refusal{"rigid_contradictions",
                {"6:19: bodies.base.rigid.mass: expected inertia beside a mass, found none",
                 "9:53: bodies.cap.rigid.centre: expected a mass beside a centre of mass, found none",
                 "14:5: bodies.bare: expected a material, or rigid: true, found neither",
                 "20:8: supports.bed: expected bodies.base.rigid.fix, which holds the whole body, found a set of rigid "
                 "body 'base'",
                 "22:12: contact.meeting: expected a side that deforms: two rigid bodies have no contact pressure of "
                 "their own, found two rigid bodies, 'cap' and 'base'",
                 "25:27: stages.push.displacement.under: expected stages.push.motion.cap, which moves the whole body, "
                 "found a set of rigid body 'cap'",
                 "27:16: stages.push.motion.cap.x: expected a component that bodies.cap.rigid.fix leaves free, found "
                 "x, which is held",
                 "28:13: stages.push.motion.soft: expected a rigid body or a coupling, found 'soft', which deforms",
                 "29:20: stages.push.moment.soft: expected a rigid body or a coupling, found 'soft', which deforms"}},
        Refusal{
            "coupled_twice",
            {"17:15: couplings.side.set: expected nodes that follow no other coupling: a node has one motion only, "
             "found a node at [0, 0, 1] m that follows couplings.head too",
             "18:16: couplings.hinge.set: expected nodes that are not all on one line, or `fix: [rx, ry, rz]`: "
             "nothing holds the turns about it, found 3 nodes on one line",
             "18:16: couplings.hinge.set: expected nodes that follow no other coupling: a node has one motion "
             "only, found a node at [1, 0, 1] m that follows couplings.head too",
             "13:3: supports.bed: expected nodes that follow no coupling, or one that keeps them there: add x, y, z, "
             "rx, ry, rz to couplings.side.fix, found a node at [0, 0, 0] m that follows couplings.side",
             "14:3: supports.left: expected nodes that follow no coupling, or one that keeps them there: add x, ry, "
             "rz to couplings.side.fix, found a node at [0, 0, 0] m that follows couplings.side",
             "14:3: supports.left: expected nodes that follow no coupling, or one that keeps them there: add x, ry, "
             "rz to couplings.head.fix, found a node at [0, 0, 1] m that follows couplings.head",
             "21:20: stages.push.displacement.top: expected nodes that follow no coupling: couplings.head.fix "
             "holds, stages.<stage>.motion.head drives them all, found a node at [0, 0, 1] m that follows "
             "couplings.head"}},
        Refusal{"coupling_contradictions",
                {"14:15: couplings.grip.set: expected a set of a body that deforms: bodies.tool.rigid has a reference "
                 "point for the whole body, found a set of rigid body 'tool'",
                 "15:9: couplings.soft: expected another name than that of a body: stages name both, found 'soft'",
                 "20:17: stages.push.motion.head.x: expected a component that couplings.head.fix leaves free, found "
                 "x, which is held",
                 "21:7: stages.push.motion.haed: expected the name of a body or coupling: tool, soft, grip, soft, "
                 "head, found 'haed' (did you mean 'head'?)",
                 "22:14: stages.push.moment.top: expected the name of a body or coupling: tool, soft, grip, soft, "
                 "head, found 'top'"}},
        Refusal{"rigid_surfaces",
                {"8:11: bodies.both.mesh: expected a mesh, or a rigid_surface, found both",
                 "10:22: bodies.both.rigid.density: expected mass and inertia: a rigid_surface has no volume, found a "
                 "density",
                 "12:20: bodies.loose.rigid_surface: expected rigid.mass and rigid.inertia, or `fix` or `motion` for "
                 "rz, in dynamic stage 'fall', found neither",
                 "15:5: bodies.bare: expected a mesh, or a rigid_surface, found neither",
                 "15:12: bodies.bare.rigid: expected a density or a mass, which dynamic stage 'fall' needs, found none",
                 "18:16: sets.part.body: expected a body with a mesh: contact.<pair>.master.rigid_surface names the "
                 "whole surface of 'loose', found a body with a rigid_surface",
                 "20:18: contact.touch.slave: expected another set than the master's, found 'under' for both",
                 "20:61: contact.touch.master.set: expected set or rigid_surface, found both",
                 "20:85: contact.touch.discretisation: expected node: gaps to a rigid surface are exact at the slave "
                 "nodes, and its pressure needs no averaging, found another one",
                 "21:49: contact.wrong.master.rigid_surface: expected a body with a rigid_surface, found 'soft', which "
                 "has a mesh: name a set of it as master.set"}},
        Refusal{"rigid_without_mass",
                {"6:12: bodies.tool.rigid: expected a density or a mass, which dynamic stage 'fall' needs, found "
                 "none"}}),
    [](const auto& test) { return std::string(test.param.scene); });

const std::string press = scene_file("tests/scenes/press.yaml");

class Refused : public Program {};

TEST_F(Refused, FaultOfAnOverrideNamesTheOption) {
    const Outcome outcome = osculate({"check", press, "--set", "sets.ground.surface=z_mxa"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, testing::StartsWith("--set: sets.ground.surface: expected a surface"));
}

TEST_F(Refused, SceneThatIsNotThere) {
    const Outcome outcome = osculate({"run", "nowhere.yaml"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "nowhere.yaml: expected a readable file, found No such file or directory\n");
}

TEST_F(Refused, CommandsThatMakeNoSense) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                      {"fly"},
                                                      {"run"},
                                                      {"run", press, "--sett", "a=1"},
                                                      {"run", press, "--set", "a"},
                                                      {"run", press, "--threads", "0"},
                                                      {"keys", "no.such.key"}}) {
        const Outcome outcome = osculate(arguments);
        EXPECT_EQ(outcome.code, 2) << testing::PrintToString(arguments);
        EXPECT_NE(outcome.err, "");
    }
}

TEST_F(Refused, OutputThatWouldReplaceTheSceneItself) {
    std::filesystem::copy(press, folder / "scene.yaml");
    const Outcome outcome = osculate({"run", "scene.yaml", "-o", "."});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, testing::HasSubstr("another output folder"));
    EXPECT_EQ(content(folder / "scene.yaml"), content(press));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
