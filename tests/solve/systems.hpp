#pragma once
/// Small sparse systems for the solver tests.

#include "osculate/solve/sparse_matrix.hpp"
#include "support/random.hpp"

namespace osculate::solve::fixtures {

/// Sparse matrix of a dense one, zeros left out, diagonal kept. `pattern` names its pattern.
inline SparseMatrix sparse(const Matrix& A, bool symmetric_positive_definite, std::uint64_t pattern = 1) {
    SparseMatrix S;
    for (Index i = 0; i < A.rows(); ++i) {
        for (Index j = 0; j < A.cols(); ++j)
            if (A(i, j) != 0 || i == j) {
                S.column.push_back(j);
                S.value.push_back(A(i, j));
            }
        S.row_start.push_back(S.nonzeros());
    }
    S.symmetric_positive_definite = symmetric_positive_definite;
    S.pattern = pattern;
    S.revision = 1;
    return S;
}

/// About a tenth of the entries random in [-1, 1), diagonal `diagonal` on top.
inline Matrix random_matrix(Index n, double diagonal, osculate::support::Random& random) {
    Matrix A = diagonal * Matrix::Identity(n, n);
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j)
            if (random.uniform(0, 1) < 0.1) A(i, j) += random.uniform();
    return A;
}

inline Vector random_vector(Index n, osculate::support::Random& random) {
    Vector v(n);
    for (Index i = 0; i < n; ++i) v(i) = random.uniform();
    return v;
}

/// Seven-point Laplacian of an n x n x n grid with fixed boundary, plus `shift` on the diagonal.
inline SparseMatrix laplacian(int n, double shift = 0) {
    SparseMatrix S;
    const int offsets[] = {-n * n, -n, -1, 0, 1, n, n * n};
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const bool there[] = {z > 0, y > 0, x > 0, true, x + 1 < n, y + 1 < n, z + 1 < n};
                const int i = x + n * (y + n * z);
                for (int k = 0; k < 7; ++k)
                    if (there[k]) {
                        S.column.push_back(i + offsets[k]);
                        S.value.push_back(offsets[k] == 0 ? 6 + shift : -1);
                    }
                S.row_start.push_back(S.nonzeros());
            }
    S.symmetric_positive_definite = true;
    S.pattern = S.revision = 1;
    return S;
}

inline double& diagonal(SparseMatrix& A, SparseIndex row) {
    SparseIndex k = A.row_start[row];
    while (A.column[k] != row) ++k;
    return A.value[k];
}

} // namespace osculate::solve::fixtures
