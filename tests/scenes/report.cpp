#include "scenes/program.hpp"
#include "support/found_in.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using support::found;
using support::missing;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string press = scene_file("tests/scenes/press.yaml");

class Report : public Program {
protected:
    static nlohmann::json data_of(const std::string& html) {
        const std::string open = "id=\"report-data\">";
        const std::size_t at = html.find(open) + open.size();
        return nlohmann::json::parse(html.substr(at, html.find("</script>", at) - at));
    }
    std::string page() const { return content(folder / "run/report.html"); }
};

TEST_F(Report, OfARunIsOneFileAndPicturesBesideIt) {
    run(press, {"output.iterations=true"});
    const Outcome outcome = osculate({"report", "run"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("run/report.html ("), HasSubstr(" MB)")));
    const std::string html = page();
    EXPECT_THAT(missing(html, {"Completed", "linear elastic (E 30 MPa, nu 0.2", "pressure of <b>top</b>: 100 kPa",
                               "osculate run press.yaml", "data-charts=\"contact\"", "data-charts=\"reactions\"",
                               "data-charts=\"residuals\""}),
                IsEmpty());
    for (const char* picture : {"start.png", "middle.svg", "end.png"})
        EXPECT_GT(std::filesystem::file_size(folder / "run/report" / picture), 1000U);
    const nlohmann::json data = data_of(html);
    EXPECT_EQ(data["view"]["times"], nlohmann::json({0, 1, 2, 3, 4}));
    EXPECT_EQ(data["view"]["parts"].size(), 4U); // two bodies, slave and master
    EXPECT_EQ(data["view"]["parts"][2]["body"], "cap");
    EXPECT_EQ(data["history"]["rows"], 4);
    EXPECT_EQ(data["stages"][1]["end"], 4);
}

TEST_F(Report, TheSceneInItRunsAgainWithItsChanges) {
    run(press, {"contact.joint.friction=0.2"});
    EXPECT_EQ(osculate({"report", "run"}).code, 0);
    const std::string html = page(), open = "<pre id=\"scene-yaml\">";
    const std::size_t at = html.find(open) + open.size();
    std::ofstream(folder / "again.yaml") << html.substr(at, html.find("</pre>", at) - at);
    EXPECT_EQ(osculate({"run", "again.yaml", "-o", "again", "--quiet"}).code, 0);
    EXPECT_EQ(content(folder / "again/history.csv"), content(folder / "run/history.csv"));
}

/// Where files lie on the machine of the run is nobody's business.
TEST_F(Report, NamesFilesWithoutTheirFolders) {
    std::filesystem::copy_file(scene_file("configs/tutorials/meshes/pad.vtu"), folder / "pad.vtu");
    std::ofstream(folder / "own.yaml") << "body_fields: [displacement]\nhistory: [reactions]\n";
    std::ofstream(folder / "pad.yaml") << R"(
bodies: {pad: {mesh: {file: {path: pad.vtu}}, material: {linear_elastic: {E: 1 MPa, nu: 0.3}}}}
sets: {bed: {body: pad, surface: under}, top: {body: pad, surface: top}}
supports: {bed: {fix: [x, y, z]}}
stages: {press: {pressure: {top: 1 kPa}}}
output: {template: own.yaml}
)";
    ASSERT_EQ(osculate({"run", "pad.yaml", "-o", "run", "--quiet"}).code, 0);
    EXPECT_EQ(osculate({"report", "run"}).code, 0);
    const std::string html = page();
    EXPECT_EQ(html.find(folder.string()), std::string::npos);
    EXPECT_THAT(missing(html, {"path: pad.vtu", "template: own.yaml", "<code>pad.vtu</code>, <code>own.yaml</code>"}),
                IsEmpty());
}

TEST_F(Report, OfARunWithoutFramesOrContactSaysWhatIsMissing) {
    run(press, {"output.frame_every=0", "output.history=[reactions]"});
    const Outcome outcome = osculate({"report", "run"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("no frames"), HasSubstr("no columns of contact pairs")));
    EXPECT_THAT(missing(page(), {"wrote no frames"}), IsEmpty());
    EXPECT_THAT(found(page(), {"id=\"viewer\"", "data-charts=\"contact\""}), IsEmpty());
}

TEST_F(Report, OfARunThatGaveUpShowsWhy) {
    EXPECT_EQ(osculate({"run", scene_file("tests/scenes/failures/no_support.yaml"), "-o", "run", "--quiet"}).code, 3);
    const Outcome outcome = osculate({"report", "run"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(missing(page(), {"Gave up", "Why the run gave up", "What to try", "<code>supports</code>"}), IsEmpty());
}

TEST_F(Report, OfARunThatWasEndedFromOutsideShowsWhatThereIs) {
    const std::filesystem::path files = run(press);
    std::string summary = content(files / "summary.json");
    summary.replace(summary.find("\"done\""), 6, "\"running\"");
    std::ofstream(files / "summary.json") << summary;
    std::ofstream(files / "steps.csv", std::ios::app) << "5,4.5,0.";
    std::ofstream(files / "history.csv", std::ios::app) << "5,0";
    const Outcome outcome = osculate({"report", "run"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(missing(page(), {"Not finished", "accepted up to 4 s"}), IsEmpty());
}

TEST_F(Report, AFolderThatIsNoRunIsRefused) {
    EXPECT_EQ(osculate({"report", "nowhere"}).err,
              "nowhere: expected the folder of a run, found nothing of that name\n");
    std::filesystem::create_directory(folder / "empty");
    const Outcome outcome = osculate({"report", "empty"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("summary.json"), HasSubstr("neither of them")));
    EXPECT_TRUE(std::filesystem::is_empty(folder / "empty"));
}

TEST_F(Report, APageThatCannotBeWrittenIsNamed) {
    run(press);
    std::filesystem::create_directories(folder / "run/report.html/in_the_way");
    const Outcome outcome = osculate({"report", "run"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("the report cannot be written"), HasSubstr("report.html")));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
