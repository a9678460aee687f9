/// The tutorial's chain: no link leaves another, by geometry alone.

#include "support/scene_runner.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr int links = 5, slices = 16, per_slice = 17; ///< of the mesh: slices around, nodes in each
constexpr double r = 4e-3;                            ///< m, of the section

using Polygon = std::vector<Vec3>;

/// Centre line of a link: mean positions of the nodes of each slice.
Polygon centre_line(const model::Model& model, const model::State& state, int link) {
    Polygon line;
    const Index first = model.bodies[static_cast<std::size_t>(link)].first_node;
    for (int s = 0; s < slices; ++s) {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < per_slice; ++i) {
            const auto node = static_cast<std::size_t>(first + s * per_slice + i);
            sum += model.X[node] + state.u[node];
        }
        line.push_back(sum / per_slice);
    }
    return line;
}

/// Solid angle of the triangle a b c from the origin, signed [van Oosterom and Strackee 1983].
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

/// Gauss' linking number of two closed polygons: the area on the unit sphere that the directions from one to the other cover,
/// divided by 4 pi.
double linking_number(const Polygon& one, const Polygon& other) {
    double area = 0;
    for (std::size_t i = 0; i < one.size(); ++i)
        for (std::size_t j = 0; j < other.size(); ++j) {
            const Vec3 &p = one[i], &q = one[(i + 1) % one.size()], &s = other[j], &t = other[(j + 1) % other.size()];
            area += solid_angle(s - p, t - p, t - q) + solid_angle(s - p, t - q, s - q);
        }
    return area / (4 * std::numbers::pi);
}

/// Least distance of two centre lines, over points that are this fine.
double distance(const Polygon& one, const Polygon& other) {
    constexpr int fine = 20;
    double least = std::numeric_limits<double>::infinity();
    const auto at = [](const Polygon& line, int k) -> Vec3 {
        const auto i = static_cast<std::size_t>(k / fine);
        const double s = static_cast<double>(k % fine) / fine;
        return (1 - s) * line[i] + s * line[(i + 1) % line.size()];
    };
    for (int a = 0; a < slices * fine; ++a)
        for (int b = 0; b < slices * fine; ++b) least = std::min(least, (at(one, a) - at(other, b)).norm());
    return least;
}

TEST(LinkingNumber, CountsHowOftenOneRingGoesThroughAnother) {
    const auto ring = [](const Vec3& centre, const Vec3& x, const Vec3& y) {
        Polygon line;
        for (int k = 0; k < slices; ++k) {
            const double a = 2 * std::numbers::pi * k / slices;
            line.emplace_back(centre + std::cos(a) * x + std::sin(a) * y);
        }
        return line;
    };
    const Polygon one = ring(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
    EXPECT_NEAR(std::abs(linking_number(one, ring({1, 0, 0}, Vec3::UnitX(), Vec3::UnitZ()))), 1, 1e-12);
    EXPECT_NEAR(linking_number(one, ring({3, 0, 0}, Vec3::UnitX(), Vec3::UnitZ())), 0, 1e-12);
}

TEST(Chain, NoLinkLeavesAnother) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/chain.yaml"),
                       {{"stages.swing.duration", "0.012 s"}, {"stages.swing.steps", "12"}});
    ASSERT_GE(run.steps.size(), 12U);
    double nearest = std::numeric_limits<double>::infinity();
    for (const support::RunStep& step : run.steps) {
        std::vector<Polygon> lines;
        for (int k = 0; k < links; ++k) lines.push_back(centre_line(run.plan.model, step.state, k));
        for (int a = 0; a < links; ++a)
            for (int b = a + 1; b < links; ++b)
                EXPECT_NEAR(std::abs(linking_number(lines[a], lines[b])), b == a + 1 ? 1 : 0, 1e-9)
                    << step.time << " s, links " << a << " and " << b;
        for (int a = 0; a + 1 < links; ++a) nearest = std::min(nearest, distance(lines[a], lines[a + 1]));
    }
    // sections have 8 sides, which cut 7.6 % of r; those of the rings, 16, cut both the centre lines and what is around them
    EXPECT_GT(nearest, 0.92 * 2 * r);
    EXPECT_LT(nearest, 2 * r + 0.2e-3) << "never touches";
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
