#pragma once
/// Vectors of which each process has a slice.

#include "osculate/core/ranks.hpp"

#include <sundials/sundials_context.hpp>
#include <sundials/sundials_nvector.h>

namespace osculate::solve {

/// One's own slice of a vector, a serial vector to SUNDIALS but for its products, which are of whole vectors, with the same bits on
/// all processes. Clones are alike. Sums of several vectors and several products at a time are one operation.
/// @param ranks  must outlive the vector and its clones
[[nodiscard]] N_Vector make_sliced(Index length, Ranks& ranks, SUNContext context);

} // namespace osculate::solve
