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
