#include "osculate/scene/units.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

// Every expected value below is the double that the decimal names: units are exact quotients, so equality is exact.
void expect_quantity(const char* text, double value, Dimension dimension) {
    const Quantity quantity = parse_quantity(text);
    EXPECT_EQ(quantity.problem, "") << text;
    EXPECT_EQ(quantity.value, value) << text;
    EXPECT_EQ(quantity.dimension, dimension) << text;
    EXPECT_TRUE(quantity.has_unit) << text;
}

TEST(Units, ReadPrefixesExactly) {
    expect_quantity("30 MPa", 30e6, dimension::pressure);
    expect_quantity("5 mm", 0.005, dimension::length);
    expect_quantity("7mm", 0.007, dimension::length);
    expect_quantity("-0.25 m", -0.25, dimension::length);
    expect_quantity("+3 cm", 0.03, dimension::length);
    expect_quantity("2 µm", 2e-6, dimension::length);
    expect_quantity("2 um", 2e-6, dimension::length);
    expect_quantity("1e-3 GPa", 1e6, dimension::pressure);
    expect_quantity("4 kg", 4, Dimension{.mass = 1});
    expect_quantity("4 g", 0.004, Dimension{.mass = 1});
    expect_quantity("1.5 bar", 1.5e5, dimension::pressure);
    expect_quantity("2 min", 120, dimension::time);
    expect_quantity("180 deg", std::numbers::pi, dimension::angle);
    expect_quantity("10 mrad", 0.01, dimension::angle);
}

TEST(Units, ReadEveryPrefixOfEveryUnitThatTakesOne) {
    const std::pair<const char*, const char*> prefixes[] = {{"n", "e-9"}, {"u", "e-6"}, {"µ", "e-6"}, {"m", "e-3"},
                                                            {"c", "e-2"}, {"d", "e-1"}, {"k", "e3"},  {"M", "e6"},
                                                            {"G", "e9"},  {"T", "e12"}, {"", ""}};
    const std::pair<const char*, Dimension> units[] = {{"m", dimension::length},
                                                       {"s", dimension::time},
                                                       {"N", dimension::force},
                                                       {"Pa", dimension::pressure},
                                                       {"J", {.length = 2, .mass = 1, .time = -2}},
                                                       {"W", {.length = 2, .mass = 1, .time = -3}},
                                                       {"Hz", {.time = -1}},
                                                       {"rad", dimension::angle}};
    for (const auto& [prefix, power] : prefixes)
        for (const auto& [unit, dimension] : units)
            expect_quantity((std::string("7 ") + prefix + unit).c_str(), std::stod(std::string("7") + power),
                            dimension);
    const std::pair<const char*, double> grams[] = {{"7 ng", 7e-12}, {"7 mg", 7e-6}, {"7 dg", 7e-4},
                                                    {"7 g", 7e-3},   {"7 kg", 7},    {"7 Mg", 7e3}};
    for (const auto& [text, value] : grams) expect_quantity(text, value, Dimension{.mass = 1});
    const std::pair<const char*, double> hours[] = {{"7 min", 420}, {"7 h", 25200}};
    for (const auto& [text, value] : hours) expect_quantity(text, value, dimension::time);
    for (const char* text : {"7 kbar", "7 kt", "7 mmin", "7 kdeg"})
        EXPECT_NE(parse_quantity(text).problem, "") << text << " takes no prefix";
}

TEST(Units, MultiplyDivideAndRaise) {
    expect_quantity("2 kN/m^3", 2e3, dimension::force_per_volume);
    expect_quantity("7850 kg/m^3", 7850, dimension::density);
    expect_quantity("7.85 t/m^3", 7850, dimension::density);
    expect_quantity("9.81 m/s^2", 9.81, dimension::acceleration);
    expect_quantity("9.81 m s^-2", 9.81, dimension::acceleration);
    expect_quantity("5 N/mm^2", 5e6, dimension::pressure);
    expect_quantity("5 N / mm / mm", 5e6, dimension::pressure);
    expect_quantity("3 kg*m/s^2", 3, dimension::force);
    expect_quantity("1 kg m^-1 s^-2", 1, dimension::pressure);
}

TEST(Units, TakePowersAsPeopleWriteThem) {
    expect_quantity("7850 kg/m3", 7850, dimension::density);
    expect_quantity("5 N/mm2", 5e6, dimension::pressure);
    expect_quantity("5 N/mm²", 5e6, dimension::pressure);
    expect_quantity("7850 kg/m³", 7850, dimension::density);
    expect_quantity("9810 mm/s2", 9.81, dimension::acceleration);
    expect_quantity("9.81 m s-2", 9.81, dimension::acceleration);
    for (const char* text : {"5 m0", "5 m99", "5 m2.5", "5 ²", "5 m²2", "5 m-"})
        EXPECT_NE(parse_quantity(text).problem, "") << text;
}

TEST(Units, KnowInchesAndPounds) { // as defined in 1959, and standard gravity
    expect_quantity("1 in", 0.0254, dimension::length);
    expect_quantity("1 ft", 0.3048, dimension::length);
    expect_quantity("1 lb", 0.45359237, {0, 1, 0, 0});
    EXPECT_DOUBLE_EQ(parse_quantity("1 lbf").value, 0.45359237 * 9.80665);
    EXPECT_EQ(parse_quantity("1 lbf").dimension, dimension::force);
    const double lbf_per_square_inch = 4.4482216152605 / (0.0254 * 0.0254);
    EXPECT_DOUBLE_EQ(parse_quantity("1 psi").value, lbf_per_square_inch);
    EXPECT_DOUBLE_EQ(parse_quantity("29 ksi").value, 29e3 * lbf_per_square_inch);
}

TEST(Units, LeaveABareNumberBare) {
    const Quantity quantity = parse_quantity(" 0.1 ");
    EXPECT_EQ(quantity.problem, "");
    EXPECT_EQ(quantity.value, 0.1);
    EXPECT_FALSE(quantity.has_unit);
}

TEST(Units, RejectWhatIsNoQuantity) {
    for (const char* text : {"", "m", "three m", "0,5 m", "5 m^", "5 m^0", "5 m^99", "5 /", "5 m//s", "5 m^1.5", "0x10",
                             "1e999", "5 e", "1 2", "- 3"})
        EXPECT_NE(parse_quantity(text).problem, "") << text;
}

TEST(Units, NameTheNearestUnit) {
    const Quantity quantity = parse_quantity("30 Mpa");
    EXPECT_EQ(quantity.problem, "unknown unit 'Mpa'");
    EXPECT_EQ(quantity.nearest, "MPa");
}

TEST(Units, KeepAnAngleApartFromANumber) {
    EXPECT_NE(parse_quantity("3 rad").dimension, dimension::none);
}

TEST(Units, ReadNotANumberAsSuch) {
    EXPECT_TRUE(std::isnan(parse_quantity(".nan").value));
    EXPECT_EQ(parse_quantity("-.inf").value, -std::numeric_limits<double>::infinity());
}

TEST(Units, HaveNames) {
    EXPECT_EQ(name_of(dimension::force_per_volume), "force per volume");
    EXPECT_EQ(unit_of(dimension::force_per_volume), "N/m^3");
    EXPECT_EQ(name_of(Dimension{.length = 4, .time = 1}), "m^4 s");
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
