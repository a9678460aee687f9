#include "osculate/solve/dense_lu.hpp"

#include "solve/blas_threads.hpp"

#include <limits>

extern "C" {
void dgetrf_(const int* m, const int* n, double* a, const int* lda, int* ipiv, int* info);
void dgetrs_(const char* trans, const int* n, const int* nrhs, const double* a, const int* lda, const int* ipiv,
             double* b, const int* ldb, int* info);
void dgecon_(const char* norm, const int* n, const double* a, const int* lda, const double* anorm, double* rcond,
             double* work, int* iwork, int* info);
}

namespace osculate::solve {

bool DenseLu::factorise(Matrix A, bool ill_conditioned) {
    use_one_blas_thread();
    LU_ = std::move(A);
    const auto n = static_cast<int>(LU_.rows());
    if (n == 0) return true;
    if (!LU_.allFinite()) return false;
    const double norm = LU_.cwiseAbs().colwise().sum().maxCoeff();
    pivot_.resize(static_cast<std::size_t>(n));
    int info = 0;
    dgetrf_(&n, &n, LU_.data(), &n, pivot_.data(), &info);
    if (info != 0) return false;
    if (ill_conditioned) return true;
    const char one = '1';
    double rcond = 0;
    std::vector<double> work(4 * static_cast<std::size_t>(n));
    std::vector<int> counts(static_cast<std::size_t>(n));
    dgecon_(&one, &n, LU_.data(), &n, &norm, &rcond, work.data(), counts.data(), &info);
    return rcond > std::numeric_limits<double>::epsilon();
}

void DenseLu::solve(double* b) const {
    solve('N', b);
}

void DenseLu::solve_transposed(double* b) const {
    solve('T', b);
}

void DenseLu::solve(char form, double* b) const {
    const auto n = static_cast<int>(LU_.rows());
    if (n == 0) return;
    const int one = 1;
    int info = 0;
    dgetrs_(&form, &n, &one, LU_.data(), &n, pivot_.data(), b, &n, &info);
}

} // namespace osculate::solve
