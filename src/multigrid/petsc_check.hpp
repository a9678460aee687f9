#pragma once
/// PETSc's beginning, and its codes as failures of a run.

#include "osculate/core/error.hpp"

#include <petscsys.h>
#include <string>

namespace osculate::solve {

/// Begins PETSc and MPI, once.
void begin_petsc();

inline void check(PetscErrorCode code) {
    if (code == 0) return;
    const char* text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw RunFailure(std::string("PETSc: ") + (text != nullptr ? text : "unknown error"));
}

} // namespace osculate::solve
