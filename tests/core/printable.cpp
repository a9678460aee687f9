#include "osculate/core/printable.hpp"

#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using namespace std::string_view_literals;

TEST(Printable, ShowsControlCharactersOnOneLine) {
    EXPECT_EQ(printable("a\nb\tc\rd\x1b[31m\x7f"), "a\\nb\\tc\\rd\\x1b[31m\\x7f");
    EXPECT_EQ(printable("\0"sv), "\\x00");
    EXPECT_EQ(printable("µm, 3 %"), "µm, 3 %") << "bytes above ASCII are letters";
}

TEST(Printable, FindsTheFirstThatIsNotAllowed) {
    EXPECT_EQ(find_control("a\nb\tc"), 1U);
    EXPECT_EQ(find_control("a\nb\tc", "\n"), 3U);
    EXPECT_EQ(find_control("a\nb", "\n"), std::string_view::npos);
    EXPECT_EQ(find_control("a\0"sv), 1U);
    EXPECT_EQ(control_name('\n'), "a line break");
    EXPECT_EQ(control_name('\x1b'), "the character \\x1b");
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
