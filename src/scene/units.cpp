#include "osculate/scene/units.hpp"

#include "osculate/scene/nearest.hpp"
#include "scene/unit_table.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace osculate::scene {

namespace {

struct NamedDimension {
    Dimension dimension;
    const char* name;
    const char* unit;
};

constexpr std::array named_dimensions{
    NamedDimension{dimension::none, "number", ""},
    NamedDimension{dimension::length, "length", "m"},
    NamedDimension{dimension::time, "time", "s"},
    NamedDimension{dimension::angle, "angle", "rad"},
    NamedDimension{dimension::temperature, "temperature", "K"},
    NamedDimension{dimension::expansion, "thermal expansion", "1/K"},
    NamedDimension{dimension::force, "force", "N"},
    NamedDimension{dimension::pressure, "pressure", "Pa"},
    NamedDimension{dimension::density, "density", "kg/m^3"},
    NamedDimension{dimension::acceleration, "acceleration", "m/s^2"},
    NamedDimension{dimension::force_per_volume, "force per volume", "N/m^3"},
    NamedDimension{dimension::pressure_per_velocity, "pressure per velocity", "Pa s/m"},
    NamedDimension{{0, 1, 0, 0}, "mass", "kg"},
    NamedDimension{{2, 0, 0, 0}, "area", "m^2"},
    NamedDimension{{3, 0, 0, 0}, "volume", "m^3"},
    NamedDimension{{1, 0, -1, 0}, "velocity", "m/s"},
    NamedDimension{{0, 0, -1, 0}, "frequency", "Hz"},
    NamedDimension{dimension::moment, "moment", "N m"},
    NamedDimension{dimension::spin, "angular velocity", "rad/s"},
    NamedDimension{{2, 1, -3, 0}, "power", "W"},
    NamedDimension{{0, 1, -2, 0}, "force per length", "N/m"},
    NamedDimension{dimension::inertia, "moment of inertia", "kg m^2"},
};

const NamedDimension* find_named(Dimension dimension) {
    for (const NamedDimension& entry : named_dimensions)
        if (entry.dimension == dimension) return &entry;
    return nullptr;
}

std::optional<Unit> find_unit(std::string_view text) {
    for (const Symbol& symbol : symbols)
        if (text == symbol.text) return symbol.unit;
    for (const Prefix& prefix : prefixes) {
        if (!text.starts_with(prefix.text)) continue;
        const std::string_view rest = text.substr(std::string_view(prefix.text).size());
        for (const Symbol& symbol : symbols)
            if (symbol.takes_prefix && rest == symbol.text)
                return Unit{symbol.unit.dimension, symbol.unit.numerator * prefix.numerator,
                            symbol.unit.denominator * prefix.denominator};
    }
    return std::nullopt;
}

std::vector<std::string> known_units() {
    std::vector<std::string> known;
    for (const Symbol& symbol : symbols) known.emplace_back(symbol.text);
    for (const Symbol& symbol : symbols)
        for (const Prefix& prefix : prefixes)
            if (symbol.takes_prefix) known.push_back(std::string(prefix.text) + symbol.text);
    return known;
}

std::string_view trim(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

/// Takes the power off the end of a symbol, or off what follows it: "mm^2", "mm2", "mm²". @returns 0 if it is unreadable
int take_power(std::string_view& symbol, std::string_view& rest) {
    constexpr std::pair<std::string_view, int> raised[] = {{"²", 2}, {"³", 3}};
    for (const auto& [text, power] : raised)
        if (symbol.ends_with(text)) {
            symbol.remove_suffix(text.size());
            return power;
        }
    const bool marked = rest.starts_with('^');
    const std::string_view digits = rest.substr(marked ? 1 : 0);
    const bool written =
        !digits.empty() &&
        (std::isdigit(static_cast<unsigned char>(digits.front())) != 0 ||
         (digits.size() > 1 && digits.front() == '-' && std::isdigit(static_cast<unsigned char>(digits[1])) != 0));
    if (!marked && !written) return 1;
    constexpr int most = 9;
    int power = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), power);
    if (error != std::errc{} || std::abs(power) > most) return 0;
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    return power;
}

/// unit = [ "1" "/" ] factor { ("*" | "/" | " ") factor };  factor = symbol [ [ "^" ] integer | "²" | "³" ].
class UnitParser {
public:
    UnitParser(std::string_view text, Quantity& result) : rest_(text), result_(result) {}

    void parse() {
        const std::string whole(rest_);
        bool divide = false;
        rest_ = trim(rest_);
        if (rest_.starts_with('1') && trim(rest_.substr(1)).starts_with('/')) { // "1/K"
            rest_ = trim(rest_.substr(1)).substr(1);
            divide = true;
        }
        while (result_.problem.empty()) {
            rest_ = trim(rest_);
            if (!factor(divide)) break;
            rest_ = trim(rest_);
            if (rest_.empty()) break;
            divide = rest_.front() == '/';
            if (divide || rest_.front() == '*') rest_.remove_prefix(1);
        }
        if (!result_.problem.empty() && result_.problem.starts_with("unreadable"))
            result_.problem = "unreadable unit '" + whole + "'";
        // One multiplication or division where the unit is a plain power of ten: no rounding but the last.
        if (numerator_ != 1) result_.value *= numerator_;
        if (denominator_ != 1) result_.value /= denominator_;
    }

private:
    bool factor(bool divide) {
        std::size_t length = 0;
        while (length < rest_.size()) {
            const auto c = static_cast<unsigned char>(rest_[length]);
            if (!std::isalpha(c) && c < 0x80) break;
            ++length;
        }
        std::string_view symbol = rest_.substr(0, length);
        rest_.remove_prefix(length);
        if (symbol.empty()) return fail("unreadable");
        int power = take_power(symbol, rest_);
        if (symbol.empty() || power == 0) return fail("unreadable");
        const std::optional<Unit> unit = find_unit(symbol);
        if (!unit) {
            static const std::vector<std::string> known = known_units();
            result_.nearest = nearest(symbol, known);
            return fail("unknown unit '" + std::string(symbol) + "'");
        }
        if (divide) power = -power;
        const double size = std::pow(unit->numerator, std::abs(power)),
                     part = std::pow(unit->denominator, std::abs(power));
        numerator_ *= power > 0 ? size : part;
        denominator_ *= power > 0 ? part : size;
        result_.dimension.length += power * unit->dimension.length;
        result_.dimension.mass += power * unit->dimension.mass;
        result_.dimension.time += power * unit->dimension.time;
        result_.dimension.angle += power * unit->dimension.angle;
        result_.dimension.temperature += power * unit->dimension.temperature;
        return true;
    }

    bool fail(std::string problem) {
        result_.problem = std::move(problem);
        return false;
    }

    std::string_view rest_;
    Quantity& result_;
    double numerator_ = 1, denominator_ = 1;
};

/// YAML's own spellings of values that are no finite number.
std::optional<double> special_number(std::string_view text) {
    const double infinity = std::numeric_limits<double>::infinity();
    if (text == ".nan" || text == ".NaN" || text == ".NAN") return std::numeric_limits<double>::quiet_NaN();
    const double sign = text.starts_with('-') ? -1 : 1;
    if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
    if (text == ".inf" || text == ".Inf" || text == ".INF") return sign * infinity;
    return std::nullopt;
}

} // namespace

std::string name_of(Dimension dimension) {
    const NamedDimension* named = find_named(dimension);
    return named ? named->name : unit_of(dimension);
}

std::string unit_of(Dimension dimension) {
    if (const NamedDimension* named = find_named(dimension)) return named->unit;
    std::string text;
    const auto factor = [&](const char* symbol, int power) {
        if (power == 0) return;
        text += (text.empty() ? "" : " ") + std::string(symbol);
        if (power != 1) text += "^" + std::to_string(power);
    };
    factor("kg", dimension.mass);
    factor("m", dimension.length);
    factor("s", dimension.time);
    factor("rad", dimension.angle);
    factor("K", dimension.temperature);
    return text;
}

Quantity parse_quantity(std::string_view text) {
    Quantity result;
    text = trim(text);
    if (const auto special = special_number(text)) {
        result.value = *special;
        return result;
    }
    std::string_view rest = text;
    if (rest.starts_with('+') && !rest.starts_with("+-")) rest.remove_prefix(1);
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), result.value);
    if (error == std::errc::result_out_of_range) {
        result.problem = "beyond the range of a number";
        return result;
    }
    if (error != std::errc{}) {
        result.problem = "not a number";
        return result;
    }
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    rest = trim(rest);
    if (rest.empty()) return result;
    result.has_unit = true;
    UnitParser(rest, result).parse();
    return result;
}

std::string number_text(double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

} // namespace osculate::scene
