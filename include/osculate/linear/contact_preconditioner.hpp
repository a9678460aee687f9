#pragma once
/// The step's tangent with slightly softened contact, so that one Cholesky factorisation inverts it.

#include "osculate/linear/penalty_stiffness.hpp"
#include "osculate/linear/soft_contact.hpp"
#include "osculate/linear/unknown_slices.hpp"
#include "osculate/solve/direct_solver.hpp"
#include "osculate/solve/multigrid.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace osculate::linear {

/// Inverse of the tangent with four changes, each small or smooth:
/// - contact forces act on the corners of the closest facet with its shape functions, not on all nodes of the patch;
/// - the change of these forces when the surface bends and rotates is left out;
/// - a soft spring is added to the law, (D + B/gamma) lambda + B w = r with gamma = 10 c, with multigrid c;
/// - in the condensed stiffness K + W^T S B W, S = (D + B/gamma)^-1, the part of S B that couples friction with
///   pressure, the only unsymmetric one, is left out. It is kept when contact forces are computed from displacements.
class ContactPreconditioner {
public:
    /// @param K           stiffness of the bodies in a step; it must outlive this object
    /// @param multigrid   used instead of the factorisation; null: factorise
    /// @param undeformed  stiffness of the undeformed bodies, in the pattern of K: multigrid chooses its grids by it; null: this K
    ContactPreconditioner(const Constraints& constraints, const BlockMatrix& K,
                          std::unique_ptr<solve::Multigrid> multigrid, std::function<BlockMatrix()> undeformed);
    /// Takes over new values of K.
    void stiffness_changed() {
        stiffness_.stiffness_changed();
        changed_ = true;
    }
    /// Uses another matrix of the same pattern instead of K; it must outlive this object.
    void use(const BlockMatrix& K) {
        K_ = &K;
        stiffness_.use(K);
        changed_ = true;
    }
    void keep_pattern() { stiffness_.keep_pattern(); }
    void restore_pattern() { stiffness_.restore_pattern(); }
    [[nodiscard]] std::optional<std::vector<Spring>> kept_pattern() const { return stiffness_.kept_pattern(); }
    void restore_pattern(const std::vector<Spring>& springs) { stiffness_.restore_pattern(springs); }
    /// Factorises for the given contacts, which include every coupling of the pairs.
    [[nodiscard]] solve::FactorStatus factorise(std::vector<SoftContact> contacts);
    /// z = P^-1 r; `rows` gives the numbering of the residual's rows.
    /// @param slices  of which z is wanted, with r filled in; null: there is one process
    void apply(const Unknowns& rows, const ConstVectorRef& r, VectorRef z, UnknownSlices* slices = nullptr) const;
    /// z = P^-T r: r as the unknowns are numbered, z as the rows are.
    void apply_transposed(const Unknowns& rows, const ConstVectorRef& r, VectorRef z) const;
    [[nodiscard]] solve::SparseIndex failing_equation() const { return solver_ ? solver_->failing_equation() : -1; }
    /// Estimate of the time of factorise() over that of an iteration of GMRES with it.
    [[nodiscard]] double effort() const;
    /// What it was last factorised for, by coupling: contacts, S, and the stiffness of the springs, zero where there is none.
    [[nodiscard]] const std::vector<SoftContact>& contacts() const { return contacts_; }
    [[nodiscard]] const Mat3& law_stiffness(std::size_t coupling) const { return S_[coupling]; }
    [[nodiscard]] const Mat3& spring_stiffness(std::size_t coupling) const { return springs_[coupling]; }
    /// Of the condensed stiffness. @pre there is no multigrid
    [[nodiscard]] solve::CondensingSolver& factors() { return *solver_; }

private:
    [[nodiscard]] solve::FactorStatus couple(const std::vector<Spring>& springs);

    const Constraints& constraints_;
    const BlockMatrix *K_, *first_; ///< now, and at first
    std::function<BlockMatrix()> undeformed_;
    bool coarsened_ = false, changed_ = false; ///< of multigrid: whether it has grids, and not the values of K
    std::size_t most_blocks_ = 0;              ///< that couple() has had
    PenaltyStiffness stiffness_;
    std::unique_ptr<solve::CondensingSolver> solver_; ///< one of these two
    std::unique_ptr<solve::Multigrid> multigrid_;
    double softness_; ///< c / gamma
    std::vector<SoftContact> contacts_;
    std::vector<Mat3> S_, springs_;
    mutable Vector load_;
};

} // namespace osculate::linear
