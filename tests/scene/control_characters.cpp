/// Texts of scenes, templates, studies and --set hold no control characters: they reach terminals, tables and scripts.

#include "osculate/scene/study.hpp"
#include "osculate/scene/surface_study.hpp"
#include "scene_text.hpp"
#include "support/scene_file.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string with_plot(const std::string& title) {
    return replaced(small_scene, "iterations: true}",
                    "iterations: true,\n  plots: {force: {title: " + title + ", curves: {one: {y: time}}}}}");
}

TEST(ControlCharacters, AreRefusedInATextWithPlaceAndKey) {
    EXPECT_THAT(messages(faults_of(with_plot("\"forces\\n!touch mine\""))),
                ElementsAre("bad.yaml:28:26: output.plots.force.title: expected a text on one line, without control "
                            "characters, found 'forces\\n!touch mine' (a line break, 7. character)"));
    EXPECT_THAT(messages(faults_of(with_plot("'forces, kN $ % \\ µ'"))), IsEmpty());
}

TEST(ControlCharacters, AreAllOfThoseOfAscii) {
    for (int code = 0; code < 0x100; ++code) {
        const char digits[] = "0123456789abcdef";
        const std::string escape = {'\\', 'x', digits[code / 16], digits[code % 16]};
        const bool control = code < 0x20 || code == 0x7f;
        EXPECT_EQ(faults_of(with_plot("\"a" + escape + "\"")).empty(), !control) << escape;
    }
}

TEST(ControlCharacters, ButLineBreaksAreInADescription) {
    EXPECT_THAT(messages(faults_of("description: |\n  Two\n  lines.\n" + small_scene)), IsEmpty());
    EXPECT_THAT(
        messages(faults_of("description: \"a\\tb\"\n" + small_scene)),
        ElementsAre("bad.yaml:1:14: description: expected a text without control characters except line breaks, found "
                    "'a\\tb' (a tab, 2. character)"));
}

TEST(ControlCharacters, AreRefusedInNamesUnitsWordsAndLists) {
    for (const auto& [from, to] :
         {std::pair{"cap:\n", "\"cap\\t\":\n"}, std::pair{"30 MPa", "\"30\\tMPa\""},
          std::pair{"template: minimal", "template: \"minimal\\n\""},
          std::pair{"fix: [x, y, z]", "fix: [x, \"y\\0\", z]"}, std::pair{"friction: 0.3", "\"friction\\e\": 0.3"}})
        EXPECT_THAT(messages(faults_of(replaced(small_scene, from, to))),
                    Contains(HasSubstr("expected a text on one line, without control characters")))
            << to;
}

TEST(ControlCharacters, NeverReachATerminalThroughAFault) {
    for (const std::string& message : messages(faults_of(replaced(small_scene, "friction: 0.3", "\"\\e[2J\\n\": 0.3"))))
        EXPECT_THAT(message, Not(testing::ContainsRegex("[\x1b\n]")));
    for (const std::string& message : messages(faults_of(small_scene, {{"contact.jo\x1bint.friction", "0.3"}})))
        EXPECT_EQ(message, "--set: expected key.path=value without control characters, found "
                           "'contact.jo\\x1bint.friction'");
}

TEST(ControlCharacters, AreRefusedInOverrides) {
    EXPECT_THAT(
        messages(faults_of(small_scene, {{"output.plots", "{f: {x_label: \"a\\nb\", curves: {one: {y: time}}}}"}})),
        ElementsAre(HasSubstr("--set: output.plots: expected a text on one line")));
}

class ControlCharactersInFiles : public testing::Test {
protected:
    /// Faults of a study, or of what `read` else reads.
    static std::string said(const std::function<void()>& read) {
        try {
            read();
        } catch (const SceneError& error) {
            return error.what();
        }
        return {};
    }
};

constexpr const char* study_text = R"(title: Small
problem: |
  Two lines,
  in Markdown.
scene: small.yaml
axes:
  friction: {key: contact.joint.friction, values: [0.1, 0.2]}
quantities:
  force: {contact: joint, value: sum(force_z), reference: 1, label: LABEL}
)";

std::string study_file(const std::string& text) {
    support::scene_file("small.yaml", small_scene);
    return support::scene_file("study.yaml", text);
}

TEST_F(ControlCharactersInFiles, OfStudiesAreRefusedButForLinesOfMarkdown) {
    const auto faults = [](const std::string& text) { return said([&] { (void)read_study(study_file(text), {}); }); };
    EXPECT_EQ(faults(study_text), "");
    EXPECT_THAT(faults(replaced(study_text, "LABEL", "\"F\\n!date\"")),
                HasSubstr("study.yaml:9:69: quantities.force.label: expected a text on one line"));
    EXPECT_THAT(faults(replaced(study_text, "title: Small", "title: \"Small\\r\"")),
                HasSubstr("study.yaml:1:8: title: expected"));
    EXPECT_THAT(faults(replaced(study_text, "title: Small", "abscissa_label: \"a\\nb\"")),
                HasSubstr("abscissa_label: expected"));
    EXPECT_THAT(faults(replaced(study_text, "|\n  Two lines,\n  in Markdown.", "\"bold \\e[1m\"")),
                HasSubstr("study.yaml:2:10: problem: expected a text without control characters except line breaks"));
}

TEST_F(ControlCharactersInFiles, OfStudiesOfSurfacesAreRefused) {
    const std::string path = support::scene_file("surfaces.yaml", "title: \"a\\nb\"\n");
    EXPECT_THAT(said([&] { (void)read_surface_study(path, {"facets"}); }),
                HasSubstr("surfaces.yaml:1:8: title: expected"));
}

TEST_F(ControlCharactersInFiles, OfTemplatesAreRefused) {
    const std::string path =
        support::scene_file("mine.yaml", "plots: {f: {y_label: \"a\\n!b\", curves: {one: {y: time}}}}\n");
    EXPECT_THAT(messages(faults_of(replaced(small_scene, "template: minimal", "template: " + path))),
                Contains(HasSubstr("mine.yaml:1:22: plots.f.y_label: expected a text on one line")));
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
