#pragma once
/// Small problems for KinsolSolver.

#include "osculate/core/timing.hpp"
#include "osculate/solve/kinsol_solver.hpp"
#include "systems.hpp"

#include <functional>

namespace osculate::solve::fixtures {

using Verdict = NonlinearProblem::Verdict;

/// A problem from two functions, with a diary of its residuals.
struct Problem : NonlinearProblem {
    [[nodiscard]] Index size() const override { return static_cast<Index>(J.rows()); }
    Verdict residual(const ConstVectorRef& z, VectorRef F) override {
        at = z;
        const Verdict verdict = evaluate(at, F);
        residuals.push_back(F.cwiseAbs().maxCoeff());
        return verdict;
    }
    const SparseMatrix& jacobian() override {
        if (linearise) {
            linearise(at, J);
            ++J.revision;
        }
        return J;
    }

    SparseMatrix J;
    std::function<Verdict(const Vector& z, VectorRef& F)> evaluate;
    std::function<void(const Vector& z, SparseMatrix& J)> linearise; ///< absent: J never changes
    Vector at;
    std::vector<double> residuals;
};

inline KinsolOptions options_for(const Problem& problem) {
    KinsolOptions options;
    options.unknown_scale = Vector::Ones(problem.size());
    return options;
}

inline KinsolResult run(Problem& problem, Vector& z, const KinsolOptions& options) {
    Timings timings;
    KinsolSolver solver(problem.size(), timings);
    return solver.solve(problem, z, options);
}
inline KinsolResult run(Problem& problem, Vector& z) {
    return run(problem, z, options_for(problem));
}

/// K u = f.
inline Problem linear(int n, const Vector& f) {
    Problem p;
    p.J = laplacian(n);
    p.evaluate = [K = p.J, f](const Vector& u, VectorRef& F) {
        K.multiply(u.data(), F.data());
        F -= f;
        return Verdict::proceed;
    };
    return p;
}

/// K u + u^3 = f.
inline Problem cubic(int n, const Vector& f) {
    Problem p;
    p.J = laplacian(n);
    const SparseMatrix K = p.J;
    p.evaluate = [K, f](const Vector& u, VectorRef& F) {
        K.multiply(u.data(), F.data());
        F += u.cwiseProduct(u).cwiseProduct(u) - f;
        return Verdict::proceed;
    };
    p.linearise = [K](const Vector& u, SparseMatrix& J) {
        J.value = K.value;
        for (Index i = 0; i < u.size(); ++i) diagonal(J, i) += 3 * u(i) * u(i);
    };
    return p;
}

/// One unknown: F(z) = f(z), J = df(z).
inline Problem scalar(std::function<double(double)> f, std::function<double(double)> df) {
    Problem p;
    p.J = sparse(Matrix::Ones(1, 1), false);
    p.evaluate = [f](const Vector& z, VectorRef& F) {
        F(0) = f(z(0));
        return std::isnan(F(0)) ? Verdict::shorten : Verdict::proceed;
    };
    p.linearise = [df](const Vector& z, SparseMatrix& J) { J.value[0] = df(z(0)); };
    return p;
}

/// The cubic problem, with another matrix to invert in place of its tangent.
struct Preconditioned : Problem, Preconditioner {
    Preconditioned(Problem problem, SparseMatrix matrix) : Problem(std::move(problem)), P(std::move(matrix)) {
        J.symmetric_positive_definite = false;
    }
    Preconditioner* preconditioner() override { return this; }
    FactorStatus factorise() override { return inverse->factorise(P); }
    void precondition(const ConstVectorRef& r, VectorRef z) override { inverse->solve(r.data(), z.data()); }
    [[nodiscard]] SparseIndex failing_equation() const override { return inverse->failing_equation(); }

    SparseMatrix P;
    std::unique_ptr<DirectSolver> inverse = make_cholesky();
};

} // namespace osculate::solve::fixtures
