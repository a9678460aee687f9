#include "osculate/core/dense_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace osculate {

Matrix pseudo_inverse(const Matrix& A) {
    return A.completeOrthogonalDecomposition().pseudoInverse();
}

Vector least_squares(const Matrix& A, const Vector& b) {
    return A.completeOrthogonalDecomposition().solve(b);
}

Matrix fit_columns(const Matrix& A, const Matrix& B) {
    return A.householderQr().solve(B);
}

Matrix solve_square(const Matrix& A, const Matrix& B) {
    return A.partialPivLu().solve(B);
}

Vector singular_values(const Matrix& A) {
    return Eigen::JacobiSVD<Matrix>(A).singularValues();
}

SymmetricEigen symmetric_eigen(const Matrix& A) {
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(A);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

PrincipalAxes principal_axes(const Mat3& A) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(A);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Mat3 nearest_rotation(const Mat3& A) {
    // R = U V^T of A = U S V^T, a reflection undone
    const Eigen::JacobiSVD<Mat3> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 U = svd.matrixU();
    if (U.determinant() * svd.matrixV().determinant() < 0) U.col(2) *= -1;
    return U * svd.matrixV().transpose();
}

} // namespace osculate
