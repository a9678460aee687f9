#pragma once
/// Number of threads that VTK uses.

namespace osculate::mesh {

/// Confines VTK to the calling thread, once per process: a run has only the threads that the user asked for.
void use_no_vtk_threads();

} // namespace osculate::mesh
