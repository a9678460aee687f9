#include "osculate/core/escaped.hpp"

#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

TEST(Escaped, TextCannotLeaveItsElementOrAttribute) {
    EXPECT_EQ(escaped("<script>\"a\" & 'b'</script>"), "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;");
    EXPECT_EQ(escaped(std::string("a\0b\x1b\nc", 6)), "ab\nc");
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
