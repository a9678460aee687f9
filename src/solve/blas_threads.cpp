#include "solve/blas_threads.hpp"

#include <cstdlib>
#include <dlfcn.h>

namespace osculate::solve {

namespace {

/// The libraries read their variables when they are loaded, which is before main; so they are told by name, where there.
bool limit(const char* variable, const char* function) {
    if (std::getenv(variable) != nullptr) return false;
    void* symbol = dlsym(RTLD_DEFAULT, function);
    if (symbol != nullptr) reinterpret_cast<void (*)(int)>(symbol)(1);
    return symbol != nullptr;
}

} // namespace

void use_one_blas_thread() {
    static const bool once =
        limit("OPENBLAS_NUM_THREADS", "openblas_set_num_threads") | limit("OMP_NUM_THREADS", "omp_set_num_threads");
    (void)once;
}

} // namespace osculate::solve
