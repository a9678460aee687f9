#include "osculate/solve/gmres.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/slices.hpp"
#include "solve/gmres_vector.hpp"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.hpp>
#include <sunlinsol/sunlinsol_spgmr.h>

namespace osculate::solve {

namespace {
constexpr int success = 0, no_success = -1; // names differ between SUNDIALS 6 and 7
}

struct Gmres::Impl {
    Impl(Index n, Slices* shared, int threads) : size(n), slices(shared) {
        Ranks* const ranks = slices != nullptr ? &slices->ranks() : nullptr;
        const Index length = slices != nullptr ? static_cast<Index>(slices->own().size()) : size;
        x = make_gmres_vector(length, ranks, threads, context);
        b = make_gmres_vector(length, ranks, threads, context);
        linear = SUNLinSol_SPGMR(x, SUN_PREC_NONE, most_iterations, context);
        require(linear != nullptr, "SPGMR could not be created");
        SUNLinSolSetATimes(linear, this, [](void* self, N_Vector v, N_Vector z) {
            auto& s = *static_cast<Impl*>(self);
            s.apply(*s.A, &Slices::fill_unknowns, v, z);
            return 0;
        });
        SUNLinSolSetPreconditioner(linear, this, nullptr, [](void* self, N_Vector r, N_Vector z, sunrealtype, int) {
            auto& s = *static_cast<Impl*>(self);
            s.apply(*s.M, &Slices::fill_rows, r, z);
            return 0;
        });
        SUNLinSol_SPGMRSetMaxRestarts(linear, 0);
        // one message an iteration, or two, instead of one for every direction before
        if (slices != nullptr) SUNLinSol_SPGMRSetGSType(linear, SUN_CLASSICAL_GS);
        require(SUNLinSolInitialize(linear) == success, "SPGMR could not be initialised");
    }
    ~Impl() {
        SUNLinSolFree(linear);
        N_VDestroy(x);
        N_VDestroy(b);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void apply(const LinearMap& map, void (Slices::*fill)(double*), N_Vector from, N_Vector to) {
        if (slices == nullptr) {
            map(N_VGetArrayPointer(from), N_VGetArrayPointer(to));
            return;
        }
        const std::vector<Index>& own = slices->own();
        const double* in = N_VGetArrayPointer(from);
        double* out = N_VGetArrayPointer(to);
        for (std::size_t k = 0; k < own.size(); ++k) whole_in[own[k]] = in[k];
        (slices->*fill)(whole_in);
        map(whole_in, whole_out);
        for (std::size_t k = 0; k < own.size(); ++k) out[k] = whole_out[own[k]];
    }

    sundials::Context context;
    Index size;
    Slices* slices;
    double *whole_in = nullptr, *whole_out = nullptr; ///< (size) what maps act on, where there are slices
    N_Vector b = nullptr, x = nullptr;
    SUNLinearSolver linear = nullptr;
    const LinearMap *A = nullptr, *M = nullptr;
};

Gmres::Gmres(Index size, Slices* slices, int threads) : impl_(std::make_unique<Impl>(size, slices, threads)) {}
Gmres::~Gmres() = default;

void Gmres::lend(double* in, double* out) {
    impl_->whole_in = in;
    impl_->whole_out = out;
}

Gmres::Result Gmres::solve(const LinearMap& A, const LinearMap& M, const double* b, double* x, double tolerance) {
    Impl& s = *impl_;
    require(s.slices == nullptr || (s.whole_in != nullptr && s.whole_out != nullptr), "Gmres: no whole vectors");
    s.A = &A;
    s.M = &M;
    N_VSetArrayPointer(const_cast<double*>(b), s.b);
    N_VSetArrayPointer(x, s.x);
    N_VConst(0, s.x);
    SUNLinSol_SPGMRSetPrecType(s.linear, M ? SUN_PREC_RIGHT : SUN_PREC_NONE);
    SUNLinSolSetZeroGuess(s.linear, SUNTRUE);
    const int flag = SUNLinSolSetup(s.linear, nullptr) == success
                         ? SUNLinSolSolve(s.linear, nullptr, s.x, s.b, tolerance)
                         : no_success;
    return {flag == success, SUNLinSolNumIters(s.linear)};
}

} // namespace osculate::solve
