#pragma once
/// Threads of the BLAS under the factorisations.

namespace osculate::solve {

/// Confines BLAS to one thread, once: the sum's order, and so every bit of a result, must not depend on the machine, and
/// idle BLAS threads that spin have been seen to slow a shared machine thirty-fold.
void use_one_blas_thread();

} // namespace osculate::solve
