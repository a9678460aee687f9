#pragma once
/// Accelerations at the start of a motion.

#include "osculate/linear/constraints.hpp"
#include "osculate/time/stage.hpp"
#include "time/run_context.hpp"

namespace osculate::time {

/// How M a = f is solved: with factors, or without them where the model is too large for any.
enum class MassSolution { by_factors, by_conjugate_gradients };

/// M a = f - K u - C v + contact forces of the state, a = 0 along held directions.
/// @param force  f, N
/// @throws RunFailure where the mass matrix is not positive definite
[[nodiscard]] Field initial_acceleration(RunContext& context, const Stage& stage,
                                         const linear::Constraints& constraints, const model::State& state,
                                         const Field& force, MassSolution how);

} // namespace osculate::time
