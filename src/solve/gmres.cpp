#include "osculate/solve/gmres.hpp"

#include "osculate/core/error.hpp"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.hpp>
#include <sunlinsol/sunlinsol_spgmr.h>

namespace osculate::solve {

struct Gmres::Impl {
    explicit Impl(Index size) : b(N_VMake_Serial(size, nullptr, context)), x(N_VMake_Serial(size, nullptr, context)) {
        linear = SUNLinSol_SPGMR(x, SUN_PREC_NONE, most_iterations, context);
        require(linear != nullptr, "SPGMR could not be created");
        SUNLinSolSetATimes(linear, this, [](void* self, N_Vector v, N_Vector z) {
            (*static_cast<Impl*>(self)->A)(N_VGetArrayPointer(v), N_VGetArrayPointer(z));
            return 0;
        });
        SUNLinSolSetPreconditioner(linear, this, nullptr, [](void* self, N_Vector r, N_Vector z, realtype, int) {
            (*static_cast<Impl*>(self)->M)(N_VGetArrayPointer(r), N_VGetArrayPointer(z));
            return 0;
        });
        SUNLinSol_SPGMRSetMaxRestarts(linear, 0);
        require(SUNLinSolInitialize(linear) == SUNLS_SUCCESS, "SPGMR could not be initialised");
    }
    ~Impl() {
        SUNLinSolFree(linear);
        N_VDestroy(x);
        N_VDestroy(b);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    sundials::Context context;
    N_Vector b, x;
    SUNLinearSolver linear = nullptr;
    const LinearMap *A = nullptr, *M = nullptr;
};

Gmres::Gmres(Index size) : impl_(std::make_unique<Impl>(size)) {}
Gmres::~Gmres() = default;

Gmres::Result Gmres::solve(const LinearMap& A, const LinearMap& M, const double* b, double* x, double tolerance) {
    Impl& s = *impl_;
    s.A = &A;
    s.M = &M;
    N_VSetArrayPointer(const_cast<double*>(b), s.b);
    N_VSetArrayPointer(x, s.x);
    N_VConst(0, s.x);
    SUNLinSol_SPGMRSetPrecType(s.linear, M ? SUN_PREC_RIGHT : SUN_PREC_NONE);
    SUNLinSolSetZeroGuess(s.linear, SUNTRUE);
    const int flag = SUNLinSolSetup(s.linear, nullptr) == SUNLS_SUCCESS
                         ? SUNLinSolSolve(s.linear, nullptr, s.x, s.b, tolerance)
                         : SUNLS_PACKAGE_FAIL_UNREC;
    return {flag == SUNLS_SUCCESS, SUNLinSolNumIters(s.linear)};
}

} // namespace osculate::solve
