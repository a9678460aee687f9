#pragma once
/// Nonlinear solver: SUNDIALS' KINSOL, with our matrix and our factorisations behind its interfaces.

#include "osculate/solve/direct_solver.hpp"
#include "osculate/solve/gmres.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace osculate {
class Ranks;
class Slices;
class Timings;
} // namespace osculate

namespace osculate::solve {

/// How the factors of a preconditioner have served since they were made.
struct Wear {
    bool usable = false; ///< they exist, and new ones would not pay
    double fresh = 0;    ///< iterations of GMRES a digit when they were new
    double wasted = 0;   ///< iterations since then beyond those that new ones would have taken
};

/// A matrix P that approximates the tangent and is cheaper to invert.
class Preconditioner {
public:
    virtual ~Preconditioner() = default;
    /// Of the factors, by the solver.
    [[nodiscard]] Wear& wear() { return wear_; }
    [[nodiscard]] const Wear& wear() const { return wear_; }
    /// Whether the factors, and their wear, may serve from one solve to the next; then the problem undoes what failed attempts do.
    [[nodiscard]] virtual bool lasts() const { return false; }
    /// Makes the factors that wear() speaks of again, where the problem has put back others. @pre lasts()
    [[nodiscard]] virtual FactorStatus refresh() { return FactorStatus::ok; }
    /// Factorises P at the z of the last residual.
    [[nodiscard]] virtual FactorStatus factorise() = 0;
    /// z = P^-1 r
    virtual void precondition(const ConstVectorRef& r, VectorRef z) = 0;
    /// Estimate of the time of factorise() over that of an iteration of GMRES: P is made anew once that many have been wasted.
    [[nodiscard]] virtual double effort() const { return 20; }
    /// Computes x with |b - J x| <= allowed by a GMRES of its own, for the tangent J at the last residual; no value: it has none, or
    /// that does not reach so far.
    [[nodiscard]] virtual std::optional<Gmres::Result> solve_with(const ConstVectorRef& b, VectorRef x,
                                                                  double allowed) {
        (void)b, (void)x, (void)allowed;
        return std::nullopt;
    }
    /// Equation at which factorise() failed, -1: unknown.
    [[nodiscard]] virtual SparseIndex failing_equation() const = 0;

private:
    Wear wear_;
};

/// The tangent J as products with vectors, without its matrix.
class Tangent {
public:
    virtual ~Tangent() = default;
    /// Linearises: J at the z of the last residual.
    virtual void linearise() = 0;
    /// y = J x
    virtual void multiply(const ConstVectorRef& x, VectorRef y) = 0;
    /// Whether it has its own method to solve with J.
    [[nodiscard]] virtual bool solves() const { return false; }
    /// Computes x with |b - J x| <= allowed. False if it cannot: J is then solved by the general method. @pre solves()
    [[nodiscard]] virtual bool solve(const ConstVectorRef& b, VectorRef x, double allowed) {
        (void)b, (void)x, (void)allowed;
        return false;
    }
    /// Factorisations made in solve() so far.
    [[nodiscard]] virtual int factorisations() const { return 0; }
};

/// F(z) = 0 with n unknowns, in the form for KINSOL.
class NonlinearProblem {
public:
    enum class Verdict {
        proceed,
        shorten, ///< F cannot be evaluated here (recoverable): KINSOL halves the step
        stop,    ///< this solve must end now, by the problem's own decision
    };
    virtual ~NonlinearProblem() = default;
    [[nodiscard]] virtual Index size() const = 0;
    /// F (n) at z (n). KINSOL calls it once per Newton iterate, and more often during a line search.
    [[nodiscard]] virtual Verdict residual(const ConstVectorRef& z, VectorRef F) = 0;
    /// J = dF/dz at the z of the last residual.
    [[nodiscard]] virtual const SparseMatrix& jacobian() = 0;
    /// The problem's preconditioner, if it has one that is cheaper than to factorise J; else null.
    [[nodiscard]] virtual Preconditioner* preconditioner() { return nullptr; }
    /// J without its matrix, if the problem has that; jacobian() is then called only for factorisation.
    [[nodiscard]] virtual Tangent* tangent() { return nullptr; }
    /// The processes' parts of the vectors of KINSOL and GMRES; null: there is one process, or each has whole ones. The residual is
    /// of whole vectors on all, the tangent and the preconditioner see whole ones with what they read filled in. They are as long as
    /// the solver lives.
    [[nodiscard]] virtual Slices* slices() { return nullptr; }
    /// Whether jacobian() may be factorised if GMRES fails.
    [[nodiscard]] virtual bool factorisable() const { return true; }
};

struct KinsolOptions {
    double tolerance = 1e-9;   ///< largest |F_i| * residual_scale that counts as converged
    double residual_scale = 1; ///< 1 / reference force, N^-1
    Vector unknown_scale;      ///< (n) 1 / typical size of each unknown
    int max_iterations = 30;
    bool line_search = false;
};

enum class KinsolOutcome {
    converged,
    max_iterations,
    stopped,       ///< the problem requested a stop
    singular,      ///< the tangent could not be factorised
    unsolved,      ///< GMRES failed, and the tangent is too large to factorise
    no_descent,    ///< line search failed
    not_evaluable, ///< F had no value along the step
    not_finite,    ///< F or the step contained NaN or infinity
};

struct KinsolResult {
    KinsolOutcome outcome = KinsolOutcome::converged;
    int iterations = 0;
    int factorisations = 0;
    double residual = 0; ///< largest |F_i| * residual_scale at the end
    int return_code = 0; ///< KINSOL's own
    SparseIndex failing_equation = -1;
};

[[nodiscard]] std::string describe(KinsolOutcome outcome);
/// Whether the tangent is singular, as far as this is known.
[[nodiscard]] inline bool is_singular(KinsolOutcome outcome) {
    return outcome == KinsolOutcome::singular || outcome == KinsolOutcome::unsolved;
}

/// One solver per problem size. Every Newton step is solved with the tangent at the iterate: by its factors or, if the
/// problem has a preconditioner, by GMRES, to a fraction of the residual that decreases with it. Factors are kept while
/// they are useful, within one call of solve().
/// Interpretation of KINSOL's return codes: 0 and 1 converged; 2 (step test) only if the residual test holds too.
class KinsolSolver {
public:
    /// @param ranks    processes that solve together; null: there is one
    /// @param threads  see Gmres
    KinsolSolver(Index size, Timings& timings, Ranks* ranks = nullptr, int threads = 1);
    ~KinsolSolver();
    KinsolSolver(const KinsolSolver&) = delete;
    KinsolSolver& operator=(const KinsolSolver&) = delete;

    /// Solves F(z) = 0 from the start value in z (n), which contains the last iterate afterwards. Rethrows whatever the
    /// problem's callbacks threw.
    [[nodiscard]] KinsolResult solve(NonlinearProblem& problem, Vector& z, KinsolOptions options);
    /// Linearises at the problem's last residual. @returns false if J is singular
    [[nodiscard]] bool linearise(NonlinearProblem& problem);
    /// x = J^-1 b (n), to |b - J x| <= 1e-10 |b|. @returns false if J is singular, or too large to be factorised where GMRES fails. @pre linearise(), and no residual since
    [[nodiscard]] bool solve_linear(const Vector& b, Vector& x);
    /// Number of factorisations during the life of this solver.
    [[nodiscard]] long factorisations() const;
    /// Number of GMRES iterations on the whole tangent during the life of this solver.
    [[nodiscard]] long gmres_iterations() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace osculate::solve
