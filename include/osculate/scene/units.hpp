#pragma once
/// Quantities with units: "30 MPa", "0.25 m", "2 kN/m^3".

#include <string>
#include <string_view>

namespace osculate::scene {

/// Exponents of the base units m, kg, s, rad and K. The angle is a separate dimension, so that an angle is not accepted as
/// a number.
struct Dimension {
    int length = 0, mass = 0, time = 0, angle = 0, temperature = 0;
    bool operator==(const Dimension&) const = default;
};

namespace dimension {
inline constexpr Dimension none{};
inline constexpr Dimension length{1, 0, 0, 0};
inline constexpr Dimension time{0, 0, 1, 0};
inline constexpr Dimension angle{0, 0, 0, 1};
inline constexpr Dimension force{1, 1, -2, 0};
inline constexpr Dimension pressure{-1, 1, -2, 0};
inline constexpr Dimension density{-3, 1, 0, 0};
inline constexpr Dimension velocity{1, 0, -1, 0};
inline constexpr Dimension spin{0, 0, -1, 1};
inline constexpr Dimension rate{0, 0, -1, 0};
inline constexpr Dimension acceleration{1, 0, -2, 0};
inline constexpr Dimension force_per_volume{-2, 1, -2, 0};
inline constexpr Dimension pressure_per_velocity{-2, 1, -1, 0};
inline constexpr Dimension mass{0, 1, 0, 0};
inline constexpr Dimension inertia{2, 1, 0, 0};
inline constexpr Dimension moment{2, 1, -2, 0};
inline constexpr Dimension temperature{0, 0, 0, 0, 1}; ///< a difference
inline constexpr Dimension expansion{0, 0, 0, 0, -1};
} // namespace dimension

/// "pressure", "force per volume"; the SI unit if the dimension has no name, "number" if it has no unit.
[[nodiscard]] std::string name_of(Dimension dimension);

/// SI unit: "Pa", "N/m^3"; empty for a plain number.
[[nodiscard]] std::string unit_of(Dimension dimension);

struct Quantity {
    double value = 0; ///< SI; may be infinite or NaN, as written
    Dimension dimension;
    bool has_unit = false;
    std::string problem; ///< why the text is no quantity; empty if it is one
    std::string nearest; ///< the known unit nearest to an unknown one
};

/// A number, or a number and a unit: products and quotients (left to right) of m, g, s, N, Pa, J, W, Hz, rad with SI
/// prefixes, and t, bar, min, h, deg, K, also as 1/K, each with an integer power.
[[nodiscard]] Quantity parse_quantity(std::string_view text);

/// The shortest decimal that reads back as the same double.
[[nodiscard]] std::string number_text(double value);

} // namespace osculate::scene
