/// No text leaves its string in a script of gnuplot.

#include "app/report/gnuplot.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <optional>
#include <random>
#include <sstream>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;

/// What gnuplot's manual says of a string in double quotes, and nothing of how the text was written: the text within, where
/// `line` is one such string from beginning to end; nothing where the string ends early, or late, or the shell gets a word.
std::optional<std::string> string_of(const std::string& line) {
    if (line.size() < 2 || line.front() != '"') return {};
    std::string text;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const char c = line[i];
        if (c == '\n' || c == '\0' || c == '`') return {}; // ends the line, the text, is a command
        if (c == '"') return i + 1 == line.size() ? std::optional(text) : std::nullopt;
        if (c != '\\') {
            text += c;
            continue;
        }
        if (++i == line.size()) return {};
        int code = 0, digits = 0;
        const int most = line[i] == '0' ? 4 : 3; // as gnuplot 5.4 reads them
        for (; digits < most && i < line.size() && line[i] >= '0' && line[i] <= '7'; ++digits, ++i)
            code = 8 * code + line[i] - '0';
        if (digits == 0) return {}; // \n and its like have no place here
        --i;
        text += static_cast<char>(code);
    }
    return {};
}

bool is_control(unsigned char c) {
    return c < 0x20 || c == 0x7f;
}

std::string without_control(std::string text) {
    for (char& c : text)
        if (is_control(static_cast<unsigned char>(c))) c = ' ';
    return text;
}

/// Bytes that mean something, digits behind them, and any.
std::string random_text(std::mt19937& random, bool any) {
    static const std::string special = "'\"\\`$%@{}#;!~0179ab \n\t\x1b";
    std::string text(std::uniform_int_distribution<std::size_t>(0, 24)(random), ' ');
    for (char& c : text)
        c = any ? static_cast<char>(std::uniform_int_distribution<int>(0, 255)(random))
                : special[std::uniform_int_distribution<std::size_t>(0, special.size() - 1)(random)];
    return text;
}

TEST(GnuplotText, NoTextLeavesItsString) {
    std::mt19937 random(20261123);
    for (int i = 0; i < 20000; ++i) {
        const std::string text = random_text(random, i % 2 == 0), written = gnuplot_text(text);
        ASSERT_EQ(string_of(written), without_control(text)) << written;
        ASSERT_TRUE(std::ranges::none_of(written, [](unsigned char c) { return is_control(c); })) << written;
        ASSERT_EQ(written.find_first_of("`@{}#'"), std::string::npos)
            << "means something to one who does not see quotes";
    }
}

TEST(GnuplotText, TheOracleSeesWhatLeavesItsString) {
    for (const char* wrong : {"\"a\" b\"", "\"a\\\"", "\"a", "\"a`date`\"", "\"a\n!date\"", "'a'", "\"a\\\"b\""})
        EXPECT_EQ(string_of(wrong), std::nullopt) << wrong;
    EXPECT_EQ(string_of("\"a\\042\\060b\""), "a\"0b");
    EXPECT_NE(string_of("\"a\\0421\""), "a\"1") << "a fourth digit counts";
}

/// gnuplot prints the texts into a file, as it would set them beside a plot.
TEST(GnuplotText, ComesBackFromGnuplotByteForByte) {
    std::string folder = (fs::temp_directory_path() / "osculate_gnuplot_XXXXXX").string();
    ASSERT_NE(mkdtemp(folder.data()), nullptr);
    std::vector<std::string> texts{"a label that ends in \\",
                                   "\\",
                                   "'",
                                   "'a",
                                   "a'",
                                   "''",
                                   "a''b",
                                   "\"",
                                   "\"a\"",
                                   "`date`",
                                   "$x",
                                   "%d %s",
                                   "@x",
                                   "{a",
                                   "a}",
                                   "# a",
                                   "\\n",
                                   "a\\'",
                                   "; !date",
                                   "'1",
                                   "\"2",
                                   "\\3",
                                   "#4",
                                   "",
                                   " a ",
                                   "\xc3\xa9\xc2\xb5"};
    std::mt19937 random(20261124);
    for (int i = 0; i < 2000; ++i) texts.push_back(random_text(random, false));
    std::string expected;
    {
        std::ofstream script(fs::path(folder) / "texts.gp", std::ios::binary);
        script << "set print 'out put'\n";
        for (const std::string& text : texts) {
            script << "set title " << gnuplot_text(text) << " noenhanced\nprint " << gnuplot_text(text) << "\n";
            expected += without_control(text) + "\n";
        }
    }
    const Gnuplot drawn = run_gnuplot(folder, "texts.gp");
    std::ifstream file(fs::path(folder) / "out put", std::ios::binary);
    std::ostringstream printed;
    printed << file.rdbuf();
    fs::remove_all(folder);
    if (drawn == Gnuplot::missing) GTEST_SKIP() << "no gnuplot here";
    EXPECT_EQ(drawn, Gnuplot::drawn);
    EXPECT_EQ(printed.str(), expected);
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
