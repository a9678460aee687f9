#pragma once
/// Threads of VTK.

namespace osculate::mesh {

/// Confines VTK to the thread that calls it, once: a run has the threads it was asked for, and no others.
void use_no_vtk_threads();

} // namespace osculate::mesh
