#include "osculate/output/progress.hpp"
#include "output/temporary_folder.hpp"

#include <cmath>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <memory>
#include <sys/ioctl.h>
#include <unistd.h>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class ProgressLine : public InTemporaryFolder {
protected:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    using File = std::unique_ptr<std::FILE, Close>;

    File file() const { return File(std::fopen((folder / "log").c_str(), "wb")); }
    std::string log() const { return content(folder / "log"); }
};

const ProgressStep first{1, 1, 1, 7, 221}, second{2, 2, 1, 2, 5};

TEST_F(ProgressLine, TellsTimeStepIterationsContactsAndEta) {
    EXPECT_EQ(progress_line({3, 4, 0.5, 2, 221}, 31, 540),
              "t 4/31 s, step 3, dt 0.5 s, Newton 2, contacts 221, ETA 0:09:00");
    EXPECT_THAT(progress_line({3, 2, 1, 2, 0}, 4, 7384), EndsWith("ETA 2:03:04"));
    EXPECT_THAT(progress_line({3, 4, 1, 2, 0}, 4, 0), EndsWith("ETA 0:00:00"));
}

TEST_F(ProgressLine, GivesNoEtaWhereNoneIsKnown) {
    for (const double rest : {std::nan(""), 1e10})
        EXPECT_THAT(progress_line({0, 0, 1, 2, 0}, 4, rest), Not(HasSubstr("ETA")));
    EXPECT_TRUE(std::isnan(Eta({{4, 4}}).rest(1, 100))) << "the first step may have cost anything";
}

TEST(Eta, CountsPlannedStepsNotTime) {
    Eta eta({{100, 2}, {1, 10}}); // a slow load in two steps, then ten quick ones
    EXPECT_EQ(eta.end(), 101);
    (void)eta.rest(50, 3);
    EXPECT_DOUBLE_EQ(eta.rest(100, 6), 30);
    EXPECT_DOUBLE_EQ(eta.rest(100.5, 21), 15);
    EXPECT_DOUBLE_EQ(eta.rest(101, 36), 0);
}

TEST(Eta, ForgetsHowTheRunBegan) {
    Eta eta({{1, 100}});
    (void)eta.rest(0.01, 50); // a dear first step
    double rest = 0;
    for (int k = 2; k <= 20; ++k) rest = eta.rest(0.01 * k, 50 + k);
    EXPECT_NEAR(rest, 80, 1e-9);
}

TEST_F(ProgressLine, IsALinePerStepWhenPiped) {
    const File stream = file();
    EXPECT_EQ(Progress::style_of(stream.get()), Progress::Style::plain);
    {
        Progress progress({{2, 2}}, Progress::style_of(stream.get()), stream.get());
        progress.update(first);
        EXPECT_THAT(log(), EndsWith("\n")) << "a reader has to wait for the line";
        progress.update(second);
    }
    EXPECT_THAT(log(), AllOf(HasSubstr("step 1,"), HasSubstr("step 2,"), Not(HasSubstr("\r")), Not(HasSubstr("\x1b"))));
    EXPECT_EQ(std::ranges::count(log(), '\n'), 2);
}

TEST_F(ProgressLine, ShowsAnyLineInPlaceOfTheLast) {
    const File stream = file();
    {
        Progress progress({{1, 1}}, Progress::Style::live, stream.get());
        progress.show("run 1/2");
        progress.show("run 2/2");
    }
    EXPECT_EQ(log(), "\rrun 1/2\x1b[K\rrun 2/2\x1b[K\n");
    Progress({{1, 1}}, Progress::Style::quiet, stream.get()).show("nothing");
    EXPECT_THAT(log(), Not(HasSubstr("nothing")));
}

TEST_F(ProgressLine, IsOneLineOnATerminal) {
    const File stream = file();
    {
        Progress progress({{2, 2}}, Progress::Style::live, stream.get());
        progress.update(first);
        progress.update(second);
        EXPECT_EQ(std::ranges::count(log(), '\n'), 0);
        EXPECT_EQ(std::ranges::count(log(), '\r'), 2);
        progress.finish();
        EXPECT_THAT(log(), EndsWith("\n"));
    }
    EXPECT_EQ(std::ranges::count(log(), '\n'), 1) << "finish() and the destructor both ended the line";
}

TEST_F(ProgressLine, SaysNothingWhenQuiet) {
    const File stream = file();
    {
        Progress progress({{2, 2}}, Progress::Style::quiet, stream.get());
        progress.update(first);
    }
    EXPECT_EQ(log(), "");
}

TEST_F(ProgressLine, NeverWrapsOnANarrowTerminal) {
    const int master = posix_openpt(O_RDWR | O_NOCTTY);
    if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0) GTEST_SKIP() << "no pseudo-terminal here";
    const File terminal(std::fopen(ptsname(master), "r+b"));
    ASSERT_NE(terminal, nullptr);
    constexpr unsigned short columns = 30;
    const winsize size{24, columns, 0, 0};
    ASSERT_EQ(ioctl(master, TIOCSWINSZ, &size), 0);
    EXPECT_EQ(Progress::style_of(terminal.get()), Progress::Style::live);
    Progress progress({{2, 2}}, Progress::Style::live, terminal.get());
    progress.update(first);
    std::string seen(4096, '\0');
    seen.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read(master, seen.data(), seen.size()))));
    progress.finish();
    close(master);
    EXPECT_THAT(seen, HasSubstr("step 1"));
    EXPECT_LT(seen.size(), columns + std::string("\r\x1b[K").size());
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
