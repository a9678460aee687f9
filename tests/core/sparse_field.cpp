/// Fields that are zero at most nodes: their sums have the bits of those of whole fields.

#include "osculate/core/sparse_field.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// Some nodes with values, others without.
Field some(std::mt19937& random, std::size_t nodes, double share) {
    std::uniform_real_distribution<double> uniform;
    Field field(nodes);
    for (Vec3& value : field)
        if (uniform(random) < share) value = {uniform(random), 0, -uniform(random)};
    return field;
}

TEST(SparseField, BetweenTwoOthersHasTheBitsOfWholeFields) {
    std::mt19937 random(1);
    constexpr std::size_t nodes = 50;
    for (const double share_x : {0.0, 0.1, 0.7, 1.0})
        for (const double share_y : {0.0, 0.2, 1.0})
            for (const double a : {0.0, 0.3, 1.0}) {
                const Field x = some(random, nodes, share_x), y = some(random, nodes, share_y);
                const Field between = SparseField::between(SparseField(x), SparseField(y), a, nodes);
                for (std::size_t i = 0; i < nodes; ++i)
                    EXPECT_EQ(between[i], x[i] + a * (y[i] - x[i])) << share_x << " " << share_y << " " << a;
            }
}

TEST(SparseField, HoldsWhatIsNotZeroAlone) {
    Field field(5);
    EXPECT_TRUE(SparseField(field).empty());
    field[1] = {0, 2, 0};
    field[3] = {0, 0, std::nan("")};
    const SparseField sparse(field);
    ASSERT_EQ(std::distance(sparse.begin(), sparse.end()), 2) << "what is no number is not dropped";
    Field sum(5, Vec3(1, 1, 1));
    sparse.add_to(3, sum);
    EXPECT_EQ(sum[0], Vec3(1, 1, 1));
    EXPECT_EQ(sum[1], Vec3(1, 7, 1));
    EXPECT_TRUE(std::isnan(sum[3].z()));
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
