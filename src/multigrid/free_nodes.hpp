#pragma once
/// Nodes with free components, numbered one after the other, and the free part of vectors and blocks over them.

#include "multigrid/exchange.hpp"
#include "osculate/solve/multigrid.hpp"

namespace osculate::solve {

/// One's own, then copies: neighbours of one's own nodes, and nodes that may be coupled, where other processes own them.
class FreeNodes {
public:
    /// @param A  with rows of one's own nodes
    FreeNodes(const NodalUnknowns& unknowns, const NodalMatrix& A);

    [[nodiscard]] Index size() const { return own_; }
    [[nodiscard]] Index with_copies() const { return static_cast<Index>(node_.size()); }
    /// Its number in the matrix.
    [[nodiscard]] Index node(Index i) const { return node_[i]; }
    /// Its number among all free nodes, of all processes.
    [[nodiscard]] Index place(Index i) const { return place_[i]; }
    /// Number here of a node of the matrix, -1: all its components are held, or it is not here.
    [[nodiscard]] Index number(Index node) const {
        return static_cast<std::size_t>(node) < number_.size() ? number_[node] : -1;
    }
    [[nodiscard]] bool whole(Index i) const { return projection_number_[i] == 0; } ///< no component is held
    /// Projection on the free directions, in global components.
    [[nodiscard]] const Mat3& projection(Index i) const { return projections_[projection_number_[i]]; }
    [[nodiscard]] Mat3 projected(Index i, Index j, const Mat3& block) const {
        return whole(i) && whole(j) ? block : Mat3(projection(i) * block * projection(j));
    }
    /// Calls each(j, block) for the projected blocks of row i, one's own.
    void for_row(const NodalMatrix& A, Index i, auto&& each) const {
        for (Index k = A.row_start[node_[i]]; k < A.row_start[node_[i] + 1]; ++k)
            if (const Index j = number(A.column[k]); j >= 0) each(j, projected(i, j, A.block[k]));
    }
    /// What is read of one's own nodes once the grids are chosen, equations and frames, numbered as here; and the hubs.
    [[nodiscard]] NodalUnknowns own(NodalUnknowns all) const;
    [[nodiscard]] const Exchange& exchange() const { return exchange_; }

private:
    void add(const NodalUnknowns& unknowns, Index place);

    Index own_ = 0;
    std::vector<Index> node_, place_, number_;
    std::vector<Index> projection_number_; ///< in projections_
    std::vector<Mat3> projections_{Mat3::Identity()};
    Exchange exchange_;
};

} // namespace osculate::solve
