#pragma once
/// Directions of GMRES, and slices for KINSOL, as vectors of SUNDIALS.

#include "osculate/core/types.hpp"

#include <sundials/sundials_nvector.h>

namespace osculate {
class Ranks;
}

namespace osculate::solve {

/// A serial vector that is added to and multiplied on several threads, with the same bits for any number. Its copies are like it, but
/// have memory of their own.
/// @param ranks  where not null, the vector is a process's slice of a longer one, and dot products, norms and extremes are of all
[[nodiscard]] N_Vector make_gmres_vector(Index length, Ranks* ranks, int threads, SUNContext context);

} // namespace osculate::solve
