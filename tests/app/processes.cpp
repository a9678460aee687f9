#include "osculate/app/processes.hpp"

#include "osculate/solve/direct_on_first.hpp"

#include <gmock/gmock.h>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

TEST(CannotBeShared, WhatOnlyFactorsSolveWhereTheyDoNotFitIntoOneProcess) {
    model::Model model;
    model.X.values().resize(solve::most_nodes_on_first + 1);
    EXPECT_TRUE(cannot_be_shared(model).empty()) << "multigrid solves it";
    model.skin.push_back({});
    const std::vector<Fault> faults = cannot_be_shared(model);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_THAT(faults[0].expected, testing::HasSubstr("100000 nodes"));
    EXPECT_THAT(faults[0].found, testing::HasSubstr("faces with midside nodes, and 100001 nodes"));
    model.X.values().resize(solve::most_nodes_on_first);
    EXPECT_TRUE(cannot_be_shared(model).empty());
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
