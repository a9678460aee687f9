#include "app/blas_threads.hpp"

#include <cstdlib>
#include <dlfcn.h>

namespace osculate::app {

namespace {

/// The libraries read their variables when they are loaded, which is before main; so they are told by name, where there.
void limit(const char* variable, const char* function) {
    if (std::getenv(variable) != nullptr) return;
    setenv(variable, "1", 1); // for programs started from here
    if (void* symbol = dlsym(RTLD_DEFAULT, function)) reinterpret_cast<void (*)(int)>(symbol)(1);
}

} // namespace

void limit_blas_threads() {
    limit("OPENBLAS_NUM_THREADS", "openblas_set_num_threads");
    limit("OMP_NUM_THREADS", "omp_set_num_threads");
}

} // namespace osculate::app
