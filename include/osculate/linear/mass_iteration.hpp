#pragma once
/// M a = f without factors of M.

#include "osculate/linear/block_matrix.hpp"
#include "osculate/linear/constraints.hpp"

#include <optional>

namespace osculate::linear {

/// Accelerations under forces, by conjugate gradients with the diagonal of M: over the diagonal the eigenvalues of a mass matrix lie
/// between bounds that depend on the types of elements alone (Wathen, IMA J. Numer. Anal. 7, 1987), whatever the mesh.
/// @param f  (equations) force along the free components, N; passed over where there is no mass
/// @return   (equations) m/s^2, with a residual of 1e-14 of f; nothing where M is not positive definite
[[nodiscard]] std::optional<Vector> iterate_by_mass(const BlockMatrix& M, const Constraints& constraints,
                                                    const Vector& f, int threads);

} // namespace osculate::linear
