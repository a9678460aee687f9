#pragma once
/// A matrix of 3 x 3 blocks in single precision, for smoothing.

#include <petscsystypes.h>
#include <vector>

namespace osculate::solve {

/// Smoothing waits for memory: blocks in single precision take 40 bytes where rows in double precision take 84. Vectors are in
/// double precision, and so are sums; a cycle errs by 1e-7 of itself, which GMRES does not see.
class SingleBlocks {
public:
    /// @param row_start, column  (3 nodes rows) of the entries, columns ascending
    SingleBlocks(const std::vector<PetscInt>& row_start, const std::vector<PetscInt>& column);
    /// Takes the values of these entries.
    void set(const std::vector<PetscInt>& row_start, const std::vector<PetscInt>& column,
             const std::vector<double>& value);
    /// y = A x
    void multiply(const double* x, double* y) const;

private:
    std::vector<PetscInt> start_, node_; ///< (nodes + 1) of blocks, (blocks) column
    std::vector<float> value_;           ///< (9 blocks, and one) by columns
};

} // namespace osculate::solve
