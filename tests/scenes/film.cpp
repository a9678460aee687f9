/// `osculate film`: a run as MP4 or GIF, by gnuplot and ffmpeg.

#include "scenes/program.hpp"

#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;

bool installed(const std::string& program) {
    return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

class Film : public Program {
protected:
    /// What ffprobe says of a film's picture: width, height, and seconds of the whole.
    std::vector<double> measures(const std::string& film) const {
        const std::string command =
            "ffprobe -v error -select_streams v -show_entries stream=width,height:format=duration -of "
            "default=noprint_wrappers=1:nokey=1 " +
            (folder / film).string() + " >" + (folder / "measures.txt").string();
        if (std::system(command.c_str()) != 0) return {};
        std::istringstream text(content(folder / "measures.txt"));
        std::vector<double> values;
        for (double value = 0; text >> value;) values.push_back(value);
        return values;
    }
};

const std::string press = scene_file("tests/scenes/press.yaml");

TEST_F(Film, LastsAsLongAsAskedInEitherFormat) {
    if (!installed("ffmpeg") || !installed("gnuplot")) GTEST_SKIP() << "no ffmpeg or gnuplot here";
    run(press);
    const Outcome outcome = osculate({"film", "run", "--seconds", "2"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("run/film.mp4: "));
    const std::vector<double> mp4 = measures("run/film.mp4");
    ASSERT_EQ(mp4.size(), 3U);
    EXPECT_EQ(mp4[0], 1280);
    EXPECT_EQ(mp4[1], 860);
    EXPECT_NEAR(mp4[2], 2.6, 0.15) << "and 0.6 s of the end";
    ASSERT_EQ(osculate({"film", "run", "-o", "other.gif", "--field", "displacement", "--seconds", "1"}).code, 0);
    EXPECT_EQ(content(folder / "other.gif").substr(0, 6), "GIF89a");
    // the film in the run's folder is one of its files, the other is not
    EXPECT_THAT(content(folder / "run/osculate_manifest.txt"), HasSubstr("\nfilm.mp4\n"));
    run(press);
    EXPECT_FALSE(std::filesystem::exists(folder / "run/film.mp4")) << "of the run before";
}

TEST_F(Film, RefusesWhatItCannotShow) {
    run(press);
    const Outcome field = osculate({"film", "run", "--field", "von_misse"});
    EXPECT_EQ(field.code, 2);
    EXPECT_THAT(field.err,
                AllOf(HasSubstr("--field: expected a field of the bodies: "), HasSubstr("did you mean 'von_mises'?")));
    EXPECT_THAT(osculate({"film", "run", "-o", "film.avi"}).err, HasSubstr("a file that ends with .mp4 or .gif"));
    EXPECT_EQ(osculate({"film", "nowhere"}).code, 2);
    EXPECT_EQ(osculate({"run", press, "-o", "bare", "--quiet", "--set", "output.frame_every=0"}).code, 0);
    const Outcome bare = osculate({"film", "bare"});
    EXPECT_EQ(bare.code, 2);
    EXPECT_THAT(bare.err, AllOf(HasSubstr("a run with frames"), HasSubstr("output.frame_every")));
    const Outcome missing = osculate({"film", "run"}, [] { setenv("PATH", "/nowhere", 1); });
    EXPECT_EQ(missing.code, 2);
    EXPECT_THAT(missing.err, HasSubstr("gnuplot is not installed; a film needs it (Debian: gnuplot"));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
