#pragma once
/// Directions of GMRES as vectors of SUNDIALS.

#include "osculate/core/types.hpp"

#include <sundials/sundials_nvector.h>

namespace osculate {
class Ranks;
}

namespace osculate::solve {

/// A serial vector that is added to and multiplied on several threads, with the same bits for any number. Its copies are like it.
/// @param ranks  where not null, the vector is a process's slice of a longer one, and dot products are sums over all;
///               where null, it has no memory of its own, but its copies have
[[nodiscard]] N_Vector make_gmres_vector(Index length, Ranks* ranks, int threads, SUNContext context);

} // namespace osculate::solve
