#pragma once
/// The derivative of the residual, and all means to invert it: products, condensed contact, preconditioner, matrix.

#include "osculate/equilibrium/body_term.hpp"
#include "osculate/equilibrium/condensation.hpp"
#include "osculate/equilibrium/contact_term.hpp"
#include "osculate/equilibrium/equilibrium_memory.hpp"
#include "osculate/equilibrium/tangent_choice.hpp"
#include "osculate/linear/contact_preconditioner.hpp"
#include "osculate/linear/folded_matrix.hpp"
#include "osculate/linear/reduced_gmres.hpp"
#include "osculate/solve/kinsol_solver.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace osculate::equilibrium {

class EquilibriumTangent final : public solve::Preconditioner, public solve::Tangent {
public:
    /// @param terms  of the residual, including `bodies` and `contact`; all arguments must outlive this object
    /// @param dependence  what dependent nodes follow; null: there are none
    /// @param at     iterate at which the residual was last evaluated
    EquilibriumTangent(const model::Model& model, const linear::Constraints& constraints,
                       const linear::Unknowns& unknowns, std::span<Term* const> terms, BodyTerm& bodies,
                       ContactTerm& contact, const linear::Dependence* dependence, const Iterate& at,
                       const TangentChoice& choice, Timings& timings, int threads);

    /// Opens an attempt, see BodyForces::mass_factor(); changed: the bodies' stiffness has new values.
    void begin(double mass_factor, bool changed);
    /// To be called when the bodies' stiffness is another matrix object.
    void stiffness_replaced();
    /// Ends an attempt: keeps or discards the growth of patterns during it.
    void commit();
    void rollback();
    /// Data that the last commit() kept for later steps; recall() restores it.
    [[nodiscard]] EquilibriumMemory memory() const;
    void recall(const EquilibriumMemory& memory);
    /// See Condensation; null: there is none.
    [[nodiscard]] std::shared_ptr<const linear::CondensedTangent> kept_condensation() const {
        return condensed_ ? condensed_->kept() : nullptr;
    }
    void go_on_from(const std::shared_ptr<const linear::CondensedTangent>& last) {
        if (condensed_ && last) condensed_->go_on_from(*last);
    }
    [[nodiscard]] long patterns_built() const { return patterns_built_; }

    [[nodiscard]] bool preconditions() const { return preconditioner_ != nullptr; }
    [[nodiscard]] bool by_products() const { return products_; }
    /// Of products and preconditioner; null: there is one process, or none of these.
    [[nodiscard]] Slices* slices() { return slices_.get(); }
    [[nodiscard]] const Slices* slices() const { return slices_.get(); }
    [[nodiscard]] const solve::SparseMatrix& jacobian();

    [[nodiscard]] solve::FactorStatus factorise() override;
    [[nodiscard]] bool lasts() const override { return reduced_ != nullptr; }
    [[nodiscard]] solve::FactorStatus refresh() override;
    void precondition(const ConstVectorRef& r, VectorRef z) override;
    [[nodiscard]] double effort() const override { return preconditioner_->effort(); }
    [[nodiscard]] std::optional<solve::Gmres::Result> solve_with(const ConstVectorRef& b, VectorRef x,
                                                                 double allowed) override;
    [[nodiscard]] solve::SparseIndex failing_equation() const override { return preconditioner_->failing_equation(); }
    void linearise() override;
    /// Where there are slices, of these alone, with x filled in.
    void multiply(const ConstVectorRef& x, VectorRef y) override;
    [[nodiscard]] bool solves() const override {
        return condensed_ && !bodies_.bodies().stabilised() && condensed_->serves(contact_.bearing());
    }
    [[nodiscard]] bool solve(const ConstVectorRef& b, VectorRef x, double allowed) override;
    /// by += J^T of at the last residual, with the rows of held components, too. @pre the bodies' stiffness is symmetric
    void add_transposed(const Weights& of, Weights& by);
    /// Computes the derivatives at the last residual for solve_transposed().
    void linearise_transposed();
    /// Computes w (rows) with J^T w = b to a relative error of `tolerance`, from b of the unknowns; of: w at nodes and couplings.
    /// False where J is singular. @pre preconditions()
    [[nodiscard]] bool solve_transposed(const Weights& b, Vector& w, Weights& of, double tolerance);
    [[nodiscard]] int factorisations() const override { return condensed_ ? condensed_->factorisations() : 0; }

    /// Weights, or values, at nodes and couplings of a vector of rows.
    void unpack_rows(const ConstVectorRef& w, Weights& of) const;

private:
    /// Weights as a vector of unknowns.
    void pack_unknowns(const Weights& by, VectorRef b) const;
    void multiply_transposed(const ConstVectorRef& w, VectorRef b);
    /// solve_transposed() on the nodes of the contact pairs. False where that is not possible.
    [[nodiscard]] bool solve_condensed(const Vector& b, Vector& w, double tolerance);
    /// solve_transposed() by factors of the whole tangent.
    [[nodiscard]] bool solve_transposed_directly(const Vector& b, Vector& w);
    /// Stiffness of the bodies over nodes that have equations.
    [[nodiscard]] const linear::BlockMatrix& stiffness() const;
    /// The same with the rows of all processes.
    [[nodiscard]] const linear::BlockMatrix& whole_stiffness();
    /// Takes over new values of the bodies' stiffness: into what dependent nodes leave of it, into the matrix.
    void fold_stiffness();
    void take_to_matrix();
    void update_stiffness();
    void cover_patterns();
    /// Discards the matrix: it is rebuilt when needed, with the pattern of these couplings.
    void use_pattern(std::vector<linear::Coupling> couplings);

    const linear::Constraints& constraints_;
    const linear::Unknowns& unknowns_;
    std::span<Term* const> terms_;
    BodyTerm& bodies_;
    ContactTerm& contact_;
    const linear::Dependence* dependence_;
    std::unique_ptr<linear::FoldedMatrix> folded_; ///< null: no dependent node carries elements
    const Iterate& at_;
    Timings& timings_;
    bool multigrid_, may_buckle_, products_;                   ///< products_: see TangentChoice
    std::vector<linear::Coupling> couplings_, kept_couplings_; ///< pattern of the matrix: current, at the last commit
    long patterns_built_ = 0, kept_patterns_ = 0;
    std::unique_ptr<linear::BlockMatrix> whole_;   ///< see whole_stiffness(); null: one process, or not needed yet
    std::unique_ptr<linear::SystemMatrix> matrix_; ///< null: not needed yet
    std::unique_ptr<linear::ContactPreconditioner> preconditioner_; ///< see TangentChoice; null: not used
    std::unique_ptr<linear::UnknownSlices> slices_;                 ///< see slices()
    linear::KeptFactors made_for_,
        kept_for_;          ///< the preconditioner's factors: those that serve, those at the last commit
    solve::Wear kept_wear_; ///< at the last commit
    bool in_force_ = false; ///< the preconditioner has the factors of made_for_
    double mass_factor_ = 0;
    std::unique_ptr<linear::ReducedGmres> reduced_;            ///< see TangentChoice; null: not used
    std::unique_ptr<Condensation> condensed_;                  ///< see TangentChoice; null: not used
    bool stale_preconditioner_ = false, stale_matrix_ = false; ///< the stiffness of the bodies has changed since
    Field product_u_, product_f_; ///< scratch of multiply(); with slices, left over where nothing is read
    std::optional<solve::SparseMatrix> transposed_; ///< of linearise_transposed(); none: products of the terms serve
    Weights weights_of_, weights_by_;               ///< scratch of multiply_transposed()
    bool worn_ = true; ///< the preconditioner takes solve_transposed() many iterations, or has no factors
};

} // namespace osculate::equilibrium
