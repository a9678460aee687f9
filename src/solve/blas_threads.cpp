#include "solve/blas_threads.hpp"

// Present only where libblas is OpenBLAS; reference BLAS has no threads.
extern "C" void openblas_set_num_threads(int threads) __attribute__((weak));

namespace osculate::solve {

void use_one_blas_thread() {
    static const bool done = [] {
        if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
        return true;
    }();
    (void)done;
}

} // namespace osculate::solve
