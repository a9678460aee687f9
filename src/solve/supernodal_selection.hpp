#pragma once
/// Solutions with a supernodal Cholesky factor that are wanted, and have right sides, at some equations alone.

#include "osculate/solve/sparse_matrix.hpp"

#include <cholmod.h>
#include <span>
#include <vector>

namespace osculate::solve {

/// Visits only the supernodes of the chosen equations and their ancestors in the tree of elimination: the others get nothing in
/// forward substitution, and are not asked in backward substitution. Solutions wait for memory, not for the processor: so this
/// holds what it visits once more, in single precision, one after the other.
class SupernodalSelection {
public:
    /// @param factor     LL^T with its values, which are copied
    /// @param equations  of the matrix, each once
    SupernodalSelection(const cholmod_factor& factor, std::span<const SparseIndex> equations);
    /// x = (A^-1 b) at the chosen equations for b that is zero elsewhere; both in their order, b and x may be the same. The error
    /// is about 6e-8 times the condition number.
    void solve(const double* b, double* x);

private:
    struct Supernode {
        int first = 0, columns = 0, rows = 0; ///< rows: those of the diagonal block and those below it
        std::size_t below = 0, values = 0;    ///< places in row_ and L_
    };
    std::vector<Supernode> visited_; ///< ascending; their rows are numbered anew, without gaps
    std::vector<int> row_;           ///< below the diagonal blocks
    std::vector<float> L_;
    std::vector<int> place_;               ///< (equations) row
    std::vector<float> values_, gathered_; ///< (rows), (most rows below a diagonal block)
};

} // namespace osculate::solve
