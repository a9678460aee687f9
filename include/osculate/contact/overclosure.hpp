#pragma once
/// Interfaces that give way: contact pressure over overclosure.

#include "osculate/core/types.hpp"

#include <array>
#include <vector>

namespace osculate::contact {

/// Pressure p, Pa, over the overclosure h = -g, m: none up to a first overclosure, strictly growing from there on.
class Overclosure {
public:
    /// p = k h.  @param k  Pa/m, > 0
    [[nodiscard]] static Overclosure linear(double k);
    /// p = p0 exp(ln(100) h / c0): p0 where the surfaces touch, a hundredth of it at the clearance c0 (CalculiX). The tangent
    /// there goes on to no pressure, at c0 (1 + 1/ln 100): a jump would have no equilibrium.
    /// @param p0  Pa, > 0  @param c0  m, > 0
    [[nodiscard]] static Overclosure exponential(double p0, double c0);
    /// Straight between rows and beyond the last two.
    /// @param rows  overclosure and pressure, both ascending, two or more, the first without pressure
    [[nodiscard]] static Overclosure table(std::vector<std::array<double, 2>> rows);

    /// The inverse law at a pressure; below zero its first tangent goes on.
    struct Point {
        double overclosure = 0; ///< h, m
        double compliance = 0;  ///< dh/dp, m/Pa, > 0
    };
    [[nodiscard]] Point at(double pressure) const;
    /// p(h), Pa, >= 0.
    [[nodiscard]] double pressure(double overclosure) const;
    /// Integral of p up to an overclosure, J/m^2: work of a unit of area.
    [[nodiscard]] double energy(double overclosure) const;
    /// Mean pressure of a step, Pa, and its derivative by the overclosure at the end, Pa/m: times the change of the overclosure it
    /// is that of the energy.
    struct Mean {
        double pressure = 0, slope = 0;
    };
    [[nodiscard]] Mean mean(double start, double end) const;
    /// Where pressure begins, m: < 0 for a law that acts before surfaces touch.
    [[nodiscard]] double first() const { return rows_.front()[0]; }

    bool operator==(const Overclosure&) const = default;

private:
    explicit Overclosure(std::vector<std::array<double, 2>> rows, double growth = 0)
        : rows_(std::move(rows)), growth_(growth) {}
    /// The piece that begins with row i, and slopes of pressure there, Pa/m.
    [[nodiscard]] double slope(std::size_t i) const {
        return (rows_[i + 1][1] - rows_[i][1]) / (rows_[i + 1][0] - rows_[i][0]);
    }

    std::vector<std::array<double, 2>> rows_; ///< h, p
    double growth_;                           ///< of an exponential beyond the last row, 1/m; 0: straight
};

} // namespace osculate::contact
