#include "osculate/contact/overclosure.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::contact {

Overclosure Overclosure::linear(double k) {
    return Overclosure({{0, 0}, {1, k}});
}

Overclosure Overclosure::exponential(double p0, double c0) {
    const double part = 0.01, growth = -std::log(part) / c0;
    return Overclosure({{-c0 - 1 / growth, 0}, {-c0, part * p0}}, growth);
}

Overclosure Overclosure::table(std::vector<std::array<double, 2>> rows) {
    return Overclosure(std::move(rows));
}

Overclosure::Point Overclosure::at(double pressure) const {
    const auto& [h, p] = rows_.back();
    if (growth_ > 0 && pressure > p) return {h + std::log(pressure / p) / growth_, 1 / (growth_ * pressure)};
    std::size_t i = 0;
    while (i + 2 < rows_.size() && pressure > rows_[i + 1][1]) ++i;
    return {rows_[i][0] + (pressure - rows_[i][1]) / slope(i), 1 / slope(i)};
}

double Overclosure::pressure(double overclosure) const {
    if (overclosure <= first()) return 0;
    const auto& [h, p] = rows_.back();
    if (growth_ > 0 && overclosure > h) return p * std::exp(growth_ * (overclosure - h));
    std::size_t i = 0;
    while (i + 2 < rows_.size() && overclosure > rows_[i + 1][0]) ++i;
    return rows_[i][1] + slope(i) * (overclosure - rows_[i][0]);
}

double Overclosure::energy(double overclosure) const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < rows_.size() && overclosure > rows_[i][0]; ++i) {
        const bool straight_on = i + 2 == rows_.size() && growth_ == 0;
        const double end = straight_on ? overclosure : std::min(overclosure, rows_[i + 1][0]);
        sum += 0.5 * (rows_[i][1] + pressure(end)) * (end - rows_[i][0]);
    }
    const auto& [h, p] = rows_.back();
    if (growth_ > 0 && overclosure > h) sum += p * std::expm1(growth_ * (overclosure - h)) / growth_;
    return sum;
}

Overclosure::Mean Overclosure::mean(double start, double end) const {
    const double scale = std::max(std::abs(start - first()), std::abs(end - first())), change = end - start;
    constexpr double alike = 1e-5; // the difference of energies has lost as many digits, the middle is as good: 1e-10
    if (std::abs(change) <= alike * scale) {
        const double middle = 0.5 * (start + end);
        const double p = pressure(middle);
        return {p, middle > first() ? 0.5 / at(p).compliance : 0};
    }
    const double mean = (energy(end) - energy(start)) / change;
    return {mean, (pressure(end) - mean) / change};
}

} // namespace osculate::contact
