#pragma once

namespace osculate::mesh {

/// Meshed portion of a round body: all of it | x >= 0 | x >= 0 and y >= 0. Every cut makes a surface: x_min in the
/// plane x = 0, y_min in y = 0.
enum class Portion { full, half, quarter };

} // namespace osculate::mesh
