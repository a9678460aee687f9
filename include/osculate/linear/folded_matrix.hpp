#pragma once
/// A matrix over all nodes whose rows and columns of dependent nodes act at their carriers.

#include "osculate/linear/block_matrix.hpp"
#include "osculate/linear/dependence.hpp"

#include <vector>

namespace osculate::linear {

/// With du_i = sum_a moves_ia du_a and f_a += loads_ia f_i, see Dependence, the blocks of f = A u become
///     A_ab += sum_ij loads_ia A_ij moves_jb.
/// What a dependent node itself has is zero, so that products with motions that were spread first are the same.
class FoldedMatrix {
public:
    /// @param dependence  it must outlive this object; who carries whom must stay
    /// @param pattern     of the matrices to fold; a process has the rows of all or none of a node and those that it follows. O(nonzeros)
    FoldedMatrix(const Dependence& dependence, const BlockMatrix& pattern);

    /// Takes over the values of a matrix with that pattern, and those of the dependence.
    void fold(const BlockMatrix& A) { fold(A, folded_); }
    [[nodiscard]] const BlockMatrix& matrix() const { return folded_; }
    /// Another matrix folded in the same way.
    [[nodiscard]] BlockMatrix folded(const BlockMatrix& A) const;

private:
    void fold(const BlockMatrix& A, BlockMatrix& into) const;

    const Dependence& dependence_;
    std::vector<char> plain_; ///< (rows) neither the row nor one of its columns depends: it is copied
    BlockMatrix folded_;
};

/// Whether a dependent node has more than its diagonal block in a matrix, so that folding would move something.
[[nodiscard]] bool needs_folding(const Dependence& dependence, const BlockMatrix& pattern);

} // namespace osculate::linear
