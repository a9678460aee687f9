#include "osculate/report/page.hpp"

#include "osculate/core/escaped.hpp"
#include "osculate/output/frames.hpp"
#include "osculate/report/pack.hpp"
#include "output/temporary_folder.hpp"
#include "output/two_blocks.hpp"
#include "support/found_in.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <regex>

namespace osculate::report::OSCULATE_THIS_FILE {
namespace {

using support::found;
using support::missing;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

class Page : public output::InTemporaryFolder {
protected:
    void file(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }

    /// The JSON that the page's scripts read.
    static nlohmann::json data_of(const std::string& html) {
        const std::string open = "id=\"report-data\">";
        const std::size_t at = html.find(open) + open.size();
        return nlohmann::json::parse(html.substr(at, html.find("</script>", at) - at));
    }
    static time::Attempt attempt(time::Verdict verdict, const std::string& body, double value) {
        time::Attempt a;
        a.attempt = 1;
        a.time = a.dt = 1;
        a.verdict = verdict;
        a.body = body;
        a.value = value;
        return a;
    }
    /// The page without the browser libraries.
    static std::string own_part(const std::string& html) { return html.substr(0, html.find("id=\"report-data\"")); }

    static constexpr const char* summary = R"({"version": "0.1.0", "scene": "two", "status": "done", "dofs": 1234567,
        "bodies": [{"name": "base", "nodes": 12, "elements": 2}], "pairs": [], "steps": {"accepted": 3, "rejected": 1},
        "iterations": 9, "seconds": {"total": 2, "cpu": 1.5, "solve": 0.5}, "threads": 2, "plan": ["frames"]})";
    PageOptions options;
};

TEST_F(Page, TellsWhatTheRunWas) {
    file("summary.json", summary);
    const std::string html = make_page(folder, options).html;
    EXPECT_THAT(missing(html, {"<title>two", "Completed", "1\u202f234\u202f567", "25.0 %", "There is no contact"}),
                IsEmpty());
}

/// The command is the one that was given; results depend on the number of processes, not of threads.
TEST_F(Page, TellsWhatProcessesHad) {
    auto of_two = nlohmann::json::parse(summary);
    of_two["processes"] = nlohmann::json::parse(R"([
        {"nodes": 7, "elements": 1, "slave_nodes": 0, "peak_memory_bytes": 93000000, "shared_memory_bytes": 21000000},
        {"nodes": 5, "elements": 1, "slave_nodes": 0, "peak_memory_bytes": 88000000, "shared_memory_bytes": 21000000}])");
    file("summary.json", of_two.dump());
    file("scene.yaml", "bodies: {}\n");
    const std::string html = own_part(make_page(folder, options).html);
    EXPECT_THAT(missing(html, {"Peak memory of the first process", "88 MB", "21 MB",
                               "mpirun -n 2 osculate run two.yaml -o out/two --threads 2 --distributed",
                               "another number of processes"}),
                IsEmpty());
    EXPECT_THAT(html, Not(HasSubstr("any number of threads")));
    file("summary.json", summary);
    EXPECT_THAT(own_part(make_page(folder, options).html),
                AllOf(HasSubstr("any number of threads"), Not(HasSubstr("mpirun"))));
}

TEST_F(Page, NamesCannotBecomeMarkup) {
    const std::string evil = "</script><script>alert(1)</script><!--";
    nlohmann::json json = nlohmann::json::parse(summary);
    json["scene"] = evil;
    json["failure"] = evil;
    json["bodies"][0]["name"] = evil;
    json["pairs"] = {{{"name", evil}, {"surface", evil}, {"slave_nodes", 1}, {"master_facets", 1}}};
    file("summary.json", json.dump());
    file("scene.yaml", evil);
    file("history.csv", "time,pair." + evil + ".normal\n1,2\n");
    options.attempts = {attempt(time::Verdict::retry, evil, 0)};
    options.diary = evil;
    options.notes = {evil};
    const std::string html = make_page(folder, options).html;
    EXPECT_THAT(found(html, {evil, "<script>alert"}), IsEmpty());
    EXPECT_EQ(data_of(html)["history"]["names"][1], "pair." + evil + ".normal");
    EXPECT_EQ(data_of(html)["attempts"]["rejected"][0][5], evil);
}

TEST_F(Page, WhatIsNoTextIsStillWritten) {
    file("summary.json", summary);
    options.attempts = {attempt(time::Verdict::retry, "a\xff\xfe", 0)};
    EXPECT_EQ(data_of(make_page(folder, options).html)["attempts"]["rejected"].size(), 1U);
}

TEST_F(Page, HoldsNoNumbersThatAreNone) {
    file("summary.json", summary);
    file("history.csv", "time,dt,energy.kinetic\n1,1,\n2,1,inf\n");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    options.attempts = {attempt(time::Verdict::give_up, "", nan)};
    const std::string html = make_page(folder, options).html;
    const std::string json = data_of(html).dump(), words = own_part(html);
    EXPECT_THAT(found(json, {"nan", "inf"}), IsEmpty());
    EXPECT_TRUE(data_of(html)["attempts"]["rejected"][0][7].is_null());
    std::smatch match;
    EXPECT_FALSE(std::regex_search(words, match, std::regex(R"([ >]-?(nan|inf)[ <])")))
        << match.prefix().str().substr(match.prefix().length() - 80);
}

TEST_F(Page, AsksForNothingElsewhere) {
    file("summary.json", summary);
    const std::string html = make_page(folder, options).html;
    const std::regex asks(R"((src|href|url|action|poster|data)\s*[=(]\s*["']?\s*(https?:)?//)");
    EXPECT_FALSE(std::regex_search(own_part(html), asks));
    EXPECT_THAT(found(html, {"<link rel=\"stylesheet\"", "<script src"}), IsEmpty());
}

TEST_F(Page, NamesWhatIsMissing) {
    file("summary.json", R"({"scene": "two", "status": "running"})");
    const report::Page page = make_page(folder, options);
    EXPECT_THAT(page.notes, AllOf(Contains(HasSubstr("had not ended")), Contains(HasSubstr("no frames")),
                                  Contains(HasSubstr("history.csv is missing")), Contains(HasSubstr("scene.yaml"))));
    for (const std::string& note : page.notes) EXPECT_THAT(missing(page.html, {escaped(note)}), IsEmpty());
    EXPECT_THAT(missing(page.html, {"Not finished"}), IsEmpty());
}

TEST_F(Page, OfARunWithoutASummaryShowsTheRest) {
    file("history.csv", "time,dt\n1,1\n2,1\n3,"); // the last row is not whole
    const report::Page page = make_page(folder, options);
    EXPECT_THAT(page.notes, Contains(HasSubstr("summary.json is missing")));
    EXPECT_EQ(data_of(page.html)["history"]["rows"], 2);
}

TEST_F(Page, ADamagedSummaryIsNamed) {
    file("summary.json", "{\"scene\": ");
    EXPECT_THAT(output::runtime_error_of([&] { (void)make_page(folder, options); }), HasSubstr("summary.json"));
}

/// Text of the script that holds an array.
Bytes array_of(const std::string& html, const std::string& name) {
    const std::string open = "id=\"" + name + "\">";
    const std::size_t at = html.find(open) + open.size();
    const std::string text = html.substr(at, html.find("</script>", at) - at);
    const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    Bytes bytes;
    unsigned word = 0;
    int bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        word = word << 6 | static_cast<unsigned>(letters.find(c));
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<std::uint8_t>(word >> bits & 255U));
    }
    return bytes;
}

class PageOfFrames : public Page {
protected:
    /// Frames in which the cap has moved by so many shifts. @param noise  of every node's own, m
    void write(int frames, double noise = 0) {
        file("summary.json", summary);
        output::Frames files(folder, {{"displacement"}, {"gap"}, {}}, blocks.model);
        for (int f = 0; f < frames; ++f) {
            blocks.state.time = f;
            for (Index i = 0; i < blocks.model.bodies[1].nodes(); ++i)
                blocks.state.u[blocks.model.bodies[1].first_node + i] =
                    f * output::TwoBlocks::shift + noise * std::sin(7. * f * (i + 1)) * Vec3::Ones();
            files.write(blocks.snapshot(), f);
        }
        files.finish();
    }
    output::TwoBlocks blocks;
};

TEST_F(PageOfFrames, ItsArraysAreTheFields) {
    write(3);
    const std::string html = make_page(folder, options).html;
    const nlohmann::json cap = data_of(html)["view"]["parts"][1], field = cap["fields"][0];
    EXPECT_EQ(cap["name"], "cap");
    EXPECT_EQ(field["name"], "displacement");
    EXPECT_EQ(field["unit"], "m");
    const Packed packed{field["low"], field["step"], array_of(html, field["array"])};
    const FieldFrames values = unpack(packed, 3, cap["size"]);
    for (std::size_t f = 0; f < 3; ++f)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(values.frames[f][static_cast<std::size_t>(c)],
                        static_cast<double>(f) * output::TwoBlocks::shift[c], 1e-6);
    const Bytes facets = inflated(array_of(html, cap["facets"]));
    EXPECT_EQ(facets.size(), 10 * 4 * 4U);
}

TEST_F(PageOfFrames, ThatIsTooLargeHoldsFewerFramesAndSaysSo) {
    write(40, 0.01);
    options.largest_view = 5000;
    const report::Page page = make_page(folder, options);
    EXPECT_THAT(page.notes, Contains(HasSubstr("of 40 frames, so that the page can be mailed")));
    const nlohmann::json view = data_of(page.html)["view"];
    EXPECT_LT(view["times"].size(), 40U);
    EXPECT_EQ(view["times"].back(), 39);
    EXPECT_EQ(page.pictures.size(), 6U); // start, middle and end, each as PNG and SVG
}

TEST_F(Page, PlotsOfTheSceneHoldTheirCurves) {
    file("scene.yaml", R"(
bodies: {a: {mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [1, 1, 1]}}, material: {linear_elastic: {E: 1 MPa, nu: 0.3}}}}
stages: {s: {}}
output:
  plots:
    sag_of_a: {x_label: "x, m", y_label: "sag, m", curves: {line: {y: dt}}}
    torn: {curves: {line: {y: dt}}}
    never_drawn: {curves: {line: {y: dt}}}
)");
    std::filesystem::create_directories(folder / "plots");
    file("plots/sag_of_a.csv", "curve,x,y\n\"at \"\"a\"\", early\",0,1\n\"at \"\"a\"\", early\",1,\nlate,0,0.5\n");
    file("plots/torn.csv", "curve,x,y\nline,0,o\n");
    const report::Page page = make_page(folder, options);
    const nlohmann::json plots = data_of(page.html)["plots"];
    ASSERT_EQ(plots.size(), 1U) << "one has no points, one cannot be read";
    EXPECT_EQ(plots[0]["title"], "sag of a");
    EXPECT_EQ(plots[0]["y_label"], "sag, m");
    ASSERT_EQ(plots[0]["curves"].size(), 2U);
    EXPECT_EQ(plots[0]["curves"][0]["name"], "at \"a\", early");
    const Bytes points = inflated(array_of(page.html, plots[0]["curves"][0]["array"]));
    ASSERT_EQ(points.size(), 4 * sizeof(float));
    std::array<float, 4> values;
    std::memcpy(values.data(), points.data(), points.size());
    EXPECT_EQ(std::vector<float>(values.begin(), values.begin() + 3), (std::vector<float>{0, 1, 1}));
    EXPECT_TRUE(std::isnan(values[3])) << "a gap";
    EXPECT_THAT(page.notes, Contains(HasSubstr("plots/torn.csv cannot be read: line 2: 'o' is no number")));
    EXPECT_THAT(missing(page.html, {"Plots of the scene"}), IsEmpty());
}

/// A scene with a probe along a line of three samples, one along an arc of two, and one that lies along no path.
constexpr const char* paths_scene = R"(
bodies:
  a: {mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [1, 1, 1]}}, material: {linear_elastic: {E: 1 MPa, nu: 0.3}}}
  b: {mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [1, 1, 1]}}, material: {linear_elastic: {E: 1 MPa, nu: 0.3}}}
sets: {top: {body: a, surface: z_max}, under: {body: b, surface: z_min}}
contact: {p: {between: [top, under], friction: 0}}
stages: {s: {}}
output:
  probes:
    depth: {line: {body: a, from: [0 m, 0 m, 0 m], to: [0 m, 0 m, 1 m], samples: 3}}
    rim: {contact_arc: {pair: p, centre: [0 m, 0 m, 0 m], axis: [0, 0, 1], from: [1 m, 0 m, 0 m], samples: 2}}
    corner: {point: {body: a, at: [0 m, 0 m, 0 m]}}
    torn: {line: {body: a, from: [0 m, 0 m, 0 m], to: [0 m, 0 m, 1 m], samples: 2}}
    never_written: {line: {body: a, from: [0 m, 0 m, 0 m], to: [0 m, 0 m, 1 m]}}
)";

class PageOfPaths : public Page {
protected:
    PageOfPaths() {
        file("scene.yaml", paths_scene);
        std::filesystem::create_directories(folder / "probes");
    }
    static FieldFrames values(const std::string& html, const nlohmann::json& path, std::size_t field) {
        const nlohmann::json& one = path["fields"][field];
        return unpack({one["low"], one["step"], array_of(html, one["array"])}, path["times"].size(), path["size"]);
    }
    static std::vector<float> places(const std::string& html, const nlohmann::json& path) {
        const Bytes bytes = inflated(array_of(html, path["at"]));
        std::vector<float> numbers(bytes.size() / sizeof(float));
        std::memcpy(numbers.data(), bytes.data(), bytes.size());
        return numbers;
    }
};

TEST_F(PageOfPaths, FieldsLieTimeByTime) {
    file("probes/depth.csv", "time [s],s [m],X [m],Y [m],Z [m],stress_xx [Pa],status,strain_xx\n"
                             "1,0,0,0,0,10,0,\n1,0.5,0,0,0.5,20,1,\n1,1,0,0,1,,2,\n"
                             "2,0,0,0,0,30,0,\n2,0.5,0,0,0.5,40,1,\n2,1,0,0,1,50,2,\n"
                             "3,0,0,0,0,60,0,\n"); // the last time is not whole
    file("probes/rim.csv", "time [s],s [m],angle [rad],X [m],Y [m],Z [m],gap [m]\n1,0,-0,1,0,0,7\n1,3,-3,-1,0,0,8\n");
    file("probes/corner.csv", "time [s],displacement_x [m]\n1,0\n");
    const std::string html = make_page(folder, options).html;
    const nlohmann::json paths = data_of(html)["paths"];
    ASSERT_EQ(paths.size(), 2U);
    EXPECT_EQ(paths[0]["name"], "depth");
    EXPECT_EQ(paths[0]["times"], (std::vector<double>{1, 2}));
    EXPECT_EQ(places(html, paths[0]), (std::vector<float>{0, 0.5, 1}));
    ASSERT_EQ(paths[0]["fields"].size(), 2U) << "one has no value anywhere";
    EXPECT_EQ(paths[0]["fields"][0]["unit"], "Pa");
    EXPECT_EQ(paths[0]["fields"][1]["unit"], "");
    const FieldFrames stress = values(html, paths[0], 0);
    EXPECT_TRUE(std::isnan(stress.frames[0][2])) << "outside of the body";
    EXPECT_NEAR(stress.frames[0][1], 20, 1e-3);
    EXPECT_NEAR(stress.frames[1][2], 50, 1e-3);
    EXPECT_EQ(paths[1]["angle"], true);
    EXPECT_EQ(places(html, paths[1]), (std::vector<float>{0, -3}));
    EXPECT_THAT(missing(html, {"data-charts=\"paths\""}), IsEmpty());
}

TEST_F(PageOfPaths, OneThatCannotBeReadIsNoted) {
    file("probes/depth.csv", "time [s],X [m],stress_xx [Pa]\n1,0,0\n");
    file("probes/torn.csv",
         "time [s],s [m],stress_xx [Pa]\n1,0,1\n1,1,2\n2,0,3\n3,1,4\n"); // rows of two times are missing
    file("probes/rim.csv", "time [s],angle [rad],gap [m]\n1,0,1\n1,1,2\n2,0,3\n2,2,4\n");
    const report::Page page = make_page(folder, options);
    EXPECT_THAT(page.notes, Contains(HasSubstr("probes/depth.csv cannot be read: it has no column s")));
    EXPECT_THAT(page.notes, Contains(HasSubstr("probes/torn.csv cannot be read: its rows are not the same places")));
    EXPECT_THAT(page.notes, Contains(HasSubstr("probes/rim.csv cannot be read: its rows are not the same places")));
    EXPECT_FALSE(data_of(page.html).contains("paths"));
    EXPECT_THAT(found(page.html, {"data-charts=\"paths\""}), IsEmpty());
}

TEST_F(PageOfPaths, ManyTimesAreThinnedOutAndSaidSo) {
    std::string rows = "time [s],s [m]", numbers;
    for (int c = 0; c < 70; ++c) {
        rows += ",stress_" + std::to_string(c) + " [Pa]";
        numbers += ",1";
    }
    rows += '\n';
    for (int t = 0; t < 10000; ++t)
        for (const char* s : {",0", ",0.5", ",1"}) rows += std::to_string(t) + s + numbers + '\n';
    file("probes/depth.csv", rows);
    const report::Page page = make_page(folder, options);
    EXPECT_THAT(page.notes, Contains(HasSubstr("probes/depth.csv shows every 2-th of its 10000 times")));
    const nlohmann::json path = data_of(page.html)["paths"][0];
    EXPECT_EQ(path["times"].size(), 5001U); // the last one too
    EXPECT_EQ(values(page.html, path, 69).frames.size(), 5001U);
}

TEST_F(Page, ALongHistoryIsThinnedOutAndSaidSo) {
    file("summary.json", summary);
    std::string rows = "time,dt";
    for (int c = 0; c < 98; ++c) rows += ",energy." + std::to_string(c);
    rows += '\n';
    std::string zeros;
    for (int c = 0; c < 99; ++c) zeros += ",0";
    for (int r = 0; r < 30000; ++r) rows += std::to_string(r) + zeros + '\n';
    file("history.csv", rows);
    const report::Page page = make_page(folder, options);
    EXPECT_THAT(page.notes, Contains(HasSubstr("every 2-th of its 30000 rows")));
    EXPECT_EQ(data_of(page.html)["history"]["rows"], 15001); // the last one too
}

} // namespace
} // namespace osculate::report::OSCULATE_THIS_FILE
