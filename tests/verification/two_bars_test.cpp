/// Two equal bars that meet head on, against the exact solution by their waves.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>

namespace osculate {
namespace {

constexpr double area = 0.01, stress = 0.05, p0 = 0.1 * area, E0 = 0.5 * 0.1 * 0.1 * area;
constexpr double meeting = 0.1, parting = 2.1;

double energy(const support::RunStep& step) {
    return step.ledger.kinetic + step.ledger.strain;
}

struct Impact {
    double touch = 0, release = 0; ///< s
    double plateau = 0;            ///< mean stress while they touch, less a tenth of it at either end, Pa
    double stress_error = 0;       ///< mean over the contact, of the exact stress
    double impulse = 0, left = 0;  ///< N s; velocity left in the left bar, m/s
};

Impact meet(int elements, const std::string& integrator = "{newmark: {}}") {
    support::SceneRun run;
    const std::string divisions = "[" + std::to_string(elements) + ", 1, 1]";
    support::run_scene(run, support::shipped("validation/two_bars.yaml"),
                       {{"bodies.left.mesh.block.divisions", divisions},
                        {"bodies.right.mesh.block.divisions", divisions},
                        {"stages.impact.analysis.dynamic.integrator", integrator},
                        {"stages.impact.steps", std::to_string(int(std::lround((std::getenv("RATIO")?std::atof(std::getenv("RATIO")):6.) * elements)))}});
    Impact impact;
    double before = 0, plateau = 0, dE = 0;
    for (const support::RunStep& step : run.steps) {
        const double t = step.time, dt = t - before, force = step.pairs[0].normal;
        before = t;
        impact.impulse += force * dt;
        if (force > 0 && impact.touch == 0) impact.touch = t;
        if (force > 0) impact.release = t;
        const double exact = t > meeting && t < parting ? stress : 0;
        impact.stress_error += dt * std::abs(force / area - exact) / (stress * (parting - meeting));
        if (t > meeting + 0.2 && t < parting - 0.2) {
            impact.plateau += dt * force / area;
            plateau += dt;
        }
        EXPECT_NEAR(step.ledger.linear.x(), p0, 1e-11 * p0); // round-off of 600 steps
        dE = std::max(dE, std::abs(energy(step) / E0 - 1));
    }
    impact.plateau /= plateau;
    const model::Body& body = run.plan.model.bodies[0];
    for (Index i = 0; i < body.nodes(); ++i)
        impact.left += run.steps.back().state.v[body.first_node + i].x() / body.nodes();
    std::printf("%4d elements: touch %.4f, release %.4f, stress %.6f, its error %.3e, impulse %.6e, energy %.1e, left %.5f attempts %d of %zu\n", elements,
                impact.touch, impact.release, impact.plateau, impact.stress_error, impact.impulse, dE, impact.left, run.attempts, run.steps.size());
    return impact;
}
TEST(TwoBars, M) { for (int n : {25, 50, 100, 200}) meet(n); }

} // namespace
} // namespace osculate
