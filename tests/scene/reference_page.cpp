/// docs/scene_reference.md and the scene in README.md say what the program does.

#include "osculate/scene/keys.hpp"
#include "osculate/scene/reader.hpp"
#include "support/source_tree.hpp"

#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <vector>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

std::ifstream page(const std::string& name) {
    return std::ifstream(support::source_tree() + "/" + name);
}

/// The text as a cell of a Markdown table.
std::string cell(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '|' || c == '<') escaped += '\\';
        escaped += c;
    }
    return escaped;
}

TEST(ReferencePage, ListsEveryKeyAsTheProgramDoes) {
    std::vector<std::string> expected, found;
    std::istringstream keys(describe_keys(""));
    for (std::string key, text; std::getline(keys, key) && std::getline(keys, text);) {
        text.erase(0, text.find_first_not_of(' '));
        const std::size_t stop = text.find(". ");
        expected.push_back("| `" + key + "` | " + cell(text.substr(0, stop)) + " | " + cell(text.substr(stop + 2)) +
                           " |");
    }
    std::ifstream file = page("docs/scene_reference.md");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("| `")) found.push_back(line);
    ASSERT_FALSE(expected.empty());
    EXPECT_THAT(found, testing::ElementsAreArray(expected)) << "scripts/pages/scene_reference writes the page anew";
}

TEST(Readme, HoldsASceneThatIsValid) {
    std::ifstream file = page("README.md");
    std::string text;
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
        if (line == "```") inside = false;
        if (inside) text += line + "\n";
        if (line == "```yaml") inside = true;
    }
    ASSERT_FALSE(text.empty());
    const Scene scene = parse_scene(text, "README.md");
    EXPECT_EQ(scene.contact.size(), 1u);
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
