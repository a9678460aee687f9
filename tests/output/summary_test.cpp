#include "osculate/output/summary.hpp"
#include "output/temporary_folder.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class SummaryFile : public InTemporaryFolder {};

Summary example() {
    Summary summary;
    summary.version = "0.1.0";
    summary.scene = "half_tube";
    summary.status = "done";
    summary.dofs = 4680;
    summary.bodies = {{"tube", 728, 468}, {"contactor", 884, 576}};
    summary.pairs = {{"sliding", 221, 156, "rpim"}};
    summary.steps = {31, 2, 0, 3};
    summary.iterations = 77;
    summary.factorisations = 70;
    summary.gmres_iterations = 300;
    summary.total_seconds = 2.5;
    summary.cpu_seconds = 2.25;
    for (const auto& [part, seconds] : {std::pair{Part::search, 0.1},
                                        {Part::patches, 0.2},
                                        {Part::contact, 0.3},
                                        {Part::assembly, 0.4},
                                        {Part::factor, 0.5},
                                        {Part::solve, 0.6},
                                        {Part::output, 0.7}})
        summary.timings.add(part, seconds);
    summary.peak_memory_bytes = 5'000'000'000;
    summary.threads = 2;
    summary.plan = {"bodies: tube, contactor", "no inertia: \"static\" stages only"};
    return summary;
}

TEST_F(SummaryFile, HoldsEveryMemberUnderItsName) {
    write_summary(folder / "summary.json", example());
    const json expected = json::parse(R"({
        "version": "0.1.0", "scene": "half_tube", "status": "done", "dofs": 4680,
        "bodies": [{"name": "tube", "nodes": 728, "elements": 468}, {"name": "contactor", "nodes": 884, "elements": 576}],
        "pairs": [{"name": "sliding", "slave_nodes": 221, "master_facets": 156, "surface": "rpim"}],
        "steps": {"accepted": 31, "rejected": 2, "stabilised": 0, "at_round_off": 3, "held_geometry": 0}, "iterations": 77, "factorisations": 70, "gmres_iterations": 300,
        "seconds": {"total": 2.5, "cpu": 2.25, "search": 0.1, "patches": 0.2, "contact": 0.3, "assembly": 0.4,
                    "factor": 0.5, "solve": 0.6, "output": 0.7, "audit": 0.0},
        "peak_memory_bytes": 5000000000, "threads": 2,
        "plan": ["bodies: tube, contactor", "no inertia: \"static\" stages only"]})");
    EXPECT_EQ(json::parse(content(folder / "summary.json")), expected);
}

TEST_F(SummaryFile, HoldsChecksAndWhatWasExpected) {
    Summary summary = example();
    summary.checks = Summary::Checks{1e-12, 0.5, 0.25, {}, {}, {}, {}, {}};
    summary.expectation = Summary::Expectation{{"gave up but should complete"}};
    write_summary(folder / "summary.json", summary);
    json read = json::parse(content(folder / "summary.json"));
    EXPECT_EQ(read["checks"], json::parse(R"({"force_balance": 1e-12, "penetration": 0.5, "penetration_m": 0.25})"));
    EXPECT_FALSE(read.contains("warnings"));
    EXPECT_EQ(read["expectation"], json::parse(R"({"met": false, "misses": ["gave up but should complete"]})"));
    summary.checks->energy_balance = 1e-10;
    summary.checks->energy_growth = 1e-3;
    summary.checks->closing_loss = 0.1;
    summary.checks->settling_loss = 0.3;
    summary.checks->rotation_strain = 0.2;
    summary.warnings = {"a tenth went"};
    summary.expectation->misses.clear();
    write_summary(folder / "summary.json", summary);
    read = json::parse(content(folder / "summary.json"));
    EXPECT_EQ(read["checks"]["energy_balance"], 1e-10);
    EXPECT_EQ(read["checks"]["energy_growth"], 1e-3);
    EXPECT_EQ(read["checks"]["closing_loss"], 0.1);
    EXPECT_EQ(read["checks"]["settling_loss"], 0.3);
    EXPECT_EQ(read["checks"]["rotation_strain"], 0.2);
    EXPECT_EQ(read["warnings"], json::parse(R"(["a tenth went"])"));
    EXPECT_EQ(read["expectation"]["met"], true);
}

TEST_F(SummaryFile, NamesAFailureWhenThereIsOne) {
    Summary summary = example();
    summary.status = "gave_up";
    summary.failure = "the solver \xff did not converge"; // not UTF-8
    summary.total_seconds = std::nan("");
    write_summary(folder / "summary.json", summary);
    const json read = json::parse(content(folder / "summary.json"));
    EXPECT_EQ(read["status"], "gave_up");
    EXPECT_THAT(read["failure"].get<std::string>(), AllOf(HasSubstr("the solver"), HasSubstr("did not converge")));
    EXPECT_TRUE(read["seconds"]["total"].is_null());
}

TEST_F(SummaryFile, NamesWhatEachProcessHas) {
    Summary summary = example();
    summary.processes = {{70, 40, 12, 90'000'000, 20'000'000}, {65, 42, 13, 85'000'000, 0}};
    write_summary(folder / "summary.json", summary);
    EXPECT_EQ(json::parse(content(folder / "summary.json"))["processes"], json::parse(R"([
        {"nodes": 70, "elements": 40, "slave_nodes": 12, "peak_memory_bytes": 90000000, "shared_memory_bytes": 20000000},
        {"nodes": 65, "elements": 42, "slave_nodes": 13, "peak_memory_bytes": 85000000, "shared_memory_bytes": 0}])"));
}

TEST_F(SummaryFile, ListsStayListsWhenEmpty) {
    write_summary(folder / "summary.json", {});
    const json read = json::parse(content(folder / "summary.json"));
    for (const char* key : {"bodies", "pairs", "plan"}) EXPECT_EQ(read[key], json::array()) << key;
}

TEST_F(SummaryFile, FullDiskLeavesTheSummaryOfBefore) {
    const auto path = folder / "summary.json";
    write_summary(path, example());
    const std::string before = content(path);
    std::string message;
    {
        const FullDisk full(64);
        message = runtime_error_of([&] { write_summary(path, {}); });
    }
    EXPECT_THAT(message, AllOf(HasSubstr(path.string()), HasSubstr("File too large")));
    EXPECT_EQ(content(path), before);
    EXPECT_EQ(files_in(folder), 1U);
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
