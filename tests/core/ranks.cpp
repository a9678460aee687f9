#include "osculate/core/halo.hpp"
#include "support/thread_ranks.hpp"

#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

const std::vector<int> owner{2, 0, 1, 1, 0, 2, 2};

Field some_field() {
    Field field(owner.size());
    for (std::size_t i = 0; i < field.size(); ++i) field[i] = Vec3(1, 10, 100) * (static_cast<double>(i) + 1.0 / 3);
    return field;
}

TEST(Share, GivesEveryProcessTheValuesOfOwners) {
    support::on_ranks(3, [](const std::shared_ptr<Ranks>& ranks) {
        const Share share(ranks, owner);
        Field field = some_field();
        for (std::size_t i = 0; i < field.size(); ++i)
            if (!share.owns(static_cast<Index>(i))) field[i].setConstant(-7);
        share.replicate(field);
        EXPECT_EQ(field, some_field());
    });
}

TEST(Share, AddsTheValuesOfOwners) {
    support::on_ranks(3, [](const std::shared_ptr<Ranks>& ranks) {
        const Share share(ranks, owner);
        std::vector<Vec3> own;
        for (const Index node : share.nodes_of(ranks->rank()))
            own.push_back(some_field()[static_cast<std::size_t>(node)]);
        Field field(owner.size(), Vec3(1, 2, 3)), expected = field;
        share.add(own, field);
        expected.add(1, some_field());
        EXPECT_EQ(field, expected);
    });
}

TEST(Ranks, GatherTheSameInAnyNumberOfTurns) {
    const std::vector<int> sizes{2, 0, 5, 1, 0};
    support::on_ranks(5, [&](const std::shared_ptr<Ranks>& ranks) {
        const auto numbers_of = [&](int rank) {
            std::vector<double> numbers;
            for (int k = 0; k < sizes[static_cast<std::size_t>(rank)]; ++k) numbers.push_back(10 * rank + k);
            return numbers;
        };
        for (const std::size_t most : {1, 2, 3, 7, 100}) {
            int next = 0;
            ranks->gather_in_turns(
                numbers_of(ranks->rank()), sizes,
                [&](int rank, const double* numbers) {
                    EXPECT_EQ(rank, next++);
                    const std::vector<double> expected = numbers_of(rank);
                    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), numbers)) << rank << " of " << most;
                },
                most);
            EXPECT_EQ(next, 5);
        }
    });
}

TEST(Share, SeesASingleBit) {
    support::on_ranks(3, [](const std::shared_ptr<Ranks>& ranks) {
        const Share share(ranks, owner);
        Field field = some_field();
        EXPECT_TRUE(share.agree(field));
        if (ranks->rank() == 1) field[4].y() = std::nextafter(field[4].y(), 0);
        EXPECT_FALSE(share.agree(field));
    });
}

TEST(Halo, TakesWhatItReadsFromOwners) {
    support::on_ranks(3, [](const std::shared_ptr<Ranks>& ranks) {
        // the first reads two numbers of the second and one of the last; the second none; the last one of the first
        const std::vector<std::vector<std::vector<Index>>> wanted{{{}, {5, 3}, {8}}, {{}, {}, {}}, {{1}, {}, {}}};
        const auto rank = static_cast<std::size_t>(ranks->rank());
        Halo halo(*ranks, wanted[rank]);
        for (const double size : {1.0, 10.0}) {
            std::vector<double> x(9, -1), expected;
            for (std::size_t i = 3 * rank; i < 3 * rank + 3; ++i) x[i] = size * static_cast<double>(i);
            expected = x;
            for (const auto& list : wanted[rank])
                for (const Index i : list) expected[static_cast<std::size_t>(i)] = size * i;
            halo.fill(x.data());
            EXPECT_EQ(x, expected);
        }
    });
}

TEST(Ranks, AddUpInTheirOrder) {
    constexpr double large = 1e16; // beside which 1 is lost, or not, by the order of sums
    support::on_ranks(3, [](const std::shared_ptr<Ranks>& ranks) {
        const double own[] = {1, large, -large};
        std::vector<double> sums{own[ranks->rank()], own[2 - ranks->rank()]};
        ranks->sum(sums);
        EXPECT_EQ(sums, (std::vector<double>{(1 + large) - large, (-large + large) + 1}));
    });
}

TEST(Ranks, FindTheLargestOfAll) {
    support::on_ranks(4, [](const std::shared_ptr<Ranks>& ranks) {
        EXPECT_EQ(ranks->largest(ranks->rank() == 2 ? 5 : -ranks->rank()), 5);
        EXPECT_EQ(ranks->largest(-1 - ranks->rank()), -1);
    });
}

TEST(Ranks, HearWhatOneOfThemSays) {
    const std::string words = "no room in é";
    support::on_ranks(3, [&](const std::shared_ptr<Ranks>& ranks) {
        for (const int speaker : {0, 2})
            EXPECT_EQ(ranks->said_by(speaker, ranks->rank() == speaker ? words : "other words"), words);
        EXPECT_EQ(ranks->said_by(1, ""), "");
    });
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
