#pragma once

namespace osculate::mesh {

/// What of a round body is meshed: all of it | x >= 0 | x >= 0 and y >= 0. A surface stands where it is cut: x_min in the
/// plane x = 0, y_min in y = 0.
enum class Portion { full, half, quarter };

} // namespace osculate::mesh
