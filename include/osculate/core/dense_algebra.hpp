#pragma once
/// Decompositions of small dense matrices, compiled once: a file that instantiates Eigen's templates for them takes
/// most of a minute longer to compile.

#include "osculate/core/types.hpp"

namespace osculate {

/// Moore-Penrose inverse (n x m) of A (m x n), by a complete orthogonal decomposition.
[[nodiscard]] Matrix pseudo_inverse(const Matrix& A);
/// x (n) of least norm that minimises |A x - b|, A (m x n), b (m).
[[nodiscard]] Vector least_squares(const Matrix& A, const Vector& b);
/// (min(m, n)) singular values of A (m x n), the largest first.
[[nodiscard]] Vector singular_values(const Matrix& A);

/// A = vectors diag(values) vectors^T.
struct SymmetricEigen {
    Vector values;  ///< (n) ascending
    Matrix vectors; ///< (n x n) orthonormal columns
};
/// @param A  (n x n) symmetric; its lower triangle is read
[[nodiscard]] SymmetricEigen symmetric_eigen(const Matrix& A);

} // namespace osculate
