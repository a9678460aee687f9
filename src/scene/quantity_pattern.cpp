#include "scene/quantity_pattern.hpp"

#include "scene/unit_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace osculate::scene {

namespace {

/// All units of one dimension.
struct UnitClass {
    Dimension dimension;
    std::string pattern;
};

std::string one_prefix() {
    std::string letters;
    for (const Prefix& prefix : prefixes) letters += prefix.text;
    return "[" + letters + "]?";
}

std::vector<UnitClass> unit_classes() {
    std::vector<UnitClass> classes;
    for (const Symbol& symbol : symbols) {
        const std::string own = (symbol.takes_prefix ? one_prefix() : std::string()) + symbol.text;
        const auto known = std::ranges::find(classes, symbol.unit.dimension, &UnitClass::dimension);
        if (known == classes.end())
            classes.push_back({symbol.unit.dimension, own});
        else
            known->pattern += "|" + own;
    }
    for (UnitClass& c : classes) c.pattern = "(?:" + c.pattern + ")";
    return classes;
}

Dimension product(Dimension a, int p, Dimension b, int q) {
    return {p * a.length + q * b.length, p * a.mass + q * b.mass, p * a.time + q * b.time, p * a.angle + q * b.angle,
            p * a.temperature + q * b.temperature};
}

std::string power(const UnitClass& c, int p) {
    if (p == 1) return c.pattern;
    const std::string digits = "\\^?" + std::to_string(p);
    return c.pattern + (p == 2 ? "(?:" + digits + "|²)" : p == 3 ? "(?:" + digits + "|³)" : digits);
}

} // namespace

std::string unit_pattern(Dimension dimension) {
    if (dimension == dimension::none) return {};
    constexpr int most = 4; // powers that units of a scene have, two factors together
    static const std::vector<UnitClass> classes = unit_classes();
    std::vector<std::string> alternatives;
    for (const UnitClass& a : classes)
        for (int p = -most; p <= most; ++p) {
            if (p == 0) continue;
            if (product(a.dimension, p, a.dimension, 0) == dimension) {
                alternatives.push_back(power(a, p));
                if (p < 0) alternatives.push_back("1 */ *" + power(a, -p));
            }
            for (const UnitClass& b : classes)
                for (int q = std::abs(p) - most; q <= most - std::abs(p); ++q) {
                    if (&a == &b || p < 0 || q == 0 || product(a.dimension, p, b.dimension, q) != dimension) continue;
                    const std::string times = " *[* ] *" + power(b, q);
                    alternatives.push_back(power(a, p) +
                                           (q < 0 ? "(?: */ *" + power(b, -q) + "|" + times + ")" : times));
                }
        }
    const std::string factor = "[A-Za-zµ]+(?:\\^?-?[1-9]|²|³)?";
    alternatives.push_back(factor + "(?: *[*/ ] *" + factor + "){2,}");
    std::string pattern;
    for (const std::string& alternative : alternatives) pattern += (pattern.empty() ? "" : "|") + alternative;
    return "(?:" + pattern + ")";
}

std::string quantity_pattern(const Key& key) {
    const bool positive = key.range.low >= 0, not_zero = positive && key.range.open_low && key.range.low == 0;
    const std::string sign = positive ? "\\+?" : "[+-]?";
    const std::string unit = unit_pattern(key.unit);
    return "^ *" + sign + (not_zero || key.range.low > 0 ? "(?![0.]+(?![0-9.]))" : "") +
           "(?:[0-9]+\\.?[0-9]*|\\.[0-9]+)(?:[eE][+-]?[0-9]+)?" + (unit.empty() ? "" : "(?: *" + unit + ")?") + " *$";
}

} // namespace osculate::scene
