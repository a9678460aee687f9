#include "osculate/solve/multigrid.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/ranks.hpp"
#include "osculate/solve/join_ranks.hpp"
#include "solve/blas_threads.hpp"

#include <dlfcn.h>
#include <string>

namespace osculate::solve {
namespace {

/// A function of the module that holds PETSc. @throws RunFailure where that cannot be loaded
template <class Function> Function of_module(const char* name, const char* what, const char* instead) {
    void* module = dlopen("libosculate_multigrid.so", RTLD_NOW | RTLD_LOCAL); // never closed: PETSc lives on
    void* symbol = module == nullptr ? nullptr : dlsym(module, name);
    if (symbol == nullptr) {
        const char* reason = dlerror();
        throw RunFailure(std::string(what) + " cannot be loaded: " + (reason != nullptr ? reason : "unknown") + "; " +
                         instead);
    }
    return reinterpret_cast<Function>(symbol);
}

} // namespace

std::unique_ptr<Multigrid> make_multigrid(NodalUnknowns unknowns, int threads) {
    use_one_blas_thread(); // of the program's BLAS, which is PETSc's: sums by other kernels have other last digits
    using Make = Multigrid* (*)(NodalUnknowns*, int);
    static const auto make =
        of_module<Make>("osculate_make_multigrid", "multigrid", "solver.linear_solver: iterative does not need it");
    return std::unique_ptr<Multigrid>(make(&unknowns, threads));
}

std::shared_ptr<Ranks> join_ranks() {
    using Join = Ranks* (*)();
    return std::shared_ptr<Ranks>(
        of_module<Join>("osculate_join_ranks", "MPI", "a run without --distributed does not need it")());
}

} // namespace osculate::solve
