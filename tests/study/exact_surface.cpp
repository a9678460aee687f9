#include "osculate/study/exact_surface.hpp"

#include "support/random.hpp"

#include <gtest/gtest.h>

namespace osculate::study::OSCULATE_THIS_FILE {
namespace {

const Sphere sphere{{0.3, -0.2, 0.1}, 1.7};
const Torus torus{{0.1, 0.2, -0.3}, 2, 0.7};
const Saddle saddle{{0.4, -0.1, 0.2}, 0.6, 0.3};

/// A point near the surface: the foot of a random point, moved off along the normal.
Vec3 near(const ExactSurface& surface, support::Random& random) {
    const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.5, 0.5));
    const auto foot = std::visit([&](const auto& s) { return s.closest(p + Vec3(1.2, 0, 0.3)); }, surface);
    return foot.point + random.uniform(-0.1, 0.1) * foot.normal;
}

class Exact : public ::testing::TestWithParam<ExactSurface> {
protected:
    [[nodiscard]] ExactPoint closest(const Vec3& x) const {
        return std::visit([&](const auto& s) { return s.closest(x); }, GetParam());
    }
};

TEST_P(Exact, ClosestPointLiesAlongTheNormalAndOnTheSurface) {
    constexpr double round_off = 1e-13;
    support::Random random(1);
    for (int i = 0; i < 100; ++i) {
        const Vec3 x = near(GetParam(), random);
        const ExactPoint p = closest(x);
        EXPECT_NEAR(p.normal.norm(), 1, round_off);
        EXPECT_LT((x - p.point).cross(p.normal).norm(), round_off);
        EXPECT_LT((closest(p.point).point - p.point).norm(), round_off);
    }
}

TEST_P(Exact, MeanCurvatureIsHalfTheDivergenceOfTheNormal) {
    constexpr double step = 1e-5, difference_error = 1e-8;
    support::Random random(2);
    for (int i = 0; i < 20; ++i) {
        const ExactPoint p = closest(near(GetParam(), random));
        double divergence = 0;
        for (int k = 0; k < 3; ++k) {
            const Vec3 d = step * Vec3::Unit(k);
            divergence += (closest(p.point + d).normal(k) - closest(p.point - d).normal(k)) / (2 * step);
        }
        EXPECT_NEAR(p.mean_curvature, divergence / 2, difference_error);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Exact, ::testing::Values(sphere, torus, saddle));

TEST(ExactSphere, IsAtItsRadius) {
    EXPECT_DOUBLE_EQ((sphere.closest({1, 1, 1}).point - sphere.centre).norm(), sphere.radius);
}

TEST(ExactSaddle, IsAtItsHeight) {
    const Vec3 p = saddle.closest({0.8, 0.3, 0.5}).point;
    EXPECT_DOUBLE_EQ(saddle.height(p.x(), p.y()), p.z());
}

} // namespace
} // namespace osculate::study::OSCULATE_THIS_FILE
