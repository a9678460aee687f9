/// Closed solutions against numbers known from elsewhere.

#include "osculate/study/formulas.hpp"

#include "support/source_tree.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace osculate::study::OSCULATE_THIS_FILE {
namespace {

double call(const std::string& name, const std::vector<double>& arguments) {
    for (const NamedSolution& f : formulas())
        if (name == f.name) {
            EXPECT_EQ(static_cast<int>(arguments.size()), f.count) << name;
            return f.value(arguments.data());
        }
    throw std::invalid_argument(name);
}

constexpr double digits5 = 5e-5, digits4 = 5e-4; ///< relative, of numbers given with so many digits
constexpr double round_off = 1e-12;

void expect_digits(double value, double expected, double tolerance) {
    EXPECT_NEAR(value, expected, tolerance * std::abs(expected));
}

TEST(Formulas, TheirPageListsThem) {
    std::ifstream file(support::source_tree() + "/docs/studies.md");
    std::stringstream page;
    page << file.rdbuf();
    for (const NamedSolution& f : formulas()) {
        const std::string row =
            "| `" + std::string(f.name) + "(" + f.parameters + ")` | " + f.meaning + " | " + f.source + " |";
        EXPECT_NE(page.str().find(row), std::string::npos)
            << "docs/studies.md lacks what `osculate study --formulas` lists: " << row;
    }
}

TEST(Formulas, EveryOneHasItsOwnNameAndAsManyParametersAsItLists) {
    std::vector<std::string> names;
    for (const NamedSolution& f : formulas()) {
        const std::string parameters = f.parameters;
        EXPECT_EQ(1 + std::count(parameters.begin(), parameters.end(), ','), f.count) << f.name;
        EXPECT_EQ(std::count(names.begin(), names.end(), f.name), 0) << f.name;
        names.emplace_back(f.name);
    }
}

/// Two hemispheres of radius 50, E 20000, nu 0.3, brought together by 2 mm each (Code_Aster SSNV104).
TEST(Formulas, HertzTwoHemispheres) {
    const double Es = call("effective_modulus", {20000, 0.3, 20000, 0.3}), R = call("effective_radius", {50, 50});
    const double F = call("hertz_sphere_force", {4, R, Es});
    expect_digits(call("hertz_sphere_radius", {F, R, Es}), 10, digits5);
    expect_digits(call("hertz_sphere_peak_pressure", {F, R, Es}), 2798.3, digits5);
    expect_digits(call("hertz_sphere_approach", {F, R, Es}), 4, round_off);
    expect_digits(call("hertz_sphere_pressure", {6, F, R, Es}), 0.8 * 2798.3, digits5);
    EXPECT_EQ(call("hertz_sphere_pressure", {11, F, R, Es}), 0);
}

TEST(Formulas, HertzUnequalSpheres) {
    const double Es = call("effective_modulus", {1e8, 0.29, 1e6, 0.29}), F = 117808.787;
    const double R = 12.2474 / 4; // two of diameter 12.2474 m
    expect_digits(call("hertz_sphere_radius", {F, R, Es}), 0.63018, digits4);
    expect_digits(call("hertz_sphere_peak_pressure", {F, R, Es}), 1.41642e5, digits4);
}

TEST(Formulas, HertzCylinderIsInEquilibriumAndInvertsItself) {
    const double P = 3e4, R = 0.2, Es = 1e9, b = call("hertz_cylinder_half_width", {P, R, Es});
    expect_digits(call("hertz_cylinder_force", {b, R, Es}), P, round_off);
    const double p0 = call("hertz_cylinder_peak_pressure", {P, R, Es});
    expect_digits(p0, std::sqrt(P * Es / (std::numbers::pi * R)), round_off); // the other form of the same
    double sum = 0;                                                           // of the pressure over the strip
    constexpr int parts = 20000;
    for (int i = 0; i < parts; ++i)
        sum += call("hertz_cylinder_pressure", {b * (2 * (i + 0.5) / parts - 1), P, R, Es}) * 2 * b / parts;
    expect_digits(sum, P, 1e-5); // of the midpoint rule at the root's ends
    // half of a long cylinder: a thousandth of its diameter at b = R/20, more or less
    EXPECT_GT(call("hertz_cylinder_approach", {P, R, b, 2e9, 0.3}), b * b / R / 4);
}

TEST(Formulas, CattaneoMindlinTractionSumsUpToTheTangentialForce) {
    const double b = 0.01, P = 1e5, mu = 0.3, Q = 0.6 * mu * P;
    const double c = call("cattaneo_mindlin_stick_half_width", {b, Q, mu, P});
    expect_digits(c, b * std::sqrt(0.4), round_off);
    double sum = 0, largest = 0;
    constexpr int parts = 20000;
    for (int i = 0; i < parts; ++i) {
        const double q = call("cattaneo_mindlin_traction", {b * (2 * (i + 0.5) / parts - 1), b, Q, mu, P});
        sum += q * 2 * b / parts;
        largest = std::max(largest, q);
    }
    expect_digits(sum, Q, 1e-5);
    expect_digits(call("cattaneo_mindlin_peak_traction", {b, Q, mu, P}), largest, 1e-3); // a kink between two points
    expect_digits(call("cattaneo_mindlin_traction", {c, b, Q, mu, P}),
                  call("cattaneo_mindlin_peak_traction", {b, Q, mu, P}), round_off);
    expect_digits(call("cattaneo_mindlin_stick_radius", {b, Q, mu, P}), b * std::cbrt(0.4), round_off);
}

TEST(Formulas, LameNestedTubes) {
    expect_digits(call("nested_tubes_pressure", {25, 20, 30, 40}), 6.4815, digits5);
    // both tubes move together: the inner one by inner and outer pressure, the outer by the one between them
    const double E = 1e5, nu = 0.3, whole = call("tube_displacement", {30, 25, 20, 40, E, nu});
    expect_digits(call("tube_displacement", {30, 6.481481481481482, 30, 40, E, nu}), whole, round_off);
}

TEST(Formulas, Bars) {
    expect_digits(call("bar_interface_stress", {0.1, 1, 1, 1, 1}), 0.05, round_off);
    expect_digits(call("bar_interface_stress", {2, 4, 9, 1, 1}), 2 / (1. / 6 + 1), round_off);
    expect_digits(call("bar_contact_duration", {1, 4, 1}), 1, round_off);
}

TEST(Formulas, Incline) {
    expect_digits(call("incline_acceleration", {10, 0.5, 0.49}), 0.0894, digits4);
    EXPECT_EQ(call("incline_acceleration", {10, 0.5, 0.5}), 0);
    EXPECT_EQ(call("incline_acceleration", {10, 0.5, 0.6}), 0);
    expect_digits(call("fall_duration", {0.5, 10}), 0.316228, digits5);
}

/// Two balls of steel, 10 mm, that close at 2 m/s.
TEST(Formulas, HertzImpact) {
    const double m = 7850 * 4. / 3 * std::numbers::pi * 1e-6 / 2, R = 5e-3;
    const double Es = call("effective_modulus", {210e9, 0.3, 210e9, 0.3});
    expect_digits(call("hertz_impact_approach", {m, 2, R, Es}), 35.590e-6, digits5);
    expect_digits(call("hertz_impact_duration", {m, 2, R, Es}), 52.376e-6, digits5);
    expect_digits(call("hertz_impact_force", {m, 2, R, Es}), 2309.8, digits5);
    expect_digits(call("hertz_impact_duration", {m, 2, R, Es}),
                  2.94328 * call("hertz_impact_approach", {m, 2, R, Es}) / 2, 2e-6); // six digits
}

TEST(Formulas, BouncingRod) {
    for (const double x : {0.0, 0.25, 0.5, 1.0}) {
        EXPECT_EQ(call("rod_displacement", {x, 0}), (1 - x) / 2);
        EXPECT_NEAR(call("rod_displacement", {x, 3}), (1 - x) / 2, round_off);
    }
    EXPECT_EQ(call("rod_displacement", {0, 0.5}), 0.25);
    EXPECT_EQ(call("rod_displacement", {0, 1.5}), 0) << "held by the stop";
    EXPECT_EQ(call("rod_displacement", {0.5, 1.5}), -0.25);
    EXPECT_EQ(call("rod_reaction", {0.9}), 0);
    EXPECT_EQ(call("rod_reaction", {1.4}), 0.5);
    EXPECT_EQ(call("rod_reaction", {4.6}), 0.5);
    EXPECT_EQ(call("rod_reaction", {2.1}), 0);
}

TEST(Formulas, OscillatorObeysItsEquation) {
    const double omega = 3, zeta = 0.1, u0 = 0.2, v0 = -0.5, h = 1e-4;
    const auto u = [&](double t) { return call("oscillator_displacement", {t, omega, zeta, u0, v0}); };
    EXPECT_EQ(u(0), u0);
    EXPECT_NEAR((u(h) - u(-h)) / (2 * h), v0, 1e-6); // central difference, h^2
    const double t = 0.7, v = (u(t + h) - u(t - h)) / (2 * h), a = (u(t + h) - 2 * u(t) + u(t - h)) / (h * h);
    EXPECT_NEAR(a + 2 * zeta * omega * v + omega * omega * u(t), 0, 1e-6);
}

} // namespace
} // namespace osculate::study::OSCULATE_THIS_FILE
