#include "osculate/scene/number_at.hpp"

#include <gtest/gtest.h>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

constexpr const char* resolved = R"(bodies:
  a:
    material:
      linear_elastic:
        E: 3.0e+07
    mesh:
      block:
        size: [1, 2.5, 3]
course: {table: [[0, 1], [1, 4]]}
)";

TEST(NumberAt, FindsAndChangesANumber) {
    std::string found;
    const auto E = number_at(resolved, "bodies.a.material.linear_elastic.E", found);
    ASSERT_TRUE(E);
    EXPECT_EQ(E->value, 3e7);
    const Override change = E->set(3.00001e7);
    EXPECT_EQ(change.key, "bodies.a.material.linear_elastic.E");
    EXPECT_EQ(std::stod(change.value), 3.00001e7);
}

TEST(NumberAt, ChangesAListAsAWhole) {
    std::string found;
    const auto y = number_at(resolved, "bodies.a.mesh.block.size.1", found);
    ASSERT_TRUE(y);
    EXPECT_EQ(y->value, 2.5);
    EXPECT_EQ(y->set(2.75).key, "bodies.a.mesh.block.size");
    EXPECT_EQ(y->set(2.75).value, "[1, 2.75, 3]");
    const auto nested = number_at(resolved, "course.table.1.1", found);
    ASSERT_TRUE(nested);
    EXPECT_EQ(nested->set(5).value, "[[0, 1], [1, 5]]");
}

TEST(NumberAt, SaysWhatStandsThereInstead) {
    std::string found;
    EXPECT_FALSE(number_at(resolved, "bodies.b.material", found));
    EXPECT_EQ(found, "no 'bodies.b' in the resolved scene");
    EXPECT_FALSE(number_at(resolved, "bodies.a.material", found));
    EXPECT_EQ(found, "a map");
    EXPECT_FALSE(number_at(resolved, "bodies.a.mesh.block.size.3", found));
    EXPECT_EQ(found, "no 'bodies.a.mesh.block.size.3' in the resolved scene");
    EXPECT_FALSE(number_at(resolved, "bodies.a.mesh.block.size", found));
    EXPECT_EQ(found, "a list of 3");
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
