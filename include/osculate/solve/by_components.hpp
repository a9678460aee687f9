#pragma once
/// Factorisation of a matrix that falls into parts.

#include "osculate/solve/direct_solver.hpp"

#include <functional>

namespace osculate::solve {

/// A solver of its own, by `make`, for each connected component of the matrix. Several right sides together cost what those
/// components cost that they load.
[[nodiscard]] std::unique_ptr<DirectSolver> make_by_components(std::function<std::unique_ptr<DirectSolver>()> make);

} // namespace osculate::solve
