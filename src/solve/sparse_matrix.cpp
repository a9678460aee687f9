#include "osculate/solve/sparse_matrix.hpp"

namespace osculate::solve {

void SparseMatrix::multiply(const double* x, double* y) const {
    for (SparseIndex i = 0; i < rows(); ++i) {
        double sum = 0;
        for (SparseIndex k = row_start[i]; k < row_start[i + 1]; ++k) sum += value[k] * x[column[k]];
        y[i] = sum;
    }
}

} // namespace osculate::solve
