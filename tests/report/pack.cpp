#include "osculate/report/pack.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace osculate::report::OSCULATE_THIS_FILE {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();

/// A wave that runs over `points` points in two components of different size.
FieldFrames wave(std::size_t frames, std::size_t points) {
    FieldFrames field{2, {}};
    for (std::size_t f = 0; f < frames; ++f) {
        std::vector<float>& values = field.frames.emplace_back();
        for (std::size_t p = 0; p < points; ++p) {
            const auto phase = static_cast<float>(p) / 40 - static_cast<float>(f) / 10;
            values.push_back(3e7F * std::sin(phase));
            values.push_back(1e-3F * std::cos(phase) + 5);
        }
    }
    return field;
}

TEST(Pack, ValuesComeBackWithinHalfALevel) {
    const FieldFrames field = wave(7, 300);
    const Packed packed = pack(field);
    const FieldFrames back = unpack(packed, 7, 300);
    for (std::size_t f = 0; f < 7; ++f)
        for (std::size_t i = 0; i < 600; ++i) {
            const double level = packed.step[i % 2];
            const double rounding = 6e-8 * std::abs(double{field.frames[f][i]}); // of the float it comes back as
            ASSERT_LE(std::abs(back.frames[f][i] - field.frames[f][i]), 0.5000001 * level + rounding);
        }
    EXPECT_NEAR(packed.step[0], 6e7 / 65534, 1e3 / 65534 * 100);
}

TEST(Pack, LeastAndLargestComeBackAsTheyWere) {
    const FieldFrames field{1, {{-2.5F, 0.1F, 8.25F}}};
    const FieldFrames back = unpack(pack(field), 1, 3);
    EXPECT_EQ(back.frames[0][0], -2.5F);
    EXPECT_EQ(back.frames[0][2], 8.25F);
}

TEST(Pack, WhatIsNoNumberStaysNone) {
    const float infinite = std::numeric_limits<float>::infinity();
    const FieldFrames field{1, {{none, 1, 2}, {3, none, -infinite}}};
    const Packed packed = pack(field);
    EXPECT_EQ(packed.low[0], 1);
    const FieldFrames back = unpack(packed, 2, 3);
    EXPECT_TRUE(std::isnan(back.frames[0][0]));
    EXPECT_NEAR(back.frames[0][1], 1, 1e-4);
    EXPECT_EQ(back.frames[1][0], 3);
    EXPECT_TRUE(std::isnan(back.frames[1][1]) && std::isnan(back.frames[1][2]));
}

TEST(Pack, AFieldWithoutAnyValueOrRangeIsPackedToo) {
    const Packed nothing = pack({1, {{none, none}}});
    EXPECT_EQ(nothing.low[0], 0);
    EXPECT_EQ(nothing.step[0], 0);
    EXPECT_TRUE(std::isnan(unpack(nothing, 1, 2).frames[0][1]));
    EXPECT_EQ(unpack(pack({1, {{4, 4}, {4, 4}}}), 2, 2).frames[1][1], 4);
}

TEST(Pack, TimeCostsLessThanItsShareOfBytes) {
    const std::size_t one = pack(wave(1, 2000)).bytes.size(), many = pack(wave(50, 2000)).bytes.size();
    EXPECT_LT(one, 2 * 2 * 2000U);
    EXPECT_LT(many, 50 * one);
}

TEST(Pack, BytesOfAnotherSizeAreRefused) {
    EXPECT_THROW((void)unpack(pack(wave(2, 10)), 2, 11), std::runtime_error);
}

} // namespace
} // namespace osculate::report::OSCULATE_THIS_FILE
