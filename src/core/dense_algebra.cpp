#include "osculate/core/dense_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace osculate {

Matrix pseudo_inverse(const Matrix& A) {
    return A.completeOrthogonalDecomposition().pseudoInverse();
}

Vector least_squares(const Matrix& A, const Vector& b) {
    return A.completeOrthogonalDecomposition().solve(b);
}

Vector singular_values(const Matrix& A) {
    return Eigen::JacobiSVD<Matrix>(A).singularValues();
}

SymmetricEigen symmetric_eigen(const Matrix& A) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(A);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

} // namespace osculate
