#pragma once
/// One linear body's stiffness, factorised once, and its inverse on the nodes that contact may reach.

#include "osculate/linear/block_matrix.hpp"
#include "osculate/linear/constraints.hpp"
#include "osculate/solve/direct_solver.hpp"

#include <memory>
#include <vector>

namespace osculate::linear {

/// Works on the free components of the body's nodes, in their local frames. Springs of equal stiffness along the free
/// components of a few nodes hold a body that has no other support; the caller must cancel their effect.
class BodyCompliance {
public:
    /// @param kept    nodes of the body, global, ascending
    /// @param sprung  those of `kept` that have springs
    BodyCompliance(const Constraints& constraints, Index first_node, Index nodes, std::vector<Index> kept,
                   std::vector<Index> sprung);
    /// @param K       free components of all bodies, by equation number
    /// @param spring  N/m
    [[nodiscard]] solve::FactorStatus factorise(const solve::SparseMatrix& K, double spring);
    /// Whether the last factorise() still holds for springs of this stiffness.
    [[nodiscard]] bool is_factorised(double spring) const {
        return factorised_ && (sprung_.empty() || spring == spring_);
    }
    /// K has other values.
    void stiffness_changed() { factorised_ = false; }
    /// Whether this is the body that keeps these nodes, with springs on those.
    [[nodiscard]] bool keeps(const std::vector<Index>& kept, const std::vector<Index>& sprung) const {
        return kept == kept_ && sprung == sprung_;
    }
    /// The same body, not factorised.
    [[nodiscard]] BodyCompliance afresh() const { return {constraints_, first_node_, nodes_, kept_, sprung_}; }
    /// Computes the body's part of x = K^-1 b; b and x span all equations.
    void solve(const double* b, double* x) const { solver_->solve(b + first_, x + first_); }
    /// W, the inverse over equations(): kept x kept, symmetric, m/N.
    [[nodiscard]] const Matrix& W() const { return W_; }
    /// Equations of the kept nodes' free components, ascending.
    [[nodiscard]] const std::vector<Index>& equations() const { return equations_; }

private:
    const Constraints& constraints_;
    Index first_node_, nodes_;
    Index first_ = 0, last_ = 0; ///< the body's equations
    std::vector<Index> kept_, equations_, sprung_;
    double spring_ = 0; ///< of the last factorise()
    bool factorised_ = false;
    std::unique_ptr<solve::CondensingSolver> solver_;
    solve::SparseMatrix K_;
    Matrix W_;
};

} // namespace osculate::linear
