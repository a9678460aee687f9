#pragma once
/// SUNDIALS' GMRES for linear maps that are no matrices.

#include "osculate/core/types.hpp"

#include <functional>
#include <memory>

namespace osculate::solve {

/// y = A x
using LinearMap = std::function<void(const double* x, double* y)>;

/// SPGMR without restarts, preconditioned from the right where at all, so that it measures the residual b - A x itself.
class Gmres {
public:
    static constexpr int most_iterations = 60;

    struct Result {
        bool converged = false;
        int iterations = 0;
    };

    explicit Gmres(Index size);
    ~Gmres();
    Gmres(const Gmres&) = delete;
    Gmres& operator=(const Gmres&) = delete;

    /// x with |b - A x| <= tolerance in the 2-norm.
    /// @param M  inverse of a map near A; empty: none
    [[nodiscard]] Result solve(const LinearMap& A, const LinearMap& M, const double* b, double* x, double tolerance);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace osculate::solve
