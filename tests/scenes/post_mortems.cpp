/// Deliberate failures: each says why, where and what to change, and doing as it says helps.

#include "osculate/scene/keys.hpp"
#include "scenes/program.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

struct Failure {
    const char *scene, *cause, *body; ///< body "": one of two that are alike
    double last_time;                 ///< s; negative: where cuts of steps end
    const char* key;                  ///< of one piece of advice
    std::vector<std::string> remedy;  ///< overrides at or below keys that are advised; with them the run ends well
    bool in_words = false;            ///< no value can be told: nothing that `--set` takes
};

/// Whether there is a null, which is what a number that is not finite becomes, but for what may be absent.
bool has_gaps(const json& value) {
    if (value.is_structured())
        for (const auto& [key, part] : value.items())
            if (has_gaps(part) && !(part.is_null() && (key == "contact" || key == "element"))) return true;
    return value.is_null();
}

class PostMortem : public Program, public testing::WithParamInterface<Failure> {
protected:
    std::string path() const {
        const std::string name = std::string(GetParam().scene) + ".yaml",
                          own = scene_file("tests/scenes/failures/" + name);
        return fs::exists(own) ? own : scene_file("configs/extreme/" + name);
    }
    Outcome fail(std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"run", path(), "-o", "run", "--quiet"});
        return osculate(more);
    }
    json found() const { return json::parse(content(folder / "run/post_mortem.json")); }
};

TEST_P(PostMortem, NamesCauseBodyLastGoodTimeAndKeysToChange) {
    const Failure& expected = GetParam();
    const Outcome outcome = fail();
    ASSERT_EQ(outcome.code, 3) << outcome.err;
    const json post_mortem = found();
    EXPECT_EQ(post_mortem["cause"], expected.cause);
    EXPECT_THAT(post_mortem["body"].get<std::string>(), HasSubstr(expected.body));
    EXPECT_FALSE(has_gaps(post_mortem)) << post_mortem.dump(2);

    // times are those of the tables
    const Csv history(folder / "run/history.csv"), steps(folder / "run/steps.csv");
    const double last_time = history.rows.empty() ? 0 : history.number(history.rows.size() - 1, "time");
    constexpr double round_off = 1e-12; // of a sum of steps
    EXPECT_EQ(post_mortem["last_time"], last_time);
    if (expected.last_time >= 0) {
        EXPECT_NEAR(last_time, expected.last_time, round_off * expected.last_time);
    }
    EXPECT_GE(post_mortem["time"], last_time);
    const json& attempts = post_mortem["attempts"];
    for (std::size_t i = 0; i < attempts.size(); ++i) {
        const std::size_t row = steps.rows.size() - attempts.size() + i;
        EXPECT_EQ(attempts[i]["attempt"], steps.number(row, "attempt"));
        EXPECT_EQ(attempts[i]["reason"], steps.text(row, "reason"));
    }

    std::vector<std::string> keys;
    for (const json& one : post_mortem["advice"]) {
        keys.push_back(one["key"]);
        EXPECT_NE(scene::describe_keys(keys.back()), "") << keys.back() << " is no key of a scene";
        EXPECT_THAT(outcome.err, HasSubstr(keys.back() + ": " + one["text"].get<std::string>() + "\n"));
    }
    EXPECT_THAT(keys, testing::Contains(expected.key));

    // the message, then the post-mortem, which the diary repeats
    const json summary = json::parse(content(folder / "run/summary.json"));
    EXPECT_EQ(summary["failure"], post_mortem["message"]);
    const std::string message = "the run gave up: " + summary["failure"].get<std::string>() + "\n";
    const std::string said =
        outcome.err.substr(std::min(outcome.err.find(message), outcome.err.size())); // after warnings
    EXPECT_THAT(said, testing::StartsWith(message + "post-mortem\n  cause       " + expected.cause + ": "));
    EXPECT_THAT(osculate({"diary", "run"}).out, testing::EndsWith("\n" + said.substr(message.size())));
}

TEST_P(PostMortem, KeepsWhatWasAcceptedAndWritesTheFailedIterateBesideIt) {
    ASSERT_EQ(fail().code, 3);
    const json post_mortem = found(), summary = json::parse(content(folder / "run/summary.json"));
    const long accepted = summary["steps"]["accepted"];
    const std::string body = post_mortem["body"];
    char name[64];
    for (long frame = 0; frame <= accepted; ++frame) {
        std::snprintf(name, sizeof name, "frames/%s_%05ld.vtu", body.c_str(), frame);
        EXPECT_TRUE(fs::exists(folder / "run" / name)) << name;
    }
    EXPECT_THAT(content(folder / "run/series.pvd"), Not(HasSubstr("failed")));
    if (post_mortem["cause"] == "load_not_finite") {
        EXPECT_FALSE(fs::exists(folder / "run/failed")) << "there is no iterate";
        return;
    }
    std::snprintf(name, sizeof name, "frames/%s_%05ld.vtu", body.c_str(), accepted + 1);
    EXPECT_THAT(content(folder / "run/failed/series.pvd"), HasSubstr(name));
    EXPECT_THAT(content(folder / "run/failed" / name),
                testing::AllOf(HasSubstr("\"displacement\""), HasSubstr("\"out_of_balance\"")));
    if (!post_mortem["contact"].is_null()) {
        std::snprintf(name, sizeof name, "frames/%s.slave_%05ld.vtp",
                      post_mortem["contact"]["pair"].get<std::string>().c_str(), accepted + 1);
        EXPECT_THAT(content(folder / "run/failed" / name), HasSubstr("\"status\""));
    }
}

TEST_P(PostMortem, AdviceHelpsAndTheNextRunLeavesNothingOfIt) {
    ASSERT_EQ(fail().code, 3);
    const json advice = found()["advice"];
    std::vector<std::string> changes;
    for (const std::string& change : GetParam().remedy) {
        bool advised = false;
        for (const json& one : advice)
            advised = advised || change.starts_with(one["key"].get<std::string>()) ||
                      std::ranges::count(one["set"], json(change)) > 0;
        EXPECT_TRUE(advised) << change;
        changes.insert(changes.end(), {"--set", change});
    }
    const Outcome mended = fail(changes);
    EXPECT_EQ(mended.code, 0) << mended.err;
    EXPECT_FALSE(fs::exists(folder / "run/post_mortem.json"));
    EXPECT_FALSE(fs::exists(folder / "run/failed"));
    EXPECT_THAT(osculate({"diary", "run"}).out, Not(HasSubstr("post-mortem")));
}

/// Overrides after what the diary says to try, or the words that none is known.
TEST_P(PostMortem, OverridesThatAreAdvisedWorkOrThereAreNone) {
    const Outcome failed = fail();
    ASSERT_EQ(failed.code, 3);
    const json post_mortem = found();
    std::string tried;
    bool works = false;
    for (const json& one : post_mortem["advice"]) {
        if (one["set"].empty()) continue;
        std::vector<std::string> changes;
        std::string options;
        for (const std::string change : one["set"]) {
            changes.insert(changes.end(), {"--set", change});
            options += " --set '" + change + "'";
        }
        EXPECT_THAT(failed.err, HasSubstr(one["text"].get<std::string>() + "\n"));
        EXPECT_THAT(failed.err, HasSubstr(options + "\n"));
        const Outcome mended = fail(changes);
        EXPECT_THAT(mended.code, testing::AnyOf(0, 3)) << options << " is no override of this scene: " << mended.err;
        const bool past = mended.code == 0 || found()["last_time"].get<double>() > post_mortem["time"].get<double>();
        works = works || past;
        tried += options + (past ? ": works\n" : ": " + mended.err.substr(0, mended.err.find('\n')) + "\n");
    }
    if (!post_mortem["no_remedy"].get<std::string>().empty()) return;
    // what is in words alone is done by hand in the test above
    EXPECT_TRUE(works || tried.empty()) << tried;
    EXPECT_EQ(tried.empty(), GetParam().in_words);
}

INSTANTIATE_TEST_SUITE_P(
    Deliberate, PostMortem,
    testing::Values(
        Failure{"no_support", "unsupported_body", "cap", 0, "stages.draw", {"stages.draw.pressure.top=10 kPa"}},
        Failure{"torn_off", "unsupported_body", "cap", 3, "stages.pull", {"stages.pull.pressure.top=5 kPa"}},
        Failure{"pushed_without_friction",
                "unsupported_body",
                "cap",
                0,
                "contact.joint.friction",
                {"contact.joint.friction=0.5"}},
        Failure{"impossible_motion",
                "singular_tangent",
                "punch",
                0,
                "stages.drive.displacement",
                {"stages.drive.displacement={top: {x: 0 m, y: 0 m, z: -0.1 m}}"},
                true},
        Failure{"given_way", "diverged", "block", -1, "stages.press", {"stages.press.pressure.top=1 MPa"}, true},
        Failure{"limit_point",
                "stalled",
                "arch",
                0.755859375,
                "stages.push",
                {"stages.push.nodal_force={}", "stages.push.displacement={crown: {y: -20 mm}}"},
                true},
        Failure{"edges_unseen",
                "unseen_contact",
                "upper",
                0.25,
                "contact.tips.discretisation",
                {"contact.tips.discretisation=node"}},
        Failure{"inside_out",
                "inside_out",
                "block",
                0.8229166666666667,
                "stages.crush",
                {"stages.crush.displacement.top.z=-0.3 m"},
                true},
        Failure{"too_deep",
                "interpenetration",
                "block",
                0.01,
                "solver.smallest_step",
                {"stages.fall.control.allowed_interpenetration=0.05"}},
        Failure{"bar_on_table_edge",
                "unseen_contact",
                "table",
                -1,
                "contact.rest.slave",
                {"contact.rest.slave=top", "contact.rest.master.set=sole"}},
        Failure{"bars_crossed_between_nodes",
                "unseen_contact",
                "",
                -1,
                "bodies.upper.mesh",
                {"bodies.upper.mesh.block.divisions=[31, 2, 2]"},
                true},
        Failure{"energy",
                "energy",
                "block",
                0.016,
                "stages.fall.control.energy_tolerance",
                {"stages.fall.control.energy_tolerance=0.1"}},
        Failure{"time_error",
                "time_error",
                "rod",
                0,
                "stages.swing.control.error_tolerance",
                {"stages.swing.control.error_tolerance=1e-3 m"}},
        Failure{
            "one_iteration", "iterations_exhausted", "block", 0, "solver.max_iterations", {"solver.max_iterations=30"}},
        Failure{"pole",
                "load_not_finite",
                "block",
                1,
                "stages.crush.displacement.top.z",
                {"stages.crush.displacement.top.z=-0.1 m"},
                true},
        Failure{"through_the_plate", "collision", "cube", 0, "solver.smallest_step", {"solver.smallest_step=1e-4"}}),
    [](const auto& test) { return std::string(test.param.scene); });

class BodyInItself : public Program {};

TEST_F(BodyInItself, IsKeptOutByTheGeneralContactThatIsAdvised) {
    const std::vector<std::string> run{"run",    scene_file("tests/scenes/pinched_ring.yaml"), "-o", "run", "--quiet",
                                       "--force"};
    const Outcome outcome = osculate(run);
    ASSERT_EQ(outcome.code, 3) << outcome.err;
    const json post_mortem = json::parse(content(folder / "run/post_mortem.json"));
    EXPECT_EQ(post_mortem["cause"], "unseen_contact");
    ASSERT_EQ(post_mortem["advice"].size(), 1u);
    EXPECT_THAT(post_mortem["advice"][0]["text"], HasSubstr("'ring' from going through itself"));
    const std::string change = post_mortem["advice"][0]["set"][0];
    std::vector<std::string> mended = run;
    mended.insert(mended.end(), {"--set", change, "--set", "contact.general.friction=0.3"});
    EXPECT_EQ(osculate(mended).code, 0);
}

class GivenWay : public Program {};

/// Where its last iterates lie is by chance: here they are near, and touch nothing.
TEST_F(GivenWay, IsNoLackOfSupportsWhileTheLoadPushesTheBodyAgainstAnother) {
    const Outcome outcome = osculate({"run", scene_file("tests/scenes/failures/given_way.yaml"), "-o", "run", "--quiet",
                                      "--set", "solver.tolerance=1e-10"});
    EXPECT_EQ(outcome.code, 3);
    const json post_mortem = json::parse(content(folder / "run/post_mortem.json"));
    EXPECT_EQ(post_mortem["cause"], "diverged");
    EXPECT_EQ(post_mortem["body"], "block");
    for (const json& one : post_mortem["advice"]) EXPECT_NE(one["key"], "supports");
}

class FailedIterate : public Program {};

TEST_F(FailedIterate, IsNotWrittenWhereTheSceneDoesNotWantIt) {
    const Outcome outcome = osculate({"run", scene_file("tests/scenes/failures/time_error.yaml"), "-o", "run",
                                      "--quiet", "--set", "output.failed_iterate=false"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(fs::exists(folder / "run/post_mortem.json"));
    EXPECT_FALSE(fs::exists(folder / "run/failed"));
}

TEST_F(FailedIterate, DiaryRefusesADamagedPostMortem) {
    ASSERT_EQ(osculate({"run", scene_file("tests/scenes/failures/time_error.yaml"), "-o", "run", "--quiet"}).code, 3);
    std::ofstream(folder / "run/post_mortem.json") << "{\"cause\": \"weather\"}";
    const Outcome outcome = osculate({"diary", "run"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("run/post_mortem.json"));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
