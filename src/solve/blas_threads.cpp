#include "solve/blas_threads.hpp"

#include <cstdlib>
#include <cstring>
#include <dlfcn.h>

namespace osculate::solve {

namespace {

/// Tells a library by the name of its function, where there: it read its variable when it was loaded, before main. Not where
/// that variable asks for more than one thread.
bool tell(const char* variable, const char* function, int value) {
    const char* asked = std::getenv(variable);
    if (asked != nullptr && *asked != '\0' && std::strcmp(asked, "1") != 0) return false;
    void* symbol = dlsym(RTLD_DEFAULT, function);
    if (symbol != nullptr) reinterpret_cast<void (*)(int)>(symbol)(value);
    return symbol != nullptr;
}

} // namespace

void use_one_blas_thread() {
    // CHOLMOD asks OpenMP for four threads whatever the number set: only a limit of nested regions stops it
    static const bool once = tell("OPENBLAS_NUM_THREADS", "openblas_set_num_threads", 1) |
                             tell("OMP_NUM_THREADS", "omp_set_num_threads", 1) |
                             tell("OMP_NUM_THREADS", "omp_set_max_active_levels", 0);
    (void)once;
}

} // namespace osculate::solve
