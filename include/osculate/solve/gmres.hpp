#pragma once
/// SUNDIALS' GMRES for linear maps without a matrix.

#include "osculate/core/types.hpp"

#include <functional>
#include <memory>

namespace osculate {
class Slices;
}

namespace osculate::solve {

/// y = A x
using LinearMap = std::function<void(const double* x, double* y)>;

/// SPGMR without restarts. A preconditioner, if any, is applied from the right, so that the measured residual is b - A
/// x itself.
class Gmres {
public:
    static constexpr int most_iterations = 60;

    struct Result {
        bool converged = false;
        int iterations = 0;
    };

    /// @param slices  each process has its own of b, x and directions. Maps act on whole vectors, find what they read filled in, and
    ///                owe the process' own rows or unknowns alone. Null: there is one process
    /// @param threads  share the work on directions; bits do not depend on them
    explicit Gmres(Index size, Slices* slices = nullptr, int threads = 1);
    ~Gmres();
    Gmres(const Gmres&) = delete;
    Gmres& operator=(const Gmres&) = delete;

    /// Room for two whole vectors (size), on which maps act where there are slices, and which must outlive this object.
    void lend(double* in, double* out);
    /// Computes x with |b - A x| <= tolerance in the 2-norm.
    /// @param M  approximate inverse of A; empty: none
    [[nodiscard]] Result solve(const LinearMap& A, const LinearMap& M, const double* b, double* x, double tolerance);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace osculate::solve
