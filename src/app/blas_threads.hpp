#pragma once

namespace osculate::app {

/// Keeps BLAS and OpenMP to one thread unless OPENBLAS_NUM_THREADS or OMP_NUM_THREADS says otherwise: the sparse solvers
/// call small dense kernels, where threads cost more than they give.
void limit_blas_threads();

} // namespace osculate::app
