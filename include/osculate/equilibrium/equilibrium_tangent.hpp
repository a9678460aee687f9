#pragma once
/// The derivative of the residual, and what inverts it: products, condensed contact, preconditioner, matrix.

#include "osculate/equilibrium/body_term.hpp"
#include "osculate/equilibrium/contact_term.hpp"
#include "osculate/equilibrium/equilibrium_memory.hpp"
#include "osculate/equilibrium/tangent_choice.hpp"
#include "osculate/linear/condensed_tangent.hpp"
#include "osculate/linear/contact_preconditioner.hpp"
#include "osculate/solve/kinsol_solver.hpp"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace osculate::equilibrium {

class EquilibriumTangent final : public solve::Preconditioner, public solve::Tangent {
public:
    /// @param terms  of the residual, `bodies` and `contact` among them; all of it must outlive this object
    /// @param at     where the residual was evaluated last
    EquilibriumTangent(const model::Model& model, const linear::Constraints& constraints,
                       const linear::Unknowns& unknowns, std::span<Term* const> terms, BodyTerm& bodies,
                       ContactTerm& contact, const Iterate& at, const TangentChoice& choice, Timings& timings,
                       int threads);

    /// Opens an attempt over dt (0 in statics); changed: the bodies' stiffness has other values.
    void begin(double dt, bool changed);
    /// The bodies have another stiffness matrix, or another one again.
    void stiffness_replaced();
    /// Ends an attempt: patterns that grew in it stay, or go back to what they were.
    void commit();
    void rollback();
    /// What the last commit() left for later steps, and the same as if it had left that.
    [[nodiscard]] EquilibriumMemory memory() const;
    void recall(const EquilibriumMemory& memory);
    [[nodiscard]] long patterns_built() const { return patterns_built_; }

    [[nodiscard]] bool preconditions() const { return preconditioner_ != nullptr; }
    [[nodiscard]] bool by_products() const { return products_; }
    [[nodiscard]] const solve::SparseMatrix& jacobian();

    [[nodiscard]] solve::FactorStatus factorise() override;
    void precondition(const ConstVectorRef& r, VectorRef z) override;
    [[nodiscard]] solve::SparseIndex failing_equation() const override { return preconditioner_->failing_equation(); }
    void linearise() override;
    void multiply(const ConstVectorRef& x, VectorRef y) override;
    [[nodiscard]] bool solves() const override { return condensed_ && !bodies_.bodies().stabilised(); }
    [[nodiscard]] bool solve(const ConstVectorRef& b, VectorRef x, double allowed) override;
    [[nodiscard]] int factorisations() const override { return condensed_ ? condensed_->factorisations() : 0; }

private:
    void update_stiffness();
    void cover_patterns();
    /// Forgets the matrix: it is made anew when asked for, by the pattern of these couplings.
    void use_pattern(std::vector<linear::Coupling> couplings);

    const linear::Constraints& constraints_;
    const linear::Unknowns& unknowns_;
    std::span<Term* const> terms_;
    BodyTerm& bodies_;
    ContactTerm& contact_;
    const Iterate& at_;
    Timings& timings_;
    bool may_buckle_, products_;                               ///< products_: see TangentChoice
    std::vector<linear::Coupling> couplings_, kept_couplings_; ///< pattern of the matrix; at the last commit
    long patterns_built_ = 0, kept_patterns_ = 0;
    std::unique_ptr<linear::SystemMatrix> matrix_;                  ///< null: not asked for yet
    std::unique_ptr<linear::ContactPreconditioner> preconditioner_; ///< none where the tangent is symmetric
    std::unique_ptr<linear::CondensedTangent> condensed_;           ///< where bodies are linear
    bool stale_preconditioner_ = false, stale_matrix_ = false;      ///< the stiffness of the bodies has moved on
    Field product_u_, product_f_;                                   ///< scratch of multiply()
};

} // namespace osculate::equilibrium
