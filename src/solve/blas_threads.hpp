#pragma once
/// Threads of the BLAS under the factorisations.

namespace osculate::solve {

/// Confines BLAS and OpenMP to one thread, once, unless OPENBLAS_NUM_THREADS or OMP_NUM_THREADS asks for more: no bit of a
/// result may depend on the machine, and idle BLAS threads that spin have been seen to slow a shared machine thirty-fold.
/// Chooses the kernels of OpenBLAS too: whatever calls BLAS calls this first, as no result may depend on what was solved before.
void use_one_blas_thread();

} // namespace osculate::solve
