#pragma once
/// Orthonormal frames of supports. Every function returns its own results unchanged when given them again, so that a
/// scene written and read back is the same to the last bit.

#include "osculate/core/types.hpp"

#include <optional>

namespace osculate::scene {

/// Right-handed frame: column 0 along `a`, column 1 the part of `b` normal to it. Nothing when they are parallel.
/// @pre  a and b are finite and not zero
[[nodiscard]] std::optional<Mat3> frame_of(const Vec3& a, const Vec3& b);

/// Right-handed frame with column 0 along `normal`.
/// @pre  normal is finite and not zero
[[nodiscard]] Mat3 frame_about(const Vec3& normal);

} // namespace osculate::scene
