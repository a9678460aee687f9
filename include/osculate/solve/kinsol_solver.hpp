#pragma once
/// SUNDIALS' KINSOL as the owner of the nonlinear solve, with our matrix and our factorisations behind its seams.

#include "osculate/solve/direct_solver.hpp"

#include <functional>
#include <memory>
#include <string>

namespace osculate {
class Timings;
}

namespace osculate::solve {

/// A matrix P near the tangent that is cheaper to invert.
class Preconditioner {
public:
    virtual ~Preconditioner() = default;
    /// Factorises P at the z of the last residual.
    [[nodiscard]] virtual FactorStatus factorise() = 0;
    /// z = P^-1 r
    virtual void precondition(const ConstVectorRef& r, VectorRef z) = 0;
    /// Equation where factorise() failed, -1 unknown.
    [[nodiscard]] virtual SparseIndex failing_equation() const = 0;
};

/// The tangent J by what it does, without having it as a matrix.
class Tangent {
public:
    virtual ~Tangent() = default;
    /// Takes J at the z of the last residual.
    virtual void linearise() = 0;
    /// y = J x
    virtual void multiply(const ConstVectorRef& x, VectorRef y) = 0;
    /// Whether it knows a way of its own to solve with J.
    [[nodiscard]] virtual bool solves() const { return false; }
    /// x with |b - J x| <= allowed. False where it cannot: it is then solved as any other. @pre solves()
    [[nodiscard]] virtual bool solve(const ConstVectorRef& b, VectorRef x, double allowed) {
        (void)b, (void)x, (void)allowed;
        return false;
    }
    /// Factorisations made in solve() so far.
    [[nodiscard]] virtual int factorisations() const { return 0; }
};

/// F(z) = 0 with n unknowns, as KINSOL sees it.
class NonlinearProblem {
public:
    enum class Verdict {
        proceed,
        shorten, ///< F cannot be evaluated here (recoverable): KINSOL halves the step
        stop,    ///< this solve must end now, by our own decision
    };
    virtual ~NonlinearProblem() = default;
    [[nodiscard]] virtual Index size() const = 0;
    /// F (n) at z (n). KINSOL calls it once per Newton iterate, and more often within a line search.
    [[nodiscard]] virtual Verdict residual(const ConstVectorRef& z, VectorRef F) = 0;
    /// J = dF/dz at the z of the last residual.
    [[nodiscard]] virtual const SparseMatrix& jacobian() = 0;
    /// How to invert about J, where the problem knows better than to factorise it.
    [[nodiscard]] virtual Preconditioner* preconditioner() { return nullptr; }
    /// J without its matrix, where the problem has that: jacobian() is then asked for only to be factorised.
    [[nodiscard]] virtual Tangent* tangent() { return nullptr; }
    /// Whether jacobian() may be factorised where GMRES gets nowhere.
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
    stopped,       ///< the problem said stop
    singular,      ///< the tangent could not be factorised
    unsolved,      ///< GMRES got nowhere, and the tangent is too large to factorise
    no_descent,    ///< line search failed
    not_evaluable, ///< F had no value along the step
    not_finite,    ///< F or the step held NaN or infinity
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
/// Whether the tangent has no inverse, as far as could be found out.
[[nodiscard]] inline bool is_singular(KinsolOutcome outcome) {
    return outcome == KinsolOutcome::singular || outcome == KinsolOutcome::unsolved;
}

/// One solver per problem size. Every Newton step is solved with the tangent at the iterate: by its factors, or, where the
/// problem offers a preconditioner, by GMRES, to a fraction of the residual that shrinks with it; factors are kept as long
/// as they serve, within one call of solve().
/// What KINSOL's return codes are taken to mean: 0 and 1 converged; 2 (step test) only if the residual test holds too.
class KinsolSolver {
public:
    KinsolSolver(Index size, Timings& timings);
    ~KinsolSolver();
    KinsolSolver(const KinsolSolver&) = delete;
    KinsolSolver& operator=(const KinsolSolver&) = delete;

    /// Solves F(z) = 0 from the start value in z (n), which holds the last iterate afterwards.
    /// Rethrows whatever the problem's callbacks threw.
    [[nodiscard]] KinsolResult solve(NonlinearProblem& problem, Vector& z, const KinsolOptions& options);
    /// Factorisations over the life of this solver.
    [[nodiscard]] long factorisations() const;
    /// GMRES iterations on the whole tangent over the life of this solver.
    [[nodiscard]] long gmres_iterations() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace osculate::solve
