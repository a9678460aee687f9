/// With general contact and default settings bodies that fall on one another come to rest, in few iterations.

#include "support/diary.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numeric>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double gravity = 9.81, side = 50e-3, density = 7850, gap = 1e-3; // SI

/// Steel cubes above one another, each 1 mm above the next, on a steel floor.
std::string stack(int blocks) {
    const char* const steel = "{linear_elastic: {E: 210 GPa, nu: 0.3, density: 7850 kg/m^3}}";
    std::string text = fmt::format(R"(bodies:
  floor:
    mesh: {{block: {{origin: [-50 mm, -50 mm, -20 mm], size: [150 mm, 150 mm, 20 mm], divisions: [3, 3, 1]}}}}
    material: {}
)",
                                   steel);
    for (int k = 0; k < blocks; ++k)
        text += fmt::format(R"(  b{}:
    mesh: {{block: {{origin: [0 mm, 0 mm, {} mm], size: [50 mm, 50 mm, 50 mm], divisions: [2, 2, 2]}}}}
    material: {}
)",
                            k, 1 + 51 * k, steel);
    return text + R"(sets:
  bed: {body: floor, surface: z_min}
supports:
  bed: {fix: [x, y, z]}
contact: {general: {friction: 0.3}}
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
stages:
  fall: {analysis: dynamic, duration: 0.1 s, steps: 100}
)";
}

support::Diary run(int blocks, const std::vector<scene::Override>& changes = {}) {
    app::Plan plan = support::compiled(scene::read_scene(support::scene_file("stack.yaml", stack(blocks)), changes));
    return support::diary_of(plan);
}

int iterations(const support::Diary& diary) {
    return std::accumulate(diary.attempts.begin(), diary.attempts.end(), 0,
                           [](int sum, const time::Attempt& one) { return sum + one.iterations; });
}

TEST(Settling, AStackOfSteelBlocksComesToRestUnderItsWeights) {
    constexpr int blocks = 4;
    const support::Diary diary = run(blocks);
    const model::State& end = diary.states.back();
    EXPECT_DOUBLE_EQ(end.time, 0.1);
    // every joint carries the blocks above it
    std::vector<double> carried;
    for (const model::ContactHistory& pair : end.contact) {
        double sum = 0;
        for (const Vec3& lambda : pair.lambda) sum += std::abs(lambda.z());
        if (sum > 0) carried.push_back(sum);
    }
    ASSERT_EQ(carried.size(), static_cast<std::size_t>(blocks));
    std::ranges::sort(carried);
    const double weight = density * side * side * side * gravity;
    constexpr double allowed = 1e-4;
    for (int k = 0; k < blocks; ++k)
        EXPECT_NEAR(carried[static_cast<std::size_t>(k)], (k + 1) * weight, allowed * weight) << k;
    // by geometry: the last block has fallen by all gaps, and by less than a micrometre more
    double least = 0, largest = -1;
    for (std::size_t node = end.u.size() - 27; node < end.u.size(); ++node) {
        least = std::min(least, end.u[node].z());
        largest = std::max(largest, end.u[node].z());
    }
    EXPECT_NEAR(least, -blocks * gap, 1e-6);
    EXPECT_NEAR(largest, -blocks * gap, 1e-6);
    for (const Vec3& v : end.v.values()) EXPECT_LT(v.norm(), 1e-6 * std::sqrt(2 * gravity * gap));
}

TEST(Settling, AllEnergyOfTheFallIsDampedAndTheLedgerCloses) {
    const support::Diary diary = run(2);
    const time::Ledger& end = diary.ledgers.back();
    const double fallen = density * side * side * side * gravity * gap * (1 + 2);
    EXPECT_NEAR(end.external, fallen, 1e-3 * fallen) << "and a little of the floor's strain";
    EXPECT_NEAR(end.damping + end.algorithmic, fallen, 1e-3 * fallen);
    EXPECT_LT(end.algorithmic, 0.01 * fallen) << "where gravity sets in";
    EXPECT_DOUBLE_EQ(end.settling, end.damping);
    EXPECT_LT(std::abs(end.contact), 1e-6 * fallen);
    const double change = end.kinetic + end.strain; // both are 0 at the start
    EXPECT_NEAR(change, end.external + end.contact - end.friction - end.damping - end.algorithmic + end.balance,
                1e-9 * fallen);
    EXPECT_LT(std::abs(end.balance), 1e-6 * fallen);
}

TEST(Settling, TakesFewIterationsAndCutsNoStep) {
    const scene::Override gravity_9_8{"gravity",
                                      "[0, 0, -9.8]"}; // with 9.81 the resolved one gives up, see docs/limits.md
    const support::Diary settled = run(4, {gravity_9_8});
    EXPECT_EQ(settled.states.size(), 100u);
    EXPECT_EQ(settled.count(time::Reason::energy) + settled.count(time::Reason::solver), 0);
    EXPECT_GT(settled.count(time::Reason::impact), 0);
    const support::Diary resolved = run(4, {gravity_9_8, {"stages.fall.analysis", "{dynamic: {impacts: resolved}}"}});
    EXPECT_LT(3 * iterations(settled), iterations(resolved));
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
