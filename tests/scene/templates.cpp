/// Output templates: what they extend, and what is said of those that are wrong.

#include "osculate/core/error.hpp"
#include "osculate/scene/writer.hpp"
#include "scene_text.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class Templates : public testing::Test {
protected:
    Templates() { fs::create_directories(folder); }
    ~Templates() override { fs::remove_all(folder); }

    void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }

    /// The small scene with this output.
    [[nodiscard]] Scene read(const std::string& output) const {
        std::string text = small_scene;
        const std::size_t old = text.find("output:");
        if (old != std::string::npos) text.erase(old, text.find('\n', old) + 1 - old);
        write("scene.yaml", text + "\noutput: " + output + "\n");
        return read_scene((folder / "scene.yaml").string());
    }
    /// Every fault of it, a line each.
    [[nodiscard]] std::string faults(const std::string& output) const {
        try {
            (void)read(output);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "none";
    }

    const fs::path folder = fs::path(testing::TempDir()) / ("templates_" + std::to_string(getpid()));
};

TEST_F(Templates, ExtendOneAnotherAndTheSceneWins) {
    write("mine.yaml", "extends: base.yaml\nbody_fields: [strain]\nprobes: {top: {nodes: {set: top}}}\n");
    write("base.yaml", "extends: contact\nframe_every: 5\nslave_fields: [gap]\nbody_fields: [stress]\n"
                       "probes: {bed: {nodes: {set: bed}}, top: {nodes: {set: bed, reduce: [max]}}}\n");
    const Output output = read("{template: mine.yaml, frame_every: 2, probes: {cut: {section_force: "
                               "{body: cap, point: [0, 0, 1 m], normal: [0, 0, 2]}, every: 3}}}")
                              .output;
    EXPECT_THAT(output.body_fields, ElementsAre("strain")) << "its own";
    EXPECT_THAT(output.slave_fields, ElementsAre("gap")) << "of the one it extends";
    EXPECT_THAT(output.master_fields, ElementsAre("contact_force")) << "of the shipped one behind that";
    EXPECT_EQ(output.frame_every, 2) << "of the scene";
    ASSERT_EQ(output.probes.size(), 3U) << "probes add up, the last of a name holds";
    EXPECT_EQ(std::get<NodesProbe>(find(output.probes, "top")->kind).set, "top");
    EXPECT_THAT(std::get<NodesProbe>(find(output.probes, "top")->kind).reduce, ElementsAre("mean"));
    EXPECT_EQ(find(output.probes, "cut")->every, 3);
}

TEST_F(Templates, TheResolvedSceneReadsBackTheSame) {
    const Scene scene = read("{template: everything, probes: {a: {point: {body: cap, at: [0, 0, 1 m]}}, "
                             "b: {line: {body: base, from: [0, 0, 0], to: [1 m, 0, 0], samples: 7}}, "
                             "c: {contact_line: {pair: joint, from: [0, 0, 1 m], to: [1 m, 0, 1 m]}}, "
                             "d: {slave_nodes: {pair: joint, reduce: [mean, max, min, sum]}}}, "
                             "plots: {p: {title: \"a: b\", curves: {q: {rows: a, x: time, y: displacement_x, "
                             "where: time > 0, last: true}}}}}");
    EXPECT_TRUE(scene.output.report);
    EXPECT_TRUE(scene.output.paraview);
    EXPECT_EQ(parse_scene(write_scene(scene), "again.yaml").output, scene.output);
}

TEST_F(Templates, EveryShippedOneIsRead) {
    for (const char* name : {"minimal", "contact", "dynamics", "paper", "everything"})
        EXPECT_EQ(read(std::string("{template: ") + name + "}").output.template_name, name);
}

TEST_F(Templates, LeadBackToThemselvesInNoWay) {
    write("a.yaml", "extends: b.yaml\n");
    write("b.yaml", "frame_every: 2\nextends: a.yaml\n");
    const std::string text = faults("{template: a.yaml}");
    EXPECT_THAT(text, HasSubstr("b.yaml:2")) << "where the way closes";
    EXPECT_THAT(text, HasSubstr("a.yaml -> b.yaml -> a.yaml"));
    EXPECT_THAT(text, HasSubstr("extends"));
}

TEST_F(Templates, UnknownOnesAreNamedWithTheirNearest) {
    write("a.yaml", "extends: contacts\n");
    const std::string text = faults("{template: a.yaml}");
    EXPECT_THAT(text, HasSubstr("a.yaml:1"));
    EXPECT_THAT(text, HasSubstr("'contacts'"));
    EXPECT_THAT(text, HasSubstr("contact, dynamics, everything, minimal, paper"));
    EXPECT_THAT(text, HasSubstr("did you mean 'contact'"));
}

TEST_F(Templates, UnknownFieldsAndPlacesAreNamedWithTheirNearest) {
    write("a.yaml", "extends: minimal\nbody_fields: [stres]\nprobes:\n  tip: {point: {body: cup, at: [0, 0, 0]}}\n"
                    "  side: {contact_line: {pair: joints, from: [0, 0, 0], to: [1, 0, 0], fields: [gape]}}\n"
                    "  odd: {nodes: {set: tops, reduce: [median]}}\n");
    const std::string text = faults("{template: a.yaml}");
    for (const char* said : {"a.yaml:2", "did you mean 'stress'", "a.yaml:4", "did you mean 'cap'", "a.yaml:5",
                             "did you mean 'joint'", "did you mean 'gap'", "a.yaml:6", "did you mean 'top'", "median"})
        EXPECT_THAT(text, HasSubstr(said)) << "all at once";
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
