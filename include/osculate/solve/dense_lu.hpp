#pragma once
/// LU factorisation of a dense matrix.

#include "osculate/core/types.hpp"

#include <vector>

namespace osculate::solve {

/// LAPACK's LU factorisation with partial pivoting.
class DenseLu {
public:
    /// False if A (n x n) is singular, to working precision unless `ill_conditioned` is allowed.
    [[nodiscard]] bool factorise(Matrix A, bool ill_conditioned = false);
    /// b (n) becomes A^-1 b. @pre factorise() returned true
    void solve(double* b) const;
    /// b (n) becomes A^-T b. @pre factorise() returned true
    void solve_transposed(double* b) const;
    [[nodiscard]] Index size() const { return static_cast<Index>(LU_.rows()); }

private:
    void solve(char form, double* b) const;

    Matrix LU_;
    std::vector<int> pivot_;
};

} // namespace osculate::solve
