#pragma once
/// A step of an iteration that linearises everything but the laws of contact and friction, and solves these exactly.

#include "osculate/equilibrium/body_term.hpp"
#include "osculate/equilibrium/contact_term.hpp"
#include "osculate/linear/folded_matrix.hpp"
#include "osculate/linear/penalty_stiffness.hpp"
#include "osculate/solve/direct_solver.hpp"

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace osculate::equilibrium {

/// With the bodies' tangent K and, for every slave node j near its master, the linearised motion w_j + A_j du and the forces
/// F_j r_j on slave and masters,
///     K du = -(f(u) - f_ext) + sum F_j r_j,    contact laws of w_j + A_j du and r_j.
/// du is eliminated, and solve::solve_friction() finds the r_j. What the linearisation leaves out, curvature and turning of
/// contact, is smooth: the iteration converges where Newton's method goes round between stick, slip and open.
class FrictionStep {
public:
    /// All arguments must outlive this object.
    FrictionStep(const linear::Constraints& constraints, const linear::Unknowns& unknowns, BodyTerm& bodies,
                 ContactTerm& contact, const linear::Dependence* dependence);

    /// Replaces z, at which the residual was last evaluated, by the solution of this problem.
    /// @param unbalanced  Equilibrium::unbalanced() there
    /// @returns false if K is singular, the problem has no solution, or it is too large for dense matrices
    [[nodiscard]] bool advance(const Iterate& at, const Field& unbalanced, Vector& z);
    /// Number of factorisations of K so far.
    [[nodiscard]] int factorisations() const { return factorisations_; }

private:
    [[nodiscard]] bool factorise(const Iterate& at);
    /// Of all A_j and F_j, in equations.
    struct Couplings {
        Eigen::SparseMatrix<double, Eigen::RowMajor> motion; ///< (3n x equations) A_j du
        Eigen::SparseMatrix<double> load;                    ///< (equations x 3n) F_j r_j
    };
    [[nodiscard]] Couplings couplings(const std::vector<LinearisedContact>& contacts) const;
    /// Calls each(node, moves, loads) for the node and those that it depends on.
    template <class Each> void for_carriers(Index node, Each&& each) const;

    const linear::Constraints& constraints_;
    const linear::Unknowns& unknowns_;
    BodyTerm& bodies_;
    ContactTerm& contact_;
    const linear::Dependence* dependence_;         ///< null: no node depends on others
    std::unique_ptr<linear::FoldedMatrix> folded_; ///< null: no dependent node carries elements
    linear::PenaltyStiffness stiffness_;
    std::unique_ptr<solve::DirectSolver> cholesky_, lu_; ///< null: not used yet
    solve::DirectSolver* solver_ = nullptr;              ///< the one with factors of K
    int factorisations_ = 0;
};

} // namespace osculate::equilibrium
