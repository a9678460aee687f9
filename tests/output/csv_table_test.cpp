#include "osculate/core/error.hpp"
#include "osculate/output/csv_table.hpp"
#include "output/temporary_folder.hpp"

#include <bit>
#include <cstdint>
#include <gmock/gmock.h>
#include <limits>
#include <random>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CsvFile : public InTemporaryFolder {};

/// Records and fields of a text as RFC 4180 defines them: an independent reader.
std::vector<std::vector<std::string>> parsed(const std::string& text) {
    std::vector<std::vector<std::string>> records(1);
    records.back().emplace_back();
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
            records.back().back() += text[++i];
        else if (c == '"')
            quoted = !quoted;
        else if (!quoted && c == ',')
            records.back().emplace_back();
        else if (!quoted && c == '\n')
            records.emplace_back(1);
        else
            records.back().back() += c;
    }
    records.pop_back(); // what follows the last line end
    return records;
}

TEST_F(CsvFile, DoublesReadBackBitByBit) {
    using Limits = std::numeric_limits<double>;
    std::vector<double> values{0.0,
                               -0.0,
                               0.1,
                               1 / 3.,
                               -1e-300,
                               1e22,
                               123456789012345678.0,
                               5e-324,
                               -2.5,
                               1e6,
                               1.0 + Limits::epsilon(),
                               Limits::max(),
                               Limits::min(),
                               -Limits::infinity()};
    std::mt19937_64 random(1);
    for (int i = 0; i < 1000; ++i) {
        const double value = std::bit_cast<double>(random());
        if (value == value) values.push_back(value);
    }
    CsvTable table(folder / "a.csv", {"value"});
    for (const double value : values) table.row({value});
    const auto records = parsed(content(folder / "a.csv"));
    ASSERT_EQ(records.size(), values.size() + 1);
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(records[i + 1][0].c_str(), nullptr)),
                  std::bit_cast<std::uint64_t>(values[i]))
            << records[i + 1][0];
}

TEST_F(CsvFile, NumbersTakeTheFewestDigits) {
    CsvTable table(folder / "a.csv", {"a", "b", "c", "d"});
    table.row({0.1, -3L, 1e-7, std::numeric_limits<long>::min()});
    EXPECT_EQ(content(folder / "a.csv"), "a,b,c,d\n0.1,-3,1e-07,-9223372036854775808\n");
}

TEST_F(CsvFile, StringsReadBackAsTheyWere) {
    const std::vector<std::string> texts{"plain", "",       "a,b", "say \"no\"", "two\nlines",
                                         "\r",    " edge ", "\"",  "pair.P.x"};
    CsvTable table(folder / "a.csv", texts);
    table.row({texts.begin(), texts.end()});
    const auto records = parsed(content(folder / "a.csv"));
    ASSERT_EQ(records.size(), 2U);
    EXPECT_EQ(records[0], texts);
    EXPECT_EQ(records[1], texts);
}

TEST_F(CsvFile, QuotesOnlyWhatNeedsIt) {
    CsvTable table(folder / "a.csv", {"pair.P.force_x", "a,b", "c"});
    table.row({std::string("accept"), std::string("say \"no\""), std::string("\r")});
    EXPECT_EQ(content(folder / "a.csv"), "pair.P.force_x,\"a,b\",c\naccept,\"say \"\"no\"\"\",\"\r\"\n");
}

TEST_F(CsvFile, EveryRowIsInTheFileAtOnce) {
    CsvTable table(folder / "deep" / "a.csv", {"n"});
    EXPECT_EQ(content(folder / "deep" / "a.csv"), "n\n");
    table.row({1L});
    EXPECT_EQ(content(folder / "deep" / "a.csv"), "n\n1\n");
}

TEST_F(CsvFile, StartsAnew) {
    { CsvTable(folder / "a.csv", {"old"}).row({1L}); }
    const CsvTable table(folder / "a.csv", {"new"});
    EXPECT_EQ(content(folder / "a.csv"), "new\n");
}

TEST_F(CsvFile, RejectsARowOfAnotherWidth) {
    CsvTable table(folder / "a.csv", {"a", "b"});
    EXPECT_THROW(table.row({1L}), InternalError);
    EXPECT_THROW(table.row({1L, 2L, 3L}), InternalError);
    EXPECT_EQ(content(folder / "a.csv"), "a,b\n");
}

TEST_F(CsvFile, ErrorNamesPathAndReason) {
    EXPECT_THAT(runtime_error_of([&] { const CsvTable table(folder, {"a"}); }),
                AllOf(HasSubstr(folder.string()), HasSubstr("Is a directory")));
    CsvTable table(folder / "a.csv", {"a"});
    const FullDisk full(8);
    EXPECT_THAT(runtime_error_of([&] { table.row({std::string(100, 'x')}); }),
                AllOf(HasSubstr("a.csv"), HasSubstr("File too large")));
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
