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

/// OpenBLAS knows processors by their models, and takes for one of 2004 what came out after it did: several times slower
/// than what the processor's own flags allow. So told, it chooses again.
void use_vector_units() {
#if defined(__x86_64__) && defined(__GNUC__)
    using Name = char* (*)();
    using Function = void (*)();
    constexpr const char* variable = "OPENBLAS_CORETYPE";
    const auto name = reinterpret_cast<Name>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
    const auto quit = reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, "gotoblas_dynamic_quit"));
    const auto choose = reinterpret_cast<Function>(dlsym(RTLD_DEFAULT, "gotoblas_dynamic_init"));
    if (name == nullptr || quit == nullptr || choose == nullptr || std::getenv(variable) != nullptr) return;
    if (std::strcmp(name(), "Prescott") != 0 || !__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
        return;
    const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
    setenv(variable, wide ? "SKYLAKEX" : "HASWELL", 1);
    quit();
    choose();
    unsetenv(variable);
#endif
}

} // namespace

void use_one_blas_thread() {
    // CHOLMOD asks OpenMP for four threads whatever the number set: only a limit of nested regions stops it
    static const bool once = tell("OPENBLAS_NUM_THREADS", "openblas_set_num_threads", 1) |
                             tell("OMP_NUM_THREADS", "omp_set_num_threads", 1) |
                             tell("OMP_NUM_THREADS", "omp_set_max_active_levels", 0);
    static const bool chosen = (use_vector_units(), true);
    (void)once, (void)chosen;
}

} // namespace osculate::solve
