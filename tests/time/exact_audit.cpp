#include "osculate/time/exact_audit.hpp"

#include <gtest/gtest.h>
#include <random>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

/// The audit's formulas and those of contact share nothing, and agree.
TEST(ExactAudit, MeasuresTheDistancesThatContactMeasures) {
    using namespace contact;
    const Vec3 axis = Vec3(1, 2, -1).normalized(), point(0.3, -0.2, 0.1);
    std::vector<ExactShape> shapes{PlaneShape{point, axis}};
    for (const bool inside : {false, true}) {
        shapes.emplace_back(CylinderShape{point, axis, 0.8, inside});
        shapes.emplace_back(SphereShape{point, 1.1, inside});
        shapes.emplace_back(ConeShape{point, axis, 0.6, inside});
    }
    const std::vector<Vec2> corners{{-2, 0.5}, {-0.5, 0}, {0.5, 0.8}, {1, -0.5}, {2, -0.4}};
    for (const auto& pieces : {line_profile(corners, 0), line_profile(corners, 0.2), smooth_profile(corners)})
        shapes.emplace_back(ExtrudedShape{point, Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY(), pieces, false});
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-2, 2);
    for (const ExactShape& shape : shapes) {
        const double chords = std::holds_alternative<ExtrudedShape>(shape) ? 2e-3 : 1e-12; // m
        for (int trial = 0; trial < 500; ++trial) {
            const Vec3 p(uniform(random), uniform(random), uniform(random));
            const ShapePoint at = evaluate(shape, p);
            const double audited = audited_distance(shape, p);
            if (std::abs(at.gap) < chords) continue;
            EXPECT_EQ(at.found, std::isfinite(audited)) << shape.index() << " at " << p.transpose();
            if (at.found && std::isfinite(audited)) {
                EXPECT_NEAR(audited, at.gap, chords) << shape.index();
            }
        }
    }
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
