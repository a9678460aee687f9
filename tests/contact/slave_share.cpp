#include "osculate/contact/slave_share.hpp"

#include "support/thread_ranks.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

TEST(SlaveShare, SharesTheWorkOutEvenlyAndEachNodeOnce) {
    std::vector<int> work(1000, 1);
    std::fill(work.begin() + 200, work.begin() + 320, 4); // in contact
    const int all = std::accumulate(work.begin(), work.end(), 0);
    for (const int ranks : {1, 2, 3, 7})
        osculate::support::on_ranks(ranks, [&](const std::shared_ptr<Ranks>& together) {
            SlaveShare share(*together, 1000);
            share.share_out(work);
            int own = 0;
            for (Index j = 0; j < 1000; ++j) {
                EXPECT_EQ(share.owns(j), share.owner(j) == together->rank());
                if (share.owns(j)) own += work[static_cast<std::size_t>(j)];
            }
            EXPECT_LE(own, 1.05 * all / ranks);
            std::vector<double> sum{static_cast<double>(own)};
            together->sum(sum);
            EXPECT_EQ(sum[0], all);
        });
}

TEST(SlaveShare, LeavesSomeWithoutNodesWhereThereAreFew) {
    osculate::support::on_ranks(5, [](const std::shared_ptr<Ranks>& ranks) {
        SlaveShare share(*ranks, 2);
        share.share_out(std::vector<int>{1, 1});
        std::vector<int> seen;
        share.exchange([](Index j, std::vector<double>& numbers) { numbers.push_back(10 + j); },
                       [&](Index, const double* at) {
                           seen.push_back(static_cast<int>(*at));
                           return at + 1;
                       });
        for (Index j = 0; j < 2; ++j) EXPECT_EQ(std::ranges::count(seen, 10 + j), share.owns(j) ? 0 : 1);
    });
}

TEST(SlaveShare, TellsTheOthersNumbersOfAnyLength) {
    constexpr Index slaves = 23;
    osculate::support::on_ranks(3, [](const std::shared_ptr<Ranks>& ranks) {
        SlaveShare share(*ranks, slaves);
        share.share_out(std::vector<int>(slaves, 1));
        std::vector<std::vector<double>> known(slaves);
        const auto numbers_of = [](Index j) {
            return std::vector<double>(static_cast<std::size_t>(j % 5), 1.0 / (1 + j));
        };
        for (Index j = share.begin(); j < share.end(); ++j) known[static_cast<std::size_t>(j)] = numbers_of(j);
        share.exchange(
            [&](Index j, std::vector<double>& numbers) {
                const std::vector<double>& own = known[static_cast<std::size_t>(j)];
                numbers.insert(numbers.end(), own.begin(), own.end());
            },
            [&](Index j, const double* at) {
                known[static_cast<std::size_t>(j)].assign(at, at + j % 5);
                return at + j % 5;
            });
        for (Index j = 0; j < slaves; ++j) EXPECT_EQ(known[static_cast<std::size_t>(j)], numbers_of(j));
    });
}

TEST(SlaveShare, TellsNumbersThatAreTooManyForOneMessage) {
    constexpr Index slaves = 40;
    constexpr std::size_t most = 60000;
    osculate::support::on_ranks(3, [](const std::shared_ptr<Ranks>& ranks) {
        SlaveShare share(*ranks, slaves);
        std::vector<int> work(slaves, 1);
        work.front() = 30; // so that rank 0 has told all before the others have
        share.share_out(work);
        std::vector<int> told(slaves, 0);
        share.exchange([&](Index j, std::vector<double>& numbers) { numbers.resize(numbers.size() + most - j, j); },
                       [&](Index j, const double* at) {
                           ++told[static_cast<std::size_t>(j)];
                           const double* const end = at + most - j;
                           EXPECT_TRUE(std::all_of(at, end, [&](double number) { return number == j; }))
                               << "of node " << j;
                           return end;
                       });
        for (Index j = 0; j < slaves; ++j) EXPECT_EQ(told[static_cast<std::size_t>(j)], share.owns(j) ? 0 : 1);
    });
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
