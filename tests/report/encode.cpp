#include "osculate/report/encode.hpp"

#include <gtest/gtest.h>
#include <string>

namespace osculate::report::OSCULATE_THIS_FILE {
namespace {

Bytes bytes(const std::string& text) {
    return {text.begin(), text.end()};
}

TEST(Encode, Base64IsThatOfRfc4648) {
    EXPECT_EQ(base64(bytes("")), "");
    EXPECT_EQ(base64(bytes("f")), "Zg==");
    EXPECT_EQ(base64(bytes("fo")), "Zm8=");
    EXPECT_EQ(base64(bytes("foo")), "Zm9v");
    EXPECT_EQ(base64(Bytes{0xfb, 0xff, 0xfe}), "+//+");
}

TEST(Encode, InflatingGivesBackWhatWasDeflated) {
    Bytes long_run(300000, 7); // more than one piece of the reader
    long_run[1234] = 8;
    for (const Bytes& original : {bytes(""), bytes("a"), long_run}) EXPECT_EQ(inflated(deflated(original)), original);
    EXPECT_LT(deflated(long_run).size(), 2000U);
}

TEST(Encode, BytesThatAreNotDeflatedAreRefused) {
    EXPECT_THROW((void)inflated(bytes("no such thing")), std::runtime_error);
    Bytes cut = deflated(bytes("a text that is cut in the middle"));
    cut.resize(cut.size() / 2);
    EXPECT_THROW((void)inflated(cut), std::runtime_error);
}

} // namespace
} // namespace osculate::report::OSCULATE_THIS_FILE
