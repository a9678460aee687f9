#include "solve/krylov.hpp"

#include "osculate/core/error.hpp"

#include <sunlinsol/sunlinsol_spgmr.h>

namespace osculate::solve {

Krylov::Krylov(N_Vector like, SUNContext context) {
    linear_ = SUNLinSol_SPGMR(like, SUN_PREC_RIGHT, most_iterations, context);
    require(linear_ != nullptr, "SPGMR could not be created");
    SUNLinSolSetATimes(linear_, this, [](void* self, N_Vector v, N_Vector z) {
        static_cast<Krylov*>(self)->A_->multiply(N_VGetArrayPointer(v), N_VGetArrayPointer(z));
        return 0;
    });
    SUNLinSolSetPreconditioner(linear_, this, nullptr, [](void* self, N_Vector r, N_Vector z, realtype, int) {
        static_cast<Krylov*>(self)->M_->precondition(N_VGetArrayPointer(r), N_VGetArrayPointer(z));
        return 0;
    });
    SUNLinSol_SPGMRSetMaxRestarts(linear_, 0);
    require(SUNLinSolInitialize(linear_) == SUNLS_SUCCESS, "SPGMR could not be initialised");
}

Krylov::~Krylov() {
    SUNLinSolFree(linear_);
}

Krylov::Result Krylov::solve(const SparseMatrix& A, Preconditioner& M, N_Vector b, N_Vector x, double tolerance) {
    A_ = &A;
    M_ = &M;
    N_VConst(0, x);
    SUNLinSolSetZeroGuess(linear_, SUNTRUE);
    const int flag = SUNLinSolSetup(linear_, nullptr) == SUNLS_SUCCESS
                         ? SUNLinSolSolve(linear_, nullptr, x, b, tolerance)
                         : SUNLS_PACKAGE_FAIL_UNREC;
    return {flag == SUNLS_SUCCESS, SUNLinSolNumIters(linear_)};
}

} // namespace osculate::solve
