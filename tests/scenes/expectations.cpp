/// What a run says of its scene's expectation.

#include "scenes/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <numbers>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::HasSubstr;

const std::string press = scene_file("tests/scenes/press.yaml");

class Expectations : public Program {
protected:
    /// Runs a scene into `folder`/run.
    Outcome run_with(const std::vector<std::string>& changes) const {
        std::vector<std::string> arguments{"run", press, "-o", "run"};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        return osculate(arguments);
    }
    [[nodiscard]] nlohmann::json summary() const { return nlohmann::json::parse(content(folder / "run/summary.json")); }
};

/// Pulled off the base, see Run.CountsEveryAttempt.
const std::vector<std::string> torn_off{"stages.pull.displacement.rear.x=6 m", "solver.smallest_step=0.3"};

TEST_F(Expectations, ChecksAreThereWithoutOne) {
    EXPECT_EQ(run_with({}).code, 0);
    const auto json = summary();
    EXPECT_FALSE(json.contains("expectation"));
    const auto& checks = json["checks"];
    EXPECT_LT(checks["force_balance"], 1e-9) << "the tolerance of the solver";
    EXPECT_LT(checks["penetration"], 1e-9);
    EXPECT_GE(checks["penetration_m"], 0);
    EXPECT_FALSE(checks.contains("energy_growth")) << "a matter of dynamics";
}

TEST_F(Expectations, ChecksSeeAnEdgeThatMortarAveragesDoNot) {
    const std::string edges = scene_file("tests/scenes/failures/edges_unseen.yaml");
    EXPECT_EQ(osculate({"run", edges, "-o", "run", "--quiet"}).code, 3);
    // 1.25 mm down at the last good time, over facets of 45 degrees and 0.1 m
    constexpr double depth = 1.25e-3 / std::numbers::sqrt2, facet = 0.1,
                     round_off = 1e-9; // of what is strained by nothing
    EXPECT_NEAR(summary()["checks"]["penetration_m"], depth, round_off * facet);
    EXPECT_NEAR(summary()["checks"]["penetration"], depth / facet, round_off);
}

TEST_F(Expectations, MetIsSaidToo) {
    const Outcome outcome = run_with({"expect.outcome=completed"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("\nas expected\n"));
    EXPECT_EQ(summary()["expectation"], nlohmann::json::parse(R"({"met": true, "misses": []})"));
}

TEST_F(Expectations, MissedIsSaidLoudlyAndIsNoFailure) {
    const Outcome outcome = run_with({"expect={outcome: gives_up, force_balance: 1e-30}"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("not as expected: completed but should give up; force balance "));
    const auto expectation = summary()["expectation"];
    EXPECT_EQ(expectation["met"], false);
    ASSERT_EQ(expectation["misses"].size(), 2U);
    EXPECT_THAT(expectation["misses"][1].get<std::string>(), HasSubstr("above 1e-30"));
}

TEST_F(Expectations, OfGivingUpHoldItsCause) {
    std::vector<std::string> changes = torn_off;
    changes.emplace_back("expect={outcome: gives_up, cause: \"stage 'pull'\"}");
    const Outcome met = run_with(changes);
    EXPECT_EQ(met.code, 3) << "it gave up, as it should";
    EXPECT_THAT(met.err, HasSubstr("\nas expected\nthe run gave up: stage 'pull'"));
    EXPECT_EQ(summary()["expectation"]["met"], true);

    changes.back() = "expect={outcome: gives_up, cause: not enough memory}";
    EXPECT_THAT(run_with(changes).err, HasSubstr("not as expected: gave up without the words 'not enough memory'"));
    changes.back() = "expect={}";
    EXPECT_THAT(run_with(changes).err, HasSubstr("not as expected: gave up but should complete"));
    EXPECT_EQ(summary()["expectation"]["met"], false);
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
