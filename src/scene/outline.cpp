#include "osculate/scene/outline.hpp"

#include "osculate/scene/units.hpp"
#include "scene/describe.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace osculate::scene {

namespace {

/// Six digits, as few as needed.
std::string digits(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.6g", value);
    return text.data();
}

/// Gathers what it is shown; lists in words, numbers with their units.
class Outliner final : public PresentVisitor {
public:
    [[nodiscard]] OutlineItem take() { return std::move(root_); }

    void number(const Key& key, double& value) override { add(key, quantity(value, key)); }
    void optional_number(const Key& key, std::optional<double>& value) override {
        if (value) add(key, quantity(*value, key));
    }
    void optional_relative_length(const Key& key, std::optional<RelativeLength>& value) override {
        if (value)
            add(key, value->metres ? engineering(value->value, "m") : digits(value->value) + " of the facet size");
    }
    void vector(const Key& key, Vec3& value) override { add(key, components(key, {value.x(), value.y(), value.z()})); }
    void optional_vector(const Key& key, std::optional<Vec3>& value) override {
        if (value) vector(key, *value);
    }
    void course(const Key& key, Course& value) override { add(key, in_words(value, key)); }
    void optional_course(const Key& key, std::optional<Course>& value) override {
        if (value) add(key, in_words(*value, key));
    }
    void courses(const Key& key, std::array<Course, 3>& value) override {
        if (std::ranges::all_of(value, [](const Course& c) { return c.is_value(); }))
            return add(key, components(key, {value[0].value(), value[1].value(), value[2].value()}));
        add(key, "(" + in_words(value[0], key) + ", " + in_words(value[1], key) + ", " + in_words(value[2], key) + ")");
    }
    void table(const Key& key, const Key& first, Table& value) override {
        const auto& [x0, y0] = value.rows.front();
        const auto& [x1, y1] = value.rows.back();
        add(key, std::to_string(value.rows.size()) + " rows from " + quantity(x0, first) + ", " + quantity(y0, key) +
                     " to " + quantity(x1, first) + ", " + quantity(y1, key));
    }
    void integer(const Key& key, int& value) override { add(key, std::to_string(value)); }
    void divisions(const Key& key, std::array<int, 3>& value) override {
        add(key, std::to_string(value[0]) + " × " + std::to_string(value[1]) + " × " + std::to_string(value[2]));
    }
    void integers(const Key& key, std::vector<int>& value) override { add(key, listed(value)); }
    void flag(const Key& key, bool& value) override { add(key, value ? "yes" : "no"); }
    void text(const Key& key, std::string& value) override {
        if (!value.empty()) add(key, value);
    }
    void two_names(const Key& key, std::array<std::string, 2>& value) override {
        if (!value[0].empty()) add(key, value[0] + ", " + value[1]);
    }
    void word(const Key& key, const Words& vocabulary, std::size_t& index) override { add(key, vocabulary[index]); }
    void words(const Key& key, const Words& /*vocabulary*/, std::vector<std::string>& value) override {
        std::string list;
        for (const std::string& one : value) list += (list.empty() ? "" : ", ") + one;
        add(key, value.empty() ? "none" : list);
    }
    void points(const Key& key, std::vector<Vec3>& value) override {
        std::string all;
        for (const Vec3& p : value) all += (all.empty() ? "" : ", ") + components(key, {p.x(), p.y(), p.z()});
        add(key, all);
    }
    void axes(const Key& key, Mat3& value) override {
        const auto column = [](const Vec3& v) {
            return "(" + digits(v.x()) + ", " + digits(v.y()) + ", " + digits(v.z()) + ")";
        };
        add(key, column(value.col(0)) + ", " + column(value.col(1)));
    }
    void group(const Key& key, const std::function<void()>& body) override {
        OutlineItem* const above = here_;
        OutlineItem mine{key.name, "", {}};
        here_ = &mine;
        body();
        here_ = above;
        here_->items.push_back(std::move(mine));
    }

private:
    static std::string quantity(double value, const Key& key) {
        if (key.unit == dimension::angle) return digits(value * 180 / std::numbers::pi) + " deg";
        return engineering(value, unit_of(key.unit));
    }
    /// "(1, 2, 3) mm": one prefix for all, that of the largest.
    static std::string components(const Key& key, const std::array<double, 3>& values) {
        const std::string unit = unit_of(key.unit);
        if (unit.empty() || key.unit == dimension::angle) {
            std::string list;
            for (const double value : values) list += (list.empty() ? "(" : ", ") + quantity(value, key);
            return list + ")";
        }
        double largest = 0;
        for (const double value : values) largest = std::max(largest, std::abs(value));
        const std::string text = engineering(largest, unit);
        const std::size_t space = text.find(' ');
        double shown = 0;
        std::from_chars(text.data(), text.data() + space, shown);
        const double factor = largest > 0 ? std::round(std::log10(shown / largest)) : 0;
        std::string list;
        for (const double value : values) list += (list.empty() ? "(" : ", ") + digits(value * std::pow(10, factor));
        return list + ")" + text.substr(space);
    }
    static std::string in_words(const Course& course, const Key& key) {
        if (course.is_value()) return quantity(course.value(), key);
        if (const auto* expression = std::get_if<Expression>(&course.form))
            return expression->text + (expression->unit.empty() ? "" : " " + expression->unit);
        const auto& rows = std::get<Table>(course.form).rows;
        std::string list;
        constexpr std::size_t few = 6;
        for (std::size_t i = 0; i < std::min(few, rows.size()); ++i)
            list += (i > 0 ? ", " : "") + quantity(rows[i][1], key) + " at " + engineering(rows[i][0], "s");
        return list + (rows.size() > few ? ", ... (" + std::to_string(rows.size()) + " rows)" : "");
    }
    void add(const Key& key, std::string text) { here_->items.push_back({key.name, std::move(text), {}}); }

    OutlineItem root_;
    OutlineItem* here_ = &root_;
};

} // namespace

const OutlineItem* OutlineItem::find(const std::string& name) const {
    for (const OutlineItem& item : items)
        if (item.key == name) return &item;
    return nullptr;
}

OutlineItem outline(const Scene& scene) {
    Outliner outliner;
    Scene shown = scene; // describe takes what a reader could fill; nothing is changed here
    describe(outliner, shown);
    return outliner.take();
}

std::string engineering(double value, const std::string& unit) {
    const auto shown = [](double number, std::string with) {
        for (const auto& [power, sign] : {std::pair{"^2", "²"}, std::pair{"^3", "³"}})
            if (const std::size_t at = with.find(power); at != std::string::npos) with.replace(at, 2, sign);
        return digits(number) + (with.empty() ? "" : " " + with);
    };
    constexpr double next_to_nothing = 1e-13;
    static const std::array<std::string, 9> prefixes{"p", "n", "µ", "m", "", "k", "M", "G", "T"};
    constexpr int none = 4, last = 8;
    static const std::array<std::string, 6> starts{"Pa", "N", "J", "W", "s", "m"};
    const std::string first = unit.substr(0, unit.find('/'));
    const bool prefixed = std::ranges::count(starts, first) > 0 && (first != "m" || unit == "m");
    if (!prefixed || !std::isfinite(value) || std::abs(value) < next_to_nothing) return shown(value, unit);
    // a metre takes no larger prefix than kilo, a second none above itself
    const int largest = first == "s" ? none : unit == "m" ? none + 1 : last;
    int p = none + static_cast<int>(std::floor(std::log10(std::abs(value)) / 3 + 1e-9));
    p = std::clamp(p, 0, largest);
    return shown(value * std::pow(10., -3 * (p - none)), prefixes[static_cast<std::size_t>(p)] + unit);
}

} // namespace osculate::scene
