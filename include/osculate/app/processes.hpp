#pragma once
/// What processes that share a run hold.

#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"

namespace osculate::app {

/// Estimated peak memory of processes that share a run, in bytes.
struct ProcessMemory {
    double everywhere = 0; ///< program, MPI, mesh, surfaces and contact
    double shared = 0;     ///< matrices, grids of multigrid, vectors of KINSOL and GMRES
    /// Of what is everywhere, what processes of one machine keep once: see Replicas; and program and libraries.
    double once = 0;
    double first = 0; ///< what the first process needs besides, to share out the nodes and to write

    /// Of one of n processes, and of the first of them.
    [[nodiscard]] double of_one(int n) const { return everywhere + shared / n; }
    [[nodiscard]] double of_first(int n) const { return of_one(n) + (n > 1 ? first : 0); }
    /// Of n processes on one machine.
    [[nodiscard]] double of_all(int n) const { return n * (everywhere - once) + once + shared + (n > 1 ? first : 0); }
};

/// Fitted to docs/data/distributed.md, as correct as Estimate.
[[nodiscard]] ProcessMemory process_memory(const Plan& plan);

/// Why processes cannot share the run of a model; empty: they can.
[[nodiscard]] std::vector<Fault> cannot_be_shared(const model::Model& model);

/// Some lines: what processes share, what each has, and how much memory they take.
/// @throws SceneError where they cannot share it
[[nodiscard]] std::string processes_in_words(const Plan& plan, int processes);

} // namespace osculate::app
