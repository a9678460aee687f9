#include "osculate/equilibrium/integrator.hpp"

#include "support/floating_point_traps.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

namespace osculate::equilibrium::OSCULATE_THIS_FILE {
namespace {

struct Motion {
    double u = 0, v = 0, a = 0;
};

/// u'' + 2 xi w (u' - b') + w^2 (u - b) = 0: a mass on a spring and a dashpot whose other end moves by b = B sin(p t).
struct Oscillator {
    double w = 2, xi = 0, B = 0, p = 1.3;
    double u_start = 0.7, v_start = -0.4;

    [[nodiscard]] double force(const Motion& mass, const Motion& base) const {
        return 2 * xi * w * (mass.v - base.v) + w * w * (mass.u - base.u);
    }
    [[nodiscard]] Motion start() const {
        const Motion mass{u_start, v_start, 0};
        return {u_start, v_start, -force(mass, base(0))};
    }
    [[nodiscard]] Motion base(double t) const {
        return {B * std::sin(p * t), p * B * std::cos(p * t), -p * p * B * std::sin(p * t)};
    }
    /// Free decay on top of the steady answer to the base.
    [[nodiscard]] Motion exact(double t) const {
        using Complex = std::complex<double>;
        const Complex i(0, 1), damper = 2 * xi * w * p * i;
        const Complex steady = B * (w * w + damper) / (w * w - p * p + damper);
        const double decay = xi * w, w_d = w * std::sqrt(1 - xi * xi);
        const double cosine = u_start - steady.imag();
        const double sine = (v_start - (i * p * steady).imag() + decay * cosine) / w_d;
        const Complex s(-decay, w_d), free = Complex(sine, cosine) * std::exp(s * t); // its imaginary part is the decay
        const Complex driven = steady * std::exp(i * p * t);
        return {(free + driven).imag(), (s * free + i * p * driven).imag()};
    }
};

Vec3 along_x(double value) {
    return {value, 0, 0};
}

/// v and a that the integrator gives to a displacement.
Motion follow(const Integrator& integrator, double dt, double u, const Motion& n) {
    const Kinematics k = kinematics(integrator, dt);
    const Vec3 x = along_x(u), u_n = along_x(n.u), v_n = along_x(n.v), a_n = along_x(n.a);
    return {u, k.velocity(x, u_n, v_n, a_n).x(), k.acceleration(x, u_n, v_n, a_n).x()};
}

/// One step of the mass: equilibrium at the integrator's weights, linear in the displacement.
Motion step(const Integrator& integrator, const Oscillator& oscillator, double dt, const Motion& n,
            const Motion& base_n, const Motion& base) {
    const double alpha_m = integrator.alpha_m, alpha_f = integrator.alpha_f;
    const auto residual = [&](const Motion& mass) {
        return (1 - alpha_m) * mass.a + alpha_m * n.a + (1 - alpha_f) * oscillator.force(mass, base) +
               alpha_f * oscillator.force(n, base_n);
    };
    const Kinematics k = kinematics(integrator, dt);
    const double slope =
        (1 - alpha_m) * k.by_u_acceleration +
        (1 - alpha_f) * (2 * oscillator.xi * oscillator.w * k.by_u_velocity + oscillator.w * oscillator.w);
    const Vec3 predicted = integrator.predictor(along_x(n.u), along_x(n.v), along_x(n.a), dt);
    const Motion trial = follow(integrator, dt, predicted.x(), n);
    return follow(integrator, dt, trial.u - residual(trial) / slope, n);
}

struct Errors {
    double u = 0, v = 0;
};

/// Largest errors on the way to `end`. The base is a node whose displacement is prescribed: its velocity and
/// acceleration are the integrator's, as those of every driven node.
Errors errors(const Integrator& integrator, const Oscillator& oscillator, double end, int steps) {
    const double dt = end / steps;
    Motion mass = oscillator.start(), base = oscillator.base(0);
    Errors worst;
    for (int n = 1; n <= steps; ++n) {
        const Motion base_next = follow(integrator, dt, oscillator.base(n * dt).u, base);
        mass = step(integrator, oscillator, dt, mass, base, base_next);
        base = base_next;
        const Motion exact = oscillator.exact(n * dt);
        worst.u = std::max(worst.u, std::abs(mass.u - exact.u));
        worst.v = std::max(worst.v, std::abs(mass.v - exact.v));
    }
    return worst;
}

struct Member {
    const char* name;
    Integrator integrator;
    int order;
};

void PrintTo(const Member& member, std::ostream* out) {
    *out << member.name;
}

class EveryIntegrator : public testing::TestWithParam<Member> {
protected:
    void expect_order(const Oscillator& oscillator) const {
        constexpr double tolerance = 0.1; // of the slope: the next order still counts at some 200 steps a period
        constexpr double end = 6;         // s, some two periods
        const Errors coarse = errors(GetParam().integrator, oscillator, end, 400);
        const Errors fine = errors(GetParam().integrator, oscillator, end, 800);
        EXPECT_NEAR(std::log2(coarse.u / fine.u), GetParam().order, tolerance) << coarse.u << " to " << fine.u;
        EXPECT_NEAR(std::log2(coarse.v / fine.v), GetParam().order, tolerance) << coarse.v << " to " << fine.v;
    }
};

INSTANTIATE_TEST_SUITE_P(Of, EveryIntegrator,
                         testing::Values(Member{"GeneralisedAlpha", generalised_alpha(0.6), 2},
                                         Member{"Newmark", newmark(0.25, 0.5), 2}, Member{"Hht", hht(-0.2), 2},
                                         Member{"BackwardEuler", backward_euler(), 1},
                                         Member{"GeneralisedAlphaZero", generalised_alpha(0), 2},
                                         Member{"DissipativeNewmark", newmark(0.36, 0.7), 1}),
                         [](const auto& test) { return test.param.name; });

TEST_P(EveryIntegrator, HasItsOrderInFreeVibration) {
    expect_order({});
}

TEST_P(EveryIntegrator, HasItsOrderWithDamping) {
    expect_order({.xi = 0.15});
}

TEST_P(EveryIntegrator, HasItsOrderWhenDrivenByAMotion) {
    expect_order({.xi = 0.15, .B = 0.8});
    expect_order({.xi = 0, .B = 0.8, .u_start = 0, .v_start = 0});
}

constexpr double round_off = 1e-12; // relative; a handful of operations on numbers near 1

TEST_P(EveryIntegrator, KinematicsAreTheirFormulasSolvedForTheNewMotion) {
    const Integrator& i = GetParam().integrator;
    const double dt = 0.37;
    const Vec3 u(0.3, -1.2, 2.1), u_n(0.2, -1, 1.7), v_n(0.5, 0.1, -0.9), a_n(-1.1, 0.4, 0.6);
    const Kinematics k = kinematics(i, dt);
    const Vec3 v = k.velocity(u, u_n, v_n, a_n), a = k.acceleration(u, u_n, v_n, a_n);
    EXPECT_LT((u_n + dt * v_n + dt * dt * (i.beta_n * a_n + i.beta * a) - u).norm(), round_off);
    EXPECT_LT((v_n + dt * ((1 - i.gamma) * a_n + i.gamma * a) - v).norm(), round_off);
    const Vec3 d(0.1, 0.2, -0.3); // affine: a difference is the derivative
    EXPECT_LT((k.velocity(u + d, u_n, v_n, a_n) - v - k.by_u_velocity * d).norm(), round_off * k.by_u_velocity);
    EXPECT_LT((k.acceleration(u + d, u_n, v_n, a_n) - a - k.by_u_acceleration * d).norm(),
              round_off * k.by_u_acceleration);
}

TEST_P(EveryIntegrator, PredictorKeepsTheAcceleration) {
    const Vec3 u_n(0.2, -1, 1.7), v_n(0.5, 0.1, -0.9), a_n(-1.1, 0.4, 0.6);
    const double dt = 0.37;
    const Vec3 u = GetParam().integrator.predictor(u_n, v_n, a_n, dt);
    const Vec3 a = kinematics(GetParam().integrator, dt).acceleration(u, u_n, v_n, a_n);
    EXPECT_LT((a - a_n).norm(), round_off);
    EXPECT_LT(GetParam().integrator.local_error(a, a_n, dt), round_off);
}

TEST(BackwardEuler, TakesDifferencesOfPositionAndOfVelocity) {
    const double dt = 0.37;
    const Vec3 u(0.3, -1.2, 2.1), u_n(0.2, -1, 1.7), v_n(0.5, 0.1, -0.9), a_n(-1.1, 0.4, 0.6);
    const Kinematics k = kinematics(backward_euler(), dt);
    const Vec3 v = k.velocity(u, u_n, v_n, a_n);
    EXPECT_LT((v - (u - u_n) / dt).norm(), round_off);
    EXPECT_LT((k.acceleration(u, u_n, v_n, a_n) - (v - v_n) / dt).norm(), round_off);
}

/// Largest modulus of the eigenvalues of (u, v, a) -> (u, v, a) one step later.
double spectral_radius(const Integrator& integrator, double w_dt) {
    // accelerations in units of w^2 keep the entries near 1, where the eigenvalues are exact
    const Oscillator oscillator{.w = w_dt};
    const double dt = 1;
    Mat3 amplification;
    const double a_scale = w_dt * w_dt;
    for (int column = 0; column < 3; ++column) {
        const Motion n{column == 0 ? 1. : 0., column == 1 ? 1. : 0., column == 2 ? a_scale : 0.};
        const Motion next = step(integrator, oscillator, dt, n, {}, {});
        amplification.col(column) = Vec3(next.u, next.v, next.a / a_scale);
    }
    return amplification.eigenvalues().cwiseAbs().maxCoeff();
}

constexpr double stiff = 1e5; // w dt
// The eigenvalues meet at infinity: what is of the order of (w dt)^-2 or of round-off moves a triple one by its cube root.
constexpr double triple_root = 2e-3;

TEST(GeneralisedAlpha, SpectralRadiusAtInfinityIsRhoInf) {
    for (const double rho : {0., 0.25, 0.5, 0.8, 1.})
        EXPECT_NEAR(spectral_radius(generalised_alpha(rho), stiff), rho, triple_root);
}

TEST(GeneralisedAlpha, DissipatesHighFrequenciesBeforeLowOnes) {
    const Integrator integrator = generalised_alpha(0.5);
    EXPECT_GT(spectral_radius(integrator, 0.1), 1 - 1e-5); // 1 - O((w dt)^4)
    EXPECT_LT(spectral_radius(integrator, 10), 0.8);
    for (const double w_dt : {0.01, 0.1, 1., 10., 100.}) EXPECT_LE(spectral_radius(integrator, w_dt), 1);
}

TEST(Hht, SpectralRadiusAtInfinityIsItsOwn) {
    for (const double alpha : {-1. / 3, -0.2, -0.05})
        EXPECT_NEAR(spectral_radius(hht(alpha), stiff), (1 + alpha) / (1 - alpha), triple_root);
}

TEST(BackwardEuler, SpectralRadiusAtInfinityIsZero) {
    EXPECT_NEAR(spectral_radius(backward_euler(), stiff), 0, triple_root);
}

TEST(Newmark, KeepsTheEnergyOfALinearOscillator) {
    constexpr double tolerance = 1e-10; // relative, over all steps
    const Oscillator oscillator;
    const double dt = 0.11;
    const auto energy = [&](const Motion& m) {
        return 0.5 * m.v * m.v + 0.5 * oscillator.w * oscillator.w * m.u * m.u;
    };
    for (const Integrator& integrator : {newmark(0.25, 0.5), hht(0)}) {
        Motion mass = oscillator.start();
        const double start = energy(mass);
        double worst = 0;
        for (int n = 0; n < 10000; ++n) {
            mass = step(integrator, oscillator, dt, mass, {}, {});
            worst = std::max(worst, std::abs(energy(mass) / start - 1));
        }
        EXPECT_LT(worst, tolerance);
    }
}

TEST(Newmark, LocalErrorIsEstimatedToTheNextOrder) {
    const Oscillator oscillator{.xi = 0.1};
    const double dt = 0.005;
    for (const Integrator& integrator : {newmark(0.25, 0.5), newmark(0.3, 0.5), newmark(0.08, 0.5)}) {
        const Motion n = oscillator.start(), next = step(integrator, oscillator, dt, n, {}, {});
        const double error = std::abs(next.u - oscillator.exact(dt).u);
        constexpr double next_order = 0.05; // the estimate's own relative error is of the order of w dt = 0.01
        EXPECT_NEAR(integrator.local_error(along_x(next.a), along_x(n.a), dt) / error, 1, next_order);
    }
}

/// a_n of these methods belongs to the time t + (alpha_m - alpha_f) dt.
TEST(GeneralisedAlpha, LocalErrorIsEstimatedToTheNextOrderToo) {
    const Oscillator oscillator{.xi = 0.1};
    const double dt = 0.002;
    for (const Integrator& integrator :
         {generalised_alpha(0), generalised_alpha(0.5), generalised_alpha(0.8), hht(-0.3)}) {
        Motion n = oscillator.start();
        Oscillator at = oscillator; // the same, from where a_n belongs to
        const double early = (integrator.alpha_m - integrator.alpha_f) * dt;
        const Motion then = oscillator.exact(early);
        at.u_start = then.u;
        at.v_start = then.v;
        n.a = at.start().a;
        const Motion next = step(integrator, oscillator, dt, n, {}, {});
        const double error = std::abs(next.u - oscillator.exact(dt).u);
        constexpr double next_order = 0.05; // of the order of w dt = 0.004, over coefficients that differ by 10
        EXPECT_NEAR(integrator.local_error(along_x(next.a), along_x(n.a), dt) / error, 1, next_order);
    }
}

TEST(BackwardEuler, LocalErrorIsThatOfTheVelocityTimesTheStep) {
    const Oscillator oscillator{.xi = 0.1};
    const double dt = 0.001;
    const Motion n = oscillator.start(), next = step(backward_euler(), oscillator, dt, n, {}, {});
    const double error = dt * std::abs(next.v - oscillator.exact(dt).v);
    constexpr double next_order = 0.05;
    EXPECT_NEAR(backward_euler().local_error(along_x(next.a), along_x(n.a), dt) / error, 1, next_order);
}

TEST(Integrator, RefusesParametersOutOfBounds) {
    const support::FloatingPointTraps suspended(false); // a comparison with NaN is an invalid operation
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double rho : {-1e-9, 1 + 1e-9, nan}) EXPECT_THROW((void)generalised_alpha(rho), std::invalid_argument);
    for (const double alpha : {-1. / 3 - 1e-9, 1e-9, nan}) EXPECT_THROW((void)hht(alpha), std::invalid_argument);
    for (const double beta : {0., -0.1, nan}) EXPECT_THROW((void)newmark(beta, 0.5), std::invalid_argument);
    for (const double gamma : {0.5 - 1e-9, nan}) EXPECT_THROW((void)newmark(0.25, gamma), std::invalid_argument);
    EXPECT_NO_THROW((void)generalised_alpha(0));
    EXPECT_NO_THROW((void)generalised_alpha(1));
    EXPECT_NO_THROW((void)hht(-1. / 3));
    EXPECT_NO_THROW((void)hht(0));
}

TEST(Integrator, NamesMeetWhereTheMethodsDo) {
    const Integrator a = hht(0), b = newmark(0.25, 0.5), c = generalised_alpha(1);
    EXPECT_EQ(a.beta, b.beta);
    EXPECT_EQ(a.gamma, b.gamma);
    EXPECT_EQ(a.alpha_f, b.alpha_f);
    EXPECT_EQ(c.beta, b.beta); // the midpoint rule: the same kinematics, equilibrium at t + dt/2
    EXPECT_EQ(c.gamma, b.gamma);
    EXPECT_EQ(c.alpha_f, 0.5);
    EXPECT_EQ(c.alpha_m, 0.5);
    const Integrator d = generalised_alpha(0.5);
    EXPECT_DOUBLE_EQ(d.alpha_m, 0);
    EXPECT_DOUBLE_EQ(d.alpha_f, 1. / 3);
    EXPECT_DOUBLE_EQ(d.gamma, 5. / 6);
    EXPECT_DOUBLE_EQ(d.beta, 4. / 9);
}

} // namespace
} // namespace osculate::equilibrium::OSCULATE_THIS_FILE
