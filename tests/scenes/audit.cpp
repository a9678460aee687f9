/// Bodies that go through one another where no contact sees it: the audit of geometry does.

#include "scenes/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class AuditedScene : public Program {
protected:
    Outcome run(const std::string& scene, const std::vector<std::string>& changes = {}) const {
        std::vector<std::string> arguments{"run", scene_file("configs/extreme/" + scene + ".yaml"), "-o", "run"};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        return osculate(arguments);
    }
    [[nodiscard]] nlohmann::json summary() const { return nlohmann::json::parse(content(folder / "run/summary.json")); }
    /// Gave up for the audit, nowhere deeper than it allows.
    void expect_caught(const Outcome& outcome, const std::string& place) const {
        EXPECT_EQ(outcome.code, 3);
        EXPECT_THAT(outcome.err, AllOf(HasSubstr(place), HasSubstr("\nas expected\n"), HasSubstr("unseen_contact")));
        EXPECT_THAT(content(folder / "run/steps.csv"), HasSubstr(",give_up,audit,"));
        const nlohmann::json found = summary();
        EXPECT_EQ(found["audit"]["on"], true);
        EXPECT_LE(found["checks"]["penetration"], 0.1) << "of a facet, in any accepted state";
    }
};

TEST_F(AuditedScene, OfEdgesThatCrossBetweenNodesGivesUp) {
    expect_caught(run("bars_crossed_between_nodes"), "an edge at node");
    EXPECT_EQ(run("bars_crossed_between_nodes", {"solver.audit=false"}).code, 0) << "they pass through one another";
    EXPECT_EQ(summary()["audit"], nlohmann::json::parse(R"({"on": false})")) << "and the summary says nobody looked";
    EXPECT_EQ(summary()["checks"]["penetration"], 0);
}

TEST_F(AuditedScene, OfATableUnderABarGivesUp) {
    expect_caught(run("bar_on_table_edge"), "of body 'table' lies ");
}

TEST_F(AuditedScene, OfARingInItselfGivesUp) {
    expect_caught(run("ring_through_itself"), "in the body itself");
}

TEST_F(AuditedScene, OfAClipThatSnapsCompletes) {
    EXPECT_EQ(run("snap_fit").code, 0);
    EXPECT_LT(summary()["checks"]["penetration"], 1e-6);
    EXPECT_THAT(content(folder / "run/steps.csv"), Not(HasSubstr(",audit,")));
}

TEST_F(AuditedScene, WritesDepthsIntoFrames) {
    (void)run("bar_on_table_edge", {"output.body_fields=[displacement, penetration]", "output.frame_every=1"});
    EXPECT_THAT(content(folder / "run/frames/table_00060.vtu"), HasSubstr("\"penetration\""));
}

TEST_F(AuditedScene, ThatIsDrawnWithAnOverlapKeepsItAndTells) {
    EXPECT_EQ(osculate({"run", scene_file("tests/scenes/overlap_as_drawn.yaml"), "-o", "run"}).code, 0);
    constexpr double drawn = 1e-3, round_off = 1e-12;
    EXPECT_NEAR(summary()["audit"]["depth_m"], drawn, round_off);
    EXPECT_NEAR(summary()["checks"]["penetration_m"], drawn, round_off);
    const Csv face(folder / "run/probes/face.csv");
    EXPECT_NEAR(face.number(0, "min_penetration [m]"), drawn, round_off);
    EXPECT_NEAR(face.number(0, "max_penetration [m]"), drawn, round_off);
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
