#pragma once
/// The units a quantity may be written in.

#include "osculate/scene/units.hpp"

#include <array>
#include <numbers>

namespace osculate::scene {

/// A unit's size in SI as a quotient: "5 mm" is 5 / 1000, the double nearest to 0.005, which 5 * 0.001 need not be.
struct Unit {
    Dimension dimension;
    double numerator = 1, denominator = 1;
};

struct Symbol {
    const char* text;
    Unit unit;
    bool takes_prefix;
};

inline constexpr std::array symbols{
    Symbol{"m", {dimension::length}, true},
    Symbol{"g", {{0, 1, 0, 0}, 1, 1e3}, true},
    Symbol{"s", {dimension::time}, true},
    Symbol{"N", {dimension::force}, true},
    Symbol{"Pa", {dimension::pressure}, true},
    Symbol{"J", {{2, 1, -2, 0}}, true},
    Symbol{"W", {{2, 1, -3, 0}}, true},
    Symbol{"Hz", {{0, 0, -1, 0}}, true},
    Symbol{"rad", {dimension::angle}, true},
    Symbol{"t", {{0, 1, 0, 0}, 1e3, 1}, false},
    Symbol{"bar", {dimension::pressure, 1e5, 1}, false},
    Symbol{"min", {dimension::time, 60, 1}, false},
    Symbol{"h", {dimension::time, 3600, 1}, false},
    Symbol{"deg", {dimension::angle, std::numbers::pi, 180}, false},
    Symbol{"K", {dimension::temperature}, false},
    Symbol{"in", {dimension::length, 254, 1e4}, false},
    Symbol{"ft", {dimension::length, 3048, 1e4}, false},
    Symbol{"lb", {{0, 1, 0, 0}, 45359237, 1e8}, false},
    Symbol{"lbf", {dimension::force, 44482216152605, 1e13}, false},
    Symbol{"psi", {dimension::pressure, 44482216152605, 6451600000}, false}, // lbf/in^2
    Symbol{"ksi", {dimension::pressure, 44482216152605, 6451600}, false},
};

struct Prefix {
    const char* text;
    double numerator, denominator;
};

inline constexpr std::array prefixes{
    Prefix{"n", 1, 1e9}, Prefix{"u", 1, 1e6}, Prefix{"µ", 1, 1e6}, Prefix{"m", 1, 1e3}, Prefix{"c", 1, 1e2},
    Prefix{"d", 1, 1e1}, Prefix{"k", 1e3, 1}, Prefix{"M", 1e6, 1}, Prefix{"G", 1e9, 1}, Prefix{"T", 1e12, 1},
};

} // namespace osculate::scene
