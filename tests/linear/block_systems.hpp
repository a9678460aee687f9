#pragma once
/// Small block systems for the tests of the system's matrices, and their dense twins.

#include "osculate/linear/block_matrix.hpp"
#include "osculate/solve/sparse_matrix.hpp"
#include "support/random.hpp"

#include <stdexcept>

namespace osculate::linear::fixtures {

inline Matrix random_matrix(Index n, osculate::support::Random& random) {
    Matrix A(n, n);
    for (double& a : A.reshaped()) a = random.uniform();
    return A;
}

/// Two elements that share two nodes, a third apart, and node 8 alone.
inline std::vector<std::vector<Index>> some_elements() {
    return {{3, 0, 2, 1}, {2, 5, 4, 3}, {7, 6}};
}

inline Matrix dense_of(const BlockMatrix& K) {
    Matrix A = Matrix::Zero(3 * K.rows(), 3 * K.rows());
    for (Index row = 0; row < K.rows(); ++row)
        for (Index k = K.row_begin(row); k < K.row_end(row); ++k) A.block<3, 3>(3 * row, 3 * K.column(k)) = K.block(k);
    return A;
}

/// Also checks that columns ascend within a row, as every solver expects.
inline Matrix dense_of(const solve::SparseMatrix& S) {
    Matrix A = Matrix::Zero(static_cast<Index>(S.rows()), static_cast<Index>(S.rows()));
    for (solve::SparseIndex row = 0; row < S.rows(); ++row)
        for (solve::SparseIndex k = S.row_start[row]; k < S.row_start[row + 1]; ++k) {
            if (k > S.row_start[row] && S.column[k] <= S.column[k - 1])
                throw std::runtime_error("columns do not ascend");
            A(static_cast<Index>(row), static_cast<Index>(S.column[k])) = S.value[k];
        }
    return A;
}

} // namespace osculate::linear::fixtures
