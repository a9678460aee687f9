#include "osculate/solve/gmres.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/ranks.hpp"
#include "solve/gmres_vector.hpp"

#include <algorithm>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.hpp>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <vector>

namespace osculate::solve {

namespace {
constexpr int success = 0, no_success = -1; // names differ between SUNDIALS 6 and 7
}

struct Gmres::Impl {
    Impl(Index n, Ranks* together, int threads) : size(n), ranks(together) {
        if (ranks != nullptr) {
            for (int k = 0; k < ranks->count(); ++k) lengths.push_back(begin_of(k + 1) - begin_of(k));
            begin = begin_of(ranks->rank());
            length = lengths[static_cast<std::size_t>(ranks->rank())];
            whole_in.resize(static_cast<std::size_t>(size));
            whole_out.resize(static_cast<std::size_t>(size));
        }
        x = make_gmres_vector(ranks != nullptr ? length : size, ranks, threads, context);
        b = make_gmres_vector(ranks != nullptr ? length : size, ranks, threads, context);
        linear = SUNLinSol_SPGMR(x, SUN_PREC_NONE, most_iterations, context);
        require(linear != nullptr, "SPGMR could not be created");
        SUNLinSolSetATimes(linear, this, [](void* self, N_Vector v, N_Vector z) {
            auto& s = *static_cast<Impl*>(self);
            s.apply(*s.A, v, z);
            return 0;
        });
        SUNLinSolSetPreconditioner(linear, this, nullptr, [](void* self, N_Vector r, N_Vector z, sunrealtype, int) {
            auto& s = *static_cast<Impl*>(self);
            s.apply(*s.M, r, z);
            return 0;
        });
        SUNLinSol_SPGMRSetMaxRestarts(linear, 0);
        // one message an iteration, or two, instead of one for every direction before
        if (ranks != nullptr) SUNLinSol_SPGMRSetGSType(linear, SUN_CLASSICAL_GS);
        require(SUNLinSolInitialize(linear) == success, "SPGMR could not be initialised");
    }
    ~Impl() {
        SUNLinSolFree(linear);
        N_VDestroy(x);
        N_VDestroy(b);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    [[nodiscard]] int begin_of(int rank) const {
        return static_cast<int>(static_cast<std::int64_t>(size) * rank / ranks->count());
    }
    /// Maps act on whole vectors, of which each process has the results' own slice.
    void apply(const LinearMap& map, N_Vector from, N_Vector to) {
        if (ranks == nullptr) {
            map(N_VGetArrayPointer(from), N_VGetArrayPointer(to));
            return;
        }
        gather(from, whole_in.data());
        map(whole_in.data(), whole_out.data());
        std::copy_n(whole_out.data() + begin, length, N_VGetArrayPointer(to));
    }
    void gather(N_Vector from, double* to) const {
        ranks->gather({N_VGetArrayPointer(from), static_cast<std::size_t>(length)}, lengths, to);
    }

    sundials::Context context;
    Index size;
    Ranks* ranks;
    int begin = 0, length = 0; ///< of one's own slice
    std::vector<int> lengths;  ///< of each rank's
    std::vector<double> whole_in, whole_out;
    N_Vector b = nullptr, x = nullptr;
    SUNLinearSolver linear = nullptr;
    const LinearMap *A = nullptr, *M = nullptr;
};

Gmres::Gmres(Index size, Ranks* ranks, int threads) : impl_(std::make_unique<Impl>(size, ranks, threads)) {}
Gmres::~Gmres() = default;

Gmres::Result Gmres::solve(const LinearMap& A, const LinearMap& M, const double* b, double* x, double tolerance) {
    Impl& s = *impl_;
    s.A = &A;
    s.M = &M;
    if (s.ranks != nullptr) {
        std::copy_n(b + s.begin, s.length, N_VGetArrayPointer(s.b));
    } else {
        N_VSetArrayPointer(const_cast<double*>(b), s.b);
        N_VSetArrayPointer(x, s.x);
    }
    N_VConst(0, s.x);
    SUNLinSol_SPGMRSetPrecType(s.linear, M ? SUN_PREC_RIGHT : SUN_PREC_NONE);
    SUNLinSolSetZeroGuess(s.linear, SUNTRUE);
    const int flag = SUNLinSolSetup(s.linear, nullptr) == success
                         ? SUNLinSolSolve(s.linear, nullptr, s.x, s.b, tolerance)
                         : no_success;
    if (s.ranks != nullptr) s.gather(s.x, x);
    return {flag == success, SUNLinSolNumIters(s.linear)};
}

} // namespace osculate::solve
