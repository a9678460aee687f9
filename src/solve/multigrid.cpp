#include "osculate/solve/multigrid.hpp"

#include "osculate/core/error.hpp"

#include <dlfcn.h>
#include <string>

namespace osculate::solve {

std::unique_ptr<Multigrid> make_multigrid(NodalUnknowns unknowns) {
    using Make = Multigrid* (*)(NodalUnknowns*);
    static const Make make = [] {
        void* module = dlopen("libosculate_multigrid.so", RTLD_NOW | RTLD_LOCAL); // never closed: PETSc lives on
        void* symbol = module == nullptr ? nullptr : dlsym(module, "osculate_make_multigrid");
        if (symbol == nullptr) {
            const char* reason = dlerror();
            throw RunFailure("multigrid cannot be loaded: " + std::string(reason != nullptr ? reason : "unknown") +
                             "; solver.linear_solver: iterative does not need it");
        }
        return reinterpret_cast<Make>(symbol);
    }();
    return std::unique_ptr<Multigrid>(make(&unknowns));
}

} // namespace osculate::solve
