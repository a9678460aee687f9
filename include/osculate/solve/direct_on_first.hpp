#pragma once
/// Factorisation by one of several processes.

#include "osculate/solve/direct_solver.hpp"

namespace osculate {
class Ranks;
}

namespace osculate::solve {

/// Nodes of a model whose factors one process has room for, some 7 GB of them with LU.
inline constexpr Index most_nodes_on_first = 100000;

/// The first process factorises and solves with `solver`, all get what it finds, bit for bit: a factorisation, which may take
/// gigabytes, is held once. Calls are collective, with the same matrix on all processes.
/// @param ranks  must outlive the result
[[nodiscard]] std::unique_ptr<DirectSolver> make_direct_on_first(std::unique_ptr<DirectSolver> solver, Ranks& ranks);

} // namespace osculate::solve
