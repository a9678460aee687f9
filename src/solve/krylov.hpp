#pragma once
/// GMRES with the factors of a neighbouring matrix as preconditioner.

#include "osculate/solve/kinsol_solver.hpp"

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>

namespace osculate::solve {

/// SUNDIALS' SPGMR, preconditioned from the right, so that it measures the residual b - A x itself.
class Krylov {
public:
    static constexpr int most_iterations = 60;

    struct Result {
        bool converged = false;
        int iterations = 0;
    };

    Krylov(N_Vector like, SUNContext context);
    ~Krylov();
    Krylov(const Krylov&) = delete;
    Krylov& operator=(const Krylov&) = delete;

    /// x with |b - A x| <= tolerance in the 2-norm; M solves a matrix near A.
    [[nodiscard]] Result solve(const SparseMatrix& A, Preconditioner& M, N_Vector b, N_Vector x, double tolerance);

private:
    SUNLinearSolver linear_ = nullptr;
    const SparseMatrix* A_ = nullptr;
    Preconditioner* M_ = nullptr;
};

} // namespace osculate::solve
