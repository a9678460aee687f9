#pragma once
/// Where an instance of a part stands.

#include "mesh/deck/faults.hpp"
#include "osculate/core/types.hpp"
#include "osculate/mesh/deck.hpp"

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <string_view>

namespace osculate::mesh {

/// The motion of an instance: a translation, then a rotation about a line that stands still.
/// @param card  *INSTANCE: x, y, z of the translation; below it two points of the axis and an angle in degrees
[[nodiscard]] Eigen::Isometry3d placement_of(const Deck& deck, const DeckCard& card, DeckFaults& faults);

/// Reads so many coordinates, those that are missing or empty as 0; false where one is no number.
[[nodiscard]] bool read_vector(std::span<const std::string_view> fields, Vec3& x);
/// Coordinates of a data line, exactly.
[[nodiscard]] std::string written(const Vec3& x);

} // namespace osculate::mesh
