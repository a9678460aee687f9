#include "deck/load_history.hpp"

#include "deck/words.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace osculate::deck {

double factor_at(const Amplitude& amplitude, double t) {
    const auto after = std::ranges::find_if(amplitude, [t](const auto& row) { return row[0] > t; });
    if (after == amplitude.begin()) return amplitude.front()[1];
    if (after == amplitude.end()) return amplitude.back()[1];
    const auto& [t0, f0] = *(after - 1);
    const auto& [t1, f1] = *after;
    return f0 + (t - t0) / (t1 - t0) * (f1 - f0);
}

void LoadHistory::add(const std::string& origin, double value, const Amplitude* amplitude) {
    Origin& one = origins_[origin];
    one.changed = true;
    one.given.push_back({value, amplitude});
}

void LoadHistory::remove(std::string_view origin) {
    const auto at = origins_.find(origin);
    if (at == origins_.end()) return;
    at->second.given.clear();
    at->second.changed = true;
}

void LoadHistory::remove_all() {
    for (auto& [name, origin] : origins_) remove(name);
}

/// What has no amplitude goes on from the value before the step; what has one begins anew.
double LoadHistory::value_at(const Origin& origin, double t, double duration, bool ramped) {
    if (!origin.changed) return origin.start;
    double plain = 0, varying = 0;
    bool all_vary = !origin.given.empty();
    for (const Term& term : origin.given) {
        if (term.amplitude != nullptr)
            varying += term.value * factor_at(*term.amplitude, t);
        else
            plain += term.value;
        all_vary = all_vary && term.amplitude != nullptr;
    }
    if (!all_vary && ramped) plain = origin.start + std::min(t / duration, 1.0) * (plain - origin.start);
    return plain + varying;
}

std::string LoadHistory::end_step(double duration, bool ramped) {
    const auto is_varying = [](const Term& term) { return term.amplitude != nullptr; };
    bool changed = false, varies = false, slopes = false;
    std::set<double> corners;
    for (const auto& [name, origin] : origins_) {
        if (!origin.changed) continue;
        changed = true;
        slopes = slopes || (ramped && (origin.given.empty() || !std::ranges::all_of(origin.given, is_varying)));
        for (const Term& term : origin.given) {
            if (term.amplitude == nullptr) continue;
            varies = true;
            for (const auto& row : *term.amplitude) corners.insert(row[0]);
        }
    }
    if (!changed) return "";
    const auto at = [&](double t) {
        double sum = 0;
        for (const auto& [name, origin] : origins_) sum += value_at(origin, t, duration, ramped);
        return sum;
    };
    std::string course;
    if (varies) {
        constexpr double same = 1e-9; // of the step: a table's times ascend in 12 digits
        for (const double end : {0.0, duration})
            if (slopes && std::ranges::none_of(corners, [&](double t) { return std::abs(t - end) <= same * duration; }))
                corners.insert(end);
        for (const double t : corners)
            course += (course.empty() ? "[" : ", [") + number(t) + ", " + number(at(t)) + "]";
        course = "{table: [" + course + "]}";
    } else {
        course = number(at(duration));
    }
    for (auto& [name, origin] : origins_) {
        origin.start = value_at(origin, duration, duration, ramped);
        origin.given.clear();
        origin.changed = false;
    }
    return course;
}

bool LoadHistory::gives(std::string_view origin) const {
    const auto at = origins_.find(origin);
    return at != origins_.end() && !at->second.given.empty();
}

double LoadHistory::standing(std::string_view origin) const {
    const auto at = origins_.find(origin);
    return at == origins_.end() ? 0 : at->second.start;
}

double LoadHistory::standing() const {
    double sum = 0;
    for (const auto& [name, origin] : origins_) sum += origin.start;
    return sum;
}

} // namespace osculate::deck
