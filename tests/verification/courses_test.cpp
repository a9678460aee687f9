/// Loads and motions by tables and expressions, on bars.

#include "osculate/core/error.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// L = E = density = 1, nu = 0: wave speed 1. The end is at x = 0, the far face free or clamped.
std::string bar(const std::string& stages, const std::string& clamped = "{}") {
    const std::string path = support::temporary("course_bar.yaml");
    std::ofstream(path) << R"(
bodies:
  bar:
    mesh: {block: {size: [1 m, 0.1 m, 0.1 m], divisions: [8, 1, 1]}}
    material: {linear_elastic: {E: 1 Pa, nu: 0, density: 1 kg/m^3}}
sets:
  end: {body: bar, surface: x_min}
  far: {body: bar, surface: x_max}
supports: )" << clamped << "\nstages:\n"
                        << stages;
    return path;
}

support::SceneRun run(const std::string& path, int threads = 1) {
    support::SceneRun result;
    support::run_scene(result, path, {}, threads);
    return result;
}

double displacement(const support::SceneRun& run, std::size_t step, double x) {
    for (std::size_t i = 0; i < run.plan.model.X.size(); ++i)
        if (std::abs(run.plan.model.X[i].x() - x) < 1e-9) return run.steps[step].state.u[i].x();
    throw std::logic_error("no node there");
}

double force_on_far(const support::SceneRun& run, std::size_t step) {
    return run.steps[step].reactions[0].x();
}

constexpr double round_off = 1e-12; // of values about 1, times a well-conditioned bar of 8 elements
constexpr const char* clamped = "{far: {fix: [x, y, z]}}";

TEST(DrivenBar, FollowsItsExpressionAndKeepsItsLastValue) {
    const auto result = run(bar(R"(
  shake: {duration: 2 s, steps: 8, displacement: {end: {x: {expression: "10*sin(pi*t/3) + 1", unit: mm}}}}
  rest: {duration: 1 s, steps: 2}
  back: {duration: 1 s, steps: 2, displacement: {end: {x: 0}}}
)",
                                clamped));
    ASSERT_EQ(result.steps.size(), 12u);
    const auto exact = [](double t) { return 0.01 * std::sin(std::acos(-1.0) * t / 3) + 1e-3; };
    for (std::size_t k = 0; k < 8; ++k) {
        const double u = exact(0.25 * static_cast<double>(k + 1));
        EXPECT_NEAR(displacement(result, k, 0), u, round_off);
        EXPECT_NEAR(displacement(result, k, 0.5), u / 2, round_off * 10);
    }
    for (const std::size_t k : {8u, 9u}) EXPECT_NEAR(displacement(result, k, 0), exact(2), round_off);
    EXPECT_NEAR(displacement(result, 10, 0), exact(2) / 2, round_off);
    EXPECT_EQ(displacement(result, 11, 0), 0);
}

/// A load by a course is absolute: it takes over from the value before, which does not ramp out beside it.
TEST(LoadedBar, CarriesWhatItsTablesSayAndRampsOnFromThere) {
    const auto result = run(bar(R"(
  press: {pressure: {end: 8 mPa}}
  table:
    duration: 2 s
    steps: 2
    pressure: {end: {table: [[0 s, 1 mPa], [1 s, 3 mPa], [2 s, 2 mPa]]}}
    body_force: {bar: [{expression: t, unit: mN/m^3}, 0, 0]}
  rest: {steps: 1}
  off: {steps: 2, pressure: {end: 0}}
)",
                                clamped));
    const double area = 0.01, volume = 0.01;
    const double p[] = {8, 3, 2, 2, 1, 0}, b[] = {0, 1, 2, 2, 2, 2};
    ASSERT_EQ(result.steps.size(), 6u);
    for (std::size_t k = 0; k < 6; ++k)
        EXPECT_NEAR(force_on_far(result, k), -1e-3 * (p[k] * area + b[k] * volume), 1e-9 * 1e-3 * area) << k;
}

TEST(TableCorner, IsHitExactlyBetweenEqualSteps) {
    const auto result = run(bar(R"(
  wait: {duration: 0.3 s, steps: 1}
  push:
    duration: 1 s
    steps: 4
    displacement: {end: {x: {table: [[0, 0], [0.1, 1 mm], [0.5, 2 mm], [0.9 s, -1 mm], [7, 0]]}}}
    body_force: {bar: [{table: [[0, 0], [0.1, 1e-3], [0.85, 0]]}, 0, 0]}
)",
                                clamped));
    std::vector<double> times;
    for (const auto& step : result.steps) times.push_back(step.time);
    const double start = 0.3;
    EXPECT_THAT(times, testing::ElementsAre(0.3, start + 0.1, start + 0.25, start + 0.5, start + 0.75, start + 0.85,
                                            start + 0.9, start + 1));
    EXPECT_NEAR(displacement(result, 1, 0), 1e-3, round_off);
    EXPECT_NEAR(displacement(result, 6, 0), -1e-3, round_off);
}

TEST(TableCorner, IsHitByDynamicStepsToo) {
    const std::string course = "{table: [[0, 0], [0.33, 0], [0.34, 1 mm], [2, 1 mm]]}";
    const auto result =
        run(bar("  push: {analysis: dynamic, duration: 1 s, steps: 10, displacement: {end: {x: " + course + "}}}\n"));
    const auto hits = [&](double time) {
        return std::ranges::any_of(result.steps, [&](const auto& step) { return step.time == time; });
    };
    EXPECT_EQ(result.steps.size(), 12u);
    EXPECT_TRUE(hits(0.33) && hits(0.34) && hits(1));
    for (const auto& step : result.steps) EXPECT_NEAR(step.ledger.balance, 0, 1e-15); // of energies about 1e-7
}

/// Displacement of the far face after 2 s.
double far_after(const std::string& loads, const std::string& analysis, int steps) {
    const auto result = run(bar("  swing: {analysis: {dynamic: " + analysis +
                                "}, duration: 2 s, steps: " + std::to_string(steps) + ", " + loads + "}\n"));
    return displacement(result, result.steps.size() - 1, 1);
}

/// Damping takes out what steps of this size cannot resolve. Driven and loaded at the same end.
TEST(DrivenBar, ConvergesInTimeAtTheOrderOfTheIntegrator) {
    struct Case {
        const char* integrator;
        double order;
    };
    const char* moved = "displacement: {end: {x: {expression: 0.05*sin(2*t)}, y: 0, z: 0}}";
    const char* loaded = "pressure: {end: {expression: 0.05*sin(2*t)}}";
    const std::string damping = ", stiffness_damping: 0.1 s}";
    for (const char* loads : {moved, loaded}) {
        const double exact = far_after(loads, "{integrator: {newmark: {}}" + damping, 3200);
        for (const Case& c : {Case{"{newmark: {}}", 2}, Case{"{generalised_alpha: {rho_inf: 0.5}}", 2},
                              Case{"{generalised_alpha: {rho_inf: 0.9}}", 2}, Case{"{hht: {alpha: -0.2}}", 2},
                              Case{"{backward_euler: {}}", 1}}) {
            const std::string analysis = std::string("{integrator: ") + c.integrator + damping;
            const double coarse = std::abs(far_after(loads, analysis, 100) - exact),
                         fine = std::abs(far_after(loads, analysis, 200) - exact);
            const double slack = 0.15; // of a slope measured between two steps
            EXPECT_NEAR(std::log2(coarse / fine), c.order, slack) << c.integrator << ' ' << loads;
        }
    }
}

TEST(Courses, OfOneValueDoWhatTheValueDoes) {
    const auto of = [](const std::string& end) {
        return run(bar("  press: {ramp: step, steps: 3, displacement: {end: {x: " + end + "}}}\n", clamped));
    };
    const auto value = of("2 mm"), table = of("{table: [[0, 2 mm], [1, 2 mm]]}"),
               formula = of("{expression: 2 + 0*t, unit: mm}");
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(value.steps[k].state.u, table.steps[k].state.u);
        EXPECT_EQ(value.steps[k].state.u, formula.steps[k].state.u);
    }
}

TEST(Courses, OfSetsThatShareNodesMayBeTheSame) {
    const std::string path =
        bar("  push: {displacement: {end: {y: {expression: t}}, side: {y: {expression: t}}}}\n", clamped);
    std::string text;
    {
        std::ifstream file(path);
        text.assign(std::istreambuf_iterator<char>(file), {});
    }
    text.replace(text.find("  far:"), 0, "  side: {body: bar, box: {min: [0, 0, 0], max: [0.5, 0, 0.1]}}\n");
    std::ofstream(path) << text;
    EXPECT_NEAR(run(path).steps.back().state.u[0].y(), 1, round_off);
    const std::size_t at = text.rfind("{expression: t}");
    std::ofstream(path) << text.replace(at, std::strlen("{expression: t}"), "{expression: 2*t}");
    EXPECT_THROW((void)run(path), SceneError);
}

TEST(Courses, GiveTheSameBitsForAnyNumberOfThreads) {
    const std::string path =
        bar("  swing: {analysis: dynamic, steps: 20, displacement: {end: {x: {expression: 0.05*sin(2*t)}}}, "
            "body_force: {bar: [0, {table: [[0, 0], [0.33, 1e-3]]}, 0]}}\n");
    const auto one = run(path), three = run(path, 3);
    ASSERT_EQ(one.steps.size(), three.steps.size());
    for (std::size_t k = 0; k < one.steps.size(); ++k) {
        ASSERT_EQ(one.steps[k].time, three.steps[k].time);
        ASSERT_EQ(one.steps[k].state.u, three.steps[k].state.u);
    }
}

/// At a time that only the steps to a corner ask for.
TEST(Courses, WithoutAValueEndTheRunWithTheirNameAndTime) {
    const std::string path = bar(R"(
  push:
    steps: 4
    displacement: {end: {x: {table: [[0, 0], [0.3, 1 mm], [1, 0]]}, y: {expression: "t == 0.3 ? sqrt(-1) : 0"}}}
)",
                                 clamped);
    try {
        (void)run(path);
        FAIL() << "no failure";
    } catch (const RunFailure& failure) {
        EXPECT_THAT(failure.what(), testing::HasSubstr("stage 'push': displacement.end.y is"));
        EXPECT_THAT(failure.what(), testing::HasSubstr("at 0.3 s after the stage's start"));
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
