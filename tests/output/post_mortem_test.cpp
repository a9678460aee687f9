#include "osculate/output/post_mortem_file.hpp"
#include "temporary_folder.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

using contact::Status;
using testing::HasSubstr;

/// Every member differs from its default.
time::PostMortem status_cycle() {
    time::PostMortem f;
    f.cause = time::Cause::status_cycle;
    f.message = "it went round";
    f.stage = "slide";
    f.time = 1.5;
    f.last_time = 1.25;
    f.dt = 0.25;
    f.smallest_dt = 0.25;
    f.limit = "the smallest step allowed";
    time::Attempt attempt;
    attempt.attempt = 7;
    attempt.time = 1.5;
    attempt.dt = 0.25;
    attempt.verdict = time::Verdict::give_up;
    attempt.reason = time::Reason::solver;
    attempt.body = "cap";
    attempt.node = 4;
    attempt.value = 0.5;
    attempt.lambda = 0.5;
    attempt.iterations = 3;
    attempt.cause = "statuses cycled; try something";
    f.attempts = {attempt};
    f.body = "cap";
    f.node = 4;
    f.X = {1, 2, 3};
    f.x = {1, 2, 3.5};
    f.contact = time::ContactPlace{"joint", "base", 9, {3, 4, 8, 7}, Status::slip, -1e-3};
    f.element = time::ElementPlace{"base", 6, -0.25};
    f.residual = 0.5;
    f.reference_force = 1e4;
    f.out_of_balance = {7, 8, 9};
    f.rung = "frozen statuses";
    f.iterations = {{0, 1, 0, 1, 2, 3, 0}, {1, 0.5, 2, 3, 2, 1, 4}};
    f.changes = {{"joint", "cap", 4, {Status::stick, Status::slip, Status::stick, Status::glide, Status::open}}};
    f.changing = 3;
    time::BodyHold hold;
    hold.body = "cap";
    hold.free_by_supports = 6;
    hold.free_with_contact = 1;
    hold.free_motions = {"along x"};
    hold.in_pair = true;
    hold.touching = 5;
    hold.pressed = 4;
    hold.touched = 8;
    hold.nearest_pair = "joint";
    hold.nearest_gap = -1e-3;
    hold.facet = 0.25;
    f.bodies = {hold};
    f.advice = {{"stages.slide.steps", "8 instead of 4", {"stages.slide.steps=8"}}, {"supports", "hold it"}};
    f.no_remedy = "nothing helps";
    return f;
}

class PostMortemFile : public InTemporaryFolder {};

TEST_F(PostMortemFile, GivesBackWhatWasWritten) {
    const auto path = folder / post_mortem_file, again = folder / "again.json";
    write_post_mortem(path, status_cycle());
    const time::PostMortem read = read_post_mortem(path);
    write_post_mortem(again, read);
    EXPECT_EQ(content(path), content(again));
    EXPECT_EQ(in_words(read), in_words(status_cycle()));
    for (const char* part : {"\"status_cycle\"", "\"glide\"", "\"nodes_that_changed_status\": 3", "-0.25"})
        EXPECT_THAT(content(path), HasSubstr(part));
}

TEST_F(PostMortemFile, HoldsNullForWhatIsNotFinite) {
    time::PostMortem found = status_cycle();
    found.cause = time::Cause::not_finite;
    found.residual = std::numeric_limits<double>::quiet_NaN();
    write_post_mortem(folder / post_mortem_file, found);
    const time::PostMortem read = read_post_mortem(folder / post_mortem_file);
    EXPECT_TRUE(std::isnan(read.residual));
    EXPECT_EQ(read.cause, time::Cause::not_finite);
}

TEST_F(PostMortemFile, RefusesAnotherKindOfFile) {
    const auto path = folder / post_mortem_file;
    EXPECT_THROW((void)read_post_mortem(path), std::runtime_error);
    for (const char* text : {"", "{", "{}", "{\"cause\": \"weather\"}", "[1, 2]"}) {
        std::ofstream(path) << text;
        EXPECT_THROW((void)read_post_mortem(path), std::runtime_error) << text;
    }
}

TEST(PostMortemText, SaysWhereWhyAndWhatToTry) {
    const std::string text = in_words(status_cycle());
    for (const char* part :
         {"cause       status_cycle: contact statuses repeat in a cycle\n", "last good   1.25 s",
          "7: dt 0.25 s, 3 iterations, statuses cycled\n",
          "node 4 of body 'cap', from (1, 2, 3) m now at (1, 2, 3.5) m",
          "pair 'joint', slip, gap -0.001 m over facet 9 of the master, nodes 3, 4, 8, 7 of body 'base'",
          "0.5 of 1e+04 N, in 'frozen statuses'; out of balance at that node (7, 8, 9) N",
          "stick-slip-stick-glide-open at node 4 of body 'cap' in pair 'joint'\n", "and 2 nodes more",
          "'cap' free along x; touches at 5 slave nodes; last good: at 8, smallest gap -0.001 m",
          "try         no remedy is known: nothing helps\n              stages.slide.steps: 8 instead of 4\n"
          "                --set 'stages.slide.steps=8'\n              supports: hold it\n"})
        EXPECT_THAT(text, HasSubstr(part));
}

TEST(PostMortemText, SaysOfABodyThatComesOffWhereContactWouldHaveToPull) {
    time::PostMortem found = status_cycle();
    found.cause = time::Cause::unsupported_body;
    EXPECT_THAT(in_words(found),
                HasSubstr("touches at 5 slave nodes, 1 of which contact would have to pull; last good"));
}

TEST(PostMortemText, EveryCauseHasANameAndWords) {
    for (int k = 0; k <= static_cast<int>(time::Cause::load_not_finite); ++k) {
        const auto cause = static_cast<time::Cause>(k);
        EXPECT_EQ(time::cause_of(name(cause)), cause);
        EXPECT_NE(time::in_words(cause), "");
    }
    EXPECT_FALSE(time::cause_of("weather"));
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
