#include "multigrid/petsc_check.hpp"

#include <cstdlib>

namespace osculate::solve {

void begin_petsc() {
    static const bool begun = [] {
        setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);                 // one process: no daemon beside it
        for (const char* option : {"-no_signal_handler", "-skip_petscrc"}) // no file of the user's changes a result
            check(PetscOptionsSetValue(nullptr, option, nullptr));
        check(PetscOptionsSetValue(nullptr, "-options_left",
                                   "no")); // later versions say at the end that they ignored one
        check(PetscInitializeNoArguments());
        check(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr)); // codes are checked, and tell enough
        return true;
    }();
    (void)begun;
}

} // namespace osculate::solve
