#pragma once
/// Decompositions of small dense matrices, compiled once: a file that instantiates Eigen's templates for them takes
/// most of a minute longer to compile.

#include "osculate/core/types.hpp"

namespace osculate {

/// Moore-Penrose inverse (n x m) of A (m x n), by a complete orthogonal decomposition.
[[nodiscard]] Matrix pseudo_inverse(const Matrix& A);
/// x (n) of least norm that minimises |A x - b|, A (m x n), b (m).
[[nodiscard]] Vector least_squares(const Matrix& A, const Vector& b);
/// X (n x k) that minimises |A X - B|, A (m x n) of rank n, B (m x k).
[[nodiscard]] Matrix fit_columns(const Matrix& A, const Matrix& B);
/// X (n x k) with A X = B, A (n x n) regular, B (n x k), by LU factors with partial pivoting.
[[nodiscard]] Matrix solve_square(const Matrix& A, const Matrix& B);
/// (min(m, n)) singular values of A (m x n), the largest first.
[[nodiscard]] Vector singular_values(const Matrix& A);

/// A = vectors diag(values) vectors^T.
struct SymmetricEigen {
    Vector values;  ///< (n) ascending
    Matrix vectors; ///< (n x n) orthonormal columns
};
/// @param A  (n x n) symmetric; its lower triangle is read
[[nodiscard]] SymmetricEigen symmetric_eigen(const Matrix& A);

/// The same of a tensor.
struct PrincipalAxes {
    Vec3 values;  ///< ascending
    Mat3 vectors; ///< orthonormal columns
};
[[nodiscard]] PrincipalAxes principal_axes(const Mat3& A);

/// The rotation R for which tr(R^T A) is largest [Kabsch 1976].
[[nodiscard]] Mat3 nearest_rotation(const Mat3& A);

} // namespace osculate
