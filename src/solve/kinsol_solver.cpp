#include "osculate/solve/kinsol_solver.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/timing.hpp"
#include "osculate/solve/direct_on_first.hpp"
#include "solve/kinsol_vectors.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <kinsol/kinsol.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.hpp>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>

namespace osculate::solve {

std::string describe(KinsolOutcome outcome) {
    switch (outcome) {
    case KinsolOutcome::converged: return "converged";
    case KinsolOutcome::max_iterations: return "iterations exhausted";
    case KinsolOutcome::stopped: return "stopped before convergence";
    case KinsolOutcome::singular: return "singular tangent";
    case KinsolOutcome::unsolved: return "linear system not solved";
    case KinsolOutcome::no_descent: return "no descent along the Newton direction";
    case KinsolOutcome::not_evaluable: return "residual cannot be evaluated along the step";
    case KinsolOutcome::not_finite: return "residual is not finite";
    }
    return "unknown";
}

namespace {
constexpr int recoverable = 1, fatal = -1;

/// KINSOL's own messages: outcomes carry the cause.
void say_nothing([[maybe_unused]] void* memory) {
#if SUNDIALS_VERSION_MAJOR < 7 // from there on the context has handlers, see Impl
    KINSetErrHandlerFn(
        memory, [](int, const char*, const char*, char*, void*) {}, nullptr);
#endif
}

// Newton's linear systems are solved to a fraction of the residual that shrinks with it, so that convergence stays
// quadratic, and never further than the nonlinear tolerance can tell.
constexpr double forcing_slope = 0.1, least_forcing = 1e-8, most_forcing = 1e-3, tolerance_share = 0.1;
constexpr double linear_tolerance = 1e-10; // of solve_linear()
/// Failures of a fresh preconditioner in one solve after which it is not tried again there.
constexpr int worth_trying = 2;
} // namespace

struct KinsolSolver::Impl {
    Impl(Index n, Timings& t, Ranks* r, int side_by_side)
        : size(n), timings(t), ranks(r), threads(side_by_side), vectors(n, side_by_side, context) {
#if SUNDIALS_VERSION_MAJOR >= 7
        SUNContext_ClearErrHandlers(context);
#endif
        handle = SUNMatNewEmpty(context);
        handle->content = this;
        handle->ops->getid = [](SUNMatrix) { return SUNMATRIX_CUSTOM; };
        handle->ops->zero = [](SUNMatrix) { return 0; }; // the problem rewrites every value
        handle->ops->destroy = [](SUNMatrix A) { SUNMatFreeEmpty(A); };
        linear = SUNLinSolNewEmpty(context);
        linear->content = this;
        linear->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_DIRECT; };
        linear->ops->getid = [](SUNLinearSolver) { return SUNLINEARSOLVER_CUSTOM; };
        linear->ops->initialize = [](SUNLinearSolver) { return 0; };
        linear->ops->setup = [](SUNLinearSolver S, SUNMatrix) { return static_cast<Impl*>(S->content)->setup(); };
        linear->ops->solve = [](SUNLinearSolver S, SUNMatrix, N_Vector x, N_Vector b, sunrealtype) {
            return static_cast<Impl*>(S->content)->linear_solve(b, x);
        };
        linear->ops->free = [](SUNLinearSolver S) {
            SUNLinSolFreeEmpty(S);
            return 0;
        };
    }
    ~Impl() {
        if (memory != nullptr) KINFree(&memory);
        SUNLinSolFree(linear);
        SUNMatDestroy(handle);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    [[nodiscard]] Eigen::Map<Vector> values(double* of) const {
        return {of, size};
    }
    [[nodiscard]] Eigen::Map<const Vector> values(const double* of) const {
        return {of, size};
    }

    /// Runs a callback's body; an exception is kept for solve() to rethrow and becomes a fatal return.
    template <class Body> int guarded(Body&& body) noexcept {
        try {
            return body();
        } catch (...) {
            if (!error) error = std::current_exception();
            return fatal;
        }
    }

    int residual(N_Vector at, N_Vector F) {
        return guarded([&] {
            double* f = !vectors.in_slices() ? N_VGetArrayPointer(F) : vectors.whole_out.data();
            if (vectors.in_slices()) vectors.give(at, vectors.whole_in);
            const double* u = !vectors.in_slices() ? N_VGetArrayPointer(at) : vectors.whole_in.data();
            const auto verdict = problem->residual(values(u), values(f));
            if (verdict == NonlinearProblem::Verdict::stop) {
                stopped = true;
                return fatal;
            }
            if (verdict == NonlinearProblem::Verdict::shorten) return recoverable;
            double largest = 0;
            for (Index i = 0; i < size; ++i) {
                if (!std::isfinite(f[i])) {
                    not_finite = true;
                    return fatal;
                }
                largest = std::max(largest, std::abs(f[i]));
            }
            last_residual = largest * residual_scale;
            if (vectors.in_slices()) vectors.take(vectors.whole_out, F);
            return 0;
        });
    }

    int setup() {
        return guarded([&] {
            matrix = nullptr;
            if (problem->tangent() != nullptr) {
                problem->tangent()->linearise();
                return 0;
            }
            matrix = &problem->jacobian();
            return problem->preconditioner() != nullptr || factorise(*matrix) ? 0 : fatal;
        });
    }

    [[nodiscard]] std::unique_ptr<DirectSolver> made(std::unique_ptr<DirectSolver> solver) const {
        return ranks != nullptr ? make_direct_on_first(std::move(solver), *ranks) : std::move(solver);
    }

    /// False where A is singular.
    bool factorise(const SparseMatrix& A) {
        if (direct != nullptr && A.pattern == factored_pattern && A.revision == factored_revision) return true;
        const ScopedTimer timer(timings, Part::factor);
        if (direct == nullptr || A.symmetric_positive_definite != is_cholesky) {
            is_cholesky = A.symmetric_positive_definite;
            direct = made(is_cholesky ? make_cholesky() : make_lu());
        }
        factored_pattern = 0;
        FactorStatus status = direct->factorise(A);
        ++factorisations;
        if (status == FactorStatus::indefinite && A.may_turn_indefinite) {
            is_cholesky = false;
            direct = made(make_lu());
            status = direct->factorise(A);
            ++factorisations;
        }
        if (status != FactorStatus::ok) {
            singular = true;
            failing_equation = direct->failing_equation();
            return false;
        }
        factored_pattern = A.pattern;
        factored_revision = A.revision;
        return true;
    }

    int linear_solve(N_Vector b, N_Vector x) {
        return guarded([&] {
            const bool solved = solve_by_own(b, x) ||
                                (problem->preconditioner() != nullptr ? solve_by_krylov(b, x) : solve_directly(b, x));
            if (!solved) return fatal;
            if (vectors.finite(x)) return 0;
            singular = true;
            return fatal;
        });
    }

    /// How far a solution may be off, |b - J x|.
    [[nodiscard]] double allowed_error(N_Vector b) const {
        if (linear_alone) return linear_tolerance * std::sqrt(N_VDotProd(b, b));
        const double norm = std::sqrt(N_VDotProd(b, b)) * residual_scale;
        const double forcing = std::clamp(forcing_slope * norm, least_forcing, most_forcing);
        return std::max(forcing * norm, tolerance_share * tolerance) / residual_scale;
    }

    bool solve_by_own(N_Vector b, N_Vector x) {
        Tangent* tangent = problem->tangent();
        if (tangent == nullptr || !tangent->solves() || own_failures >= worth_trying) return false;
        const int before = tangent->factorisations();
        require(!vectors.in_slices(), "a solver of the problem's own has no slices");
        const bool solved =
            tangent->solve(values(N_VGetArrayPointer(b)), values(N_VGetArrayPointer(x)), allowed_error(b));
        factorisations += tangent->factorisations() - before;
        own_failures += solved ? 0 : 1;
        return solved;
    }

    bool solve_directly(N_Vector b, N_Vector x) {
        const ScopedTimer timer(timings, Part::solve);
        if (!vectors.in_slices()) {
            direct->solve(N_VGetArrayPointer(b), N_VGetArrayPointer(x));
            return true;
        }
        vectors.give(b, vectors.whole_in);
        direct->solve(vectors.whole_in.data(), vectors.whole_out.data());
        vectors.take(vectors.whole_out, x);
        return true;
    }

    /// GMRES with the problem's preconditioner, which is kept while it is good and made anew where it is not; at last a
    /// factorisation of the tangent itself.
    bool solve_by_krylov(N_Vector b, N_Vector x) {
        const auto times = [this](const double* v, double* y) {
            if (matrix != nullptr)
                matrix->multiply(v, y);
            else
                problem->tangent()->multiply(values(v), values(y));
        };
        const auto nearly = [this](const double* r, double* y) {
            problem->preconditioner()->precondition(values(r), values(y));
        };
        const double allowed = allowed_error(b);
        if (vectors.in_slices()) vectors.forget_whole();
        Wear& wear = problem->preconditioner()->wear();
        SparseIndex suspect = -1;
        for (bool fresh = false; !fresh && preconditioner_failures < worth_trying;) {
            fresh = !wear.usable;
            if (fresh || problem->preconditioner()->lasts()) {
                const ScopedTimer timer(timings, Part::factor);
                factorisations += fresh ? 1 : 0;
                const FactorStatus status =
                    fresh ? problem->preconditioner()->factorise() : problem->preconditioner()->refresh();
                if (status != FactorStatus::ok) {
                    wear.usable = false;
                    suspect = problem->preconditioner()->failing_equation();
                    ++preconditioner_failures;
                    break;
                }
            }
            const ScopedTimer timer(timings, Part::solve);
            const auto on_all_unknowns = [&] {
                if (krylov == nullptr) {
                    krylov = std::make_unique<Gmres>(size, vectors.slices(), threads);
                    krylov->lend(vectors.whole_in.data(), vectors.whole_out.data());
                }
                return krylov->solve(times, nearly, N_VGetArrayPointer(b), N_VGetArrayPointer(x), allowed);
            };
            std::optional<Gmres::Result> own;
            if (!vectors.in_slices())
                own = problem->preconditioner()->solve_with(values(N_VGetArrayPointer(b)),
                                                            values(N_VGetArrayPointer(x)), allowed);
            const Gmres::Result result = own ? *own : on_all_unknowns();
            gmres_iterations += result.iterations;
            const double digits = std::max(1.0, std::log10(std::sqrt(N_VDotProd(b, b)) / allowed));
            if (fresh) wear = {true, result.iterations / digits, 0};
            wear.wasted += std::max(0.0, result.iterations - digits * wear.fresh);
            wear.usable = result.converged && wear.wasted <= problem->preconditioner()->effort();
            if (result.converged) return true;
            preconditioner_failures += fresh ? 1 : 0;
        }
        if (!problem->factorisable()) {
            unsolved = true;
            return false;
        }
        if (matrix == nullptr) matrix = &problem->jacobian();
        if (factorise(*matrix)) return solve_directly(b, x);
        if (suspect >= 0) failing_equation = suspect;
        return false;
    }

    /// Forgets what was tried before: no result may depend on it.
    void begin(NonlinearProblem& solved) {
        problem = &solved;
        stopped = singular = unsolved = not_finite = false;
        preconditioner_failures = own_failures = 0;
        if (Preconditioner* p = solved.preconditioner(); p != nullptr && !p->lasts()) p->wear() = {};
        failing_equation = -1;
        error = nullptr;
        if (size == 0 || !vectors.shape_for(solved.slices())) return;
        krylov = nullptr;
        for (VectorPtr* v : {&z, &u_scale, &f_scale}) *v = vectors.make();
    }

    /// Slices are made anew for each solve(): beside them there are whole vectors, of all processes, and the basis of GMRES.
    void end() {
        KINFree(&memory); // its vectors are as long as the others
        if (!vectors.in_slices()) return;
        krylov = nullptr;
        for (VectorPtr* v : {&z, &u_scale, &f_scale}) *v = nullptr;
        vectors.release();
    }

    /// KINSOL keeps counters and scalings between calls; a fresh memory block per solve keeps calls independent.
    void create(const KinsolOptions& options) {
        if (memory != nullptr) KINFree(&memory);
        memory = KINCreate(context);
        require(memory != nullptr, "KINSOL could not be created");
        const auto call = [](int code) { require(code == KIN_SUCCESS, "KINSOL rejected an option"); };
        call(KINInit(
            memory, [](N_Vector at, N_Vector F, void* self) { return static_cast<Impl*>(self)->residual(at, F); },
            z.get()));
        call(KINSetUserData(memory, this));
        say_nothing(memory);
        call(KINSetLinearSolver(memory, linear, handle));
        call(KINSetJacFn(memory, [](N_Vector, N_Vector, SUNMatrix, void*, N_Vector, N_Vector) { return 0; }));
        call(KINSetMaxSetupCalls(memory, 1));    // full Newton
        call(KINSetMaxNewtonStep(memory, 1e30)); // the default cuts every step from u = 0 to length 1
        call(KINSetFuncNormTol(memory, options.tolerance));
        call(KINSetScaledStepTol(memory, 1e-30)); // the step test must never claim convergence
        call(KINSetNumMaxIters(memory, options.max_iterations));
    }

    sundials::Context context;
    Index size;
    Timings& timings;
    Ranks* ranks;
    int threads;
    KinsolVectors vectors;
    VectorPtr z, u_scale, f_scale;
    SUNMatrix handle = nullptr;
    SUNLinearSolver linear = nullptr;
    void* memory = nullptr;

    NonlinearProblem* problem = nullptr;
    std::unique_ptr<DirectSolver> direct;
    std::unique_ptr<Gmres> krylov;
    const SparseMatrix* matrix = nullptr; ///< the tangent's, null where it has not been asked for
    int preconditioner_failures = 0;      ///< in this solve
    int own_failures = 0;                 ///< of the problem's own solver, in this solve
    double tolerance = 0;
    bool is_cholesky = false;
    std::uint64_t factored_pattern = 0, factored_revision = 0;
    double residual_scale = 1, last_residual = 0;
    long factorisations = 0, gmres_iterations = 0;
    bool linear_alone = false; ///< no equilibrium is sought
    bool stopped = false, singular = false, unsolved = false, not_finite = false;
    SparseIndex failing_equation = -1;
    std::exception_ptr error;
};

KinsolSolver::KinsolSolver(Index size, Timings& timings, Ranks* ranks, int threads)
    : impl_(std::make_unique<Impl>(size, timings, ranks, threads)) {}
KinsolSolver::~KinsolSolver() = default;

long KinsolSolver::factorisations() const {
    return impl_->factorisations;
}

long KinsolSolver::gmres_iterations() const {
    return impl_->gmres_iterations;
}

bool KinsolSolver::linearise(NonlinearProblem& problem) {
    Impl& s = *impl_;
    s.begin(problem);
    s.linear_alone = true;
    if (s.size == 0) return true;
    const bool done = s.setup() == 0;
    if (s.error) std::rethrow_exception(s.error);
    return done;
}

bool KinsolSolver::solve_linear(const Vector& b, Vector& x) {
    Impl& s = *impl_;
    require(b.size() == s.size && s.linear_alone, "KinsolSolver: nothing was linearised");
    x = Vector::Zero(s.size);
    if (s.size == 0 || b.isZero(0)) return true;
    const VectorPtr bs = s.vectors.make(), xs = s.vectors.make();
    s.vectors.take(b, bs.get());
    N_VConst(0, xs.get());
    const bool done = s.linear_solve(bs.get(), xs.get()) == 0;
    if (s.error) std::rethrow_exception(s.error);
    s.vectors.give(xs.get(), x);
    return done;
}

KinsolResult KinsolSolver::solve(NonlinearProblem& problem, Vector& unknowns, KinsolOptions options) {
    Impl& s = *impl_;
    require(problem.size() == s.size && unknowns.size() == s.size && options.unknown_scale.size() == s.size,
            "KinsolSolver: sizes differ");
    s.begin(problem);
    s.linear_alone = false;
    s.residual_scale = options.residual_scale;
    s.tolerance = options.tolerance;
    if (s.size == 0) { // everything is held; KINSOL looks at the first entry of every vector
        KinsolResult nothing;
        Vector none;
        const auto verdict = problem.residual(none, none);
        if (verdict == NonlinearProblem::Verdict::shorten) nothing.outcome = KinsolOutcome::not_evaluable;
        if (verdict == NonlinearProblem::Verdict::stop) nothing.outcome = KinsolOutcome::stopped;
        return nothing;
    }
    const long factorisations_before = s.factorisations;
    s.vectors.take(unknowns, s.z.get());
    s.vectors.take(options.unknown_scale, s.u_scale.get());
    options.unknown_scale.resize(0); // as long as the model
    N_VConst(options.residual_scale, s.f_scale.get());
    s.create(options);

    KinsolResult result;
    result.return_code =
        KINSol(s.memory, s.z.get(), options.line_search ? KIN_LINESEARCH : KIN_NONE, s.u_scale.get(), s.f_scale.get());
    if (s.error) std::rethrow_exception(s.error);
    s.vectors.give(s.z.get(), unknowns);
    long iterations = 0;
    KINGetNumNonlinSolvIters(s.memory, &iterations);
    s.end();
    result.iterations = static_cast<int>(iterations);
    result.factorisations = static_cast<int>(s.factorisations - factorisations_before);
    result.residual = s.last_residual;
    result.failing_equation = s.failing_equation;
    const bool small = s.last_residual <= options.tolerance;
    if (s.stopped)
        result.outcome = KinsolOutcome::stopped;
    else if (s.not_finite)
        result.outcome = KinsolOutcome::not_finite;
    else if (s.singular)
        result.outcome = KinsolOutcome::singular;
    else if (s.unsolved)
        result.outcome = KinsolOutcome::unsolved;
    else if (result.return_code == KIN_SUCCESS || result.return_code == KIN_INITIAL_GUESS_OK ||
             (result.return_code == KIN_STEP_LT_STPTOL && small))
        result.outcome = KinsolOutcome::converged;
    else if (result.return_code == KIN_MAXITER_REACHED)
        result.outcome = KinsolOutcome::max_iterations;
    else if (result.return_code == KIN_LINESEARCH_NONCONV || result.return_code == KIN_LINESEARCH_BCFAIL ||
             result.return_code == KIN_STEP_LT_STPTOL)
        result.outcome = KinsolOutcome::no_descent;
    else
        result.outcome = KinsolOutcome::not_evaluable;
    return result;
}

} // namespace osculate::solve
