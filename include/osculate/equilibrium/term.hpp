#pragma once
/// One term of the residual: its forces on the left of the equilibrium, and its own rows.

#include "osculate/equilibrium/body_forces.hpp"
#include "osculate/equilibrium/weights.hpp"
#include "osculate/linear/contact_preconditioner.hpp"
#include "osculate/linear/system_matrix.hpp"
#include "osculate/linear/unknown_slices.hpp"
#include "osculate/linear/unknowns.hpp"
#include "osculate/model/model.hpp"

#include <string_view>
#include <vector>

namespace osculate::equilibrium {

/// Loads and motions at the end of the step.
struct StepLoad {
    Field force;                           ///< (nodes) external forces, N
    Field prescribed;                      ///< (nodes) displacement of the held components, local axes, m
    std::vector<FollowerLoad> pressures{}; ///< during this step
    std::vector<double> temperature{};     ///< (nodes) at its end, above that without thermal strain, K; empty: none
};

/// A point of the iteration.
struct Iterate {
    Field u; ///< (nodes) displacements, m
    Field x,
        tail; ///< (nodes) positions and their rounding errors: x + tail = X + u to the last digit of u, m
    const Vector* z = nullptr; ///< all unknowns; null at the start of an attempt
};

/// A direction of motion, and the corresponding change of all unknowns.
struct Direction {
    const Field& u; ///< (nodes) global components; with slices, of one's own, ghosts, and what depends on these
    const ConstVectorRef& z;
    const linear::UnknownSlices* slices = nullptr; ///< whose nodes' forces and rows are wanted; null: those of all
};

/// The residual is a list of terms. Rows of equilibrium are sums of nodal forces over all terms; a term with its own
/// unknowns writes its own rows. Functions that do not apply to a term keep the default.
class Term {
public:
    virtual ~Term() = default;
    [[nodiscard]] virtual std::string_view name() const = 0;

    /// Opens an attempt from its start state. @returns whether derivatives that are constant in a step have changed
    virtual bool begin(const model::State& state, const Iterate& at, const StepLoad& load, double dt) = 0;
    /// Evaluates the term at an iterate. False if it has no value there.
    [[nodiscard]] virtual bool evaluate(const Iterate& at) = 0;
    /// Adds its forces on the left of the equilibrium, (nodes) N.
    virtual void add_forces(Field& f) const = 0;
    /// Writes its own rows of F. @returns a node whose row has no value although the other rows have, -1: none
    [[nodiscard]] virtual Index write_rows(VectorRef F) const {
        (void)F;
        return -1;
    }
    /// Adds the absolute values of the summands of its forces, (nodes) N: the round-off is a few last digits of their
    /// sum.
    virtual void add_magnitudes(const Iterate& at, Field& sums) const = 0;
    /// Whether each of its own rows in F is at most `share` times the sum of the absolute values of its summands, and
    /// these are of a size that leaves the row a meaning.
    /// @param sums  (nodes) those of the forces of all terms, see add_magnitudes(), N
    [[nodiscard]] virtual bool rows_within(const Iterate& at, const Field& sums, const ConstVectorRef& F,
                                           double share) const {
        (void)at, (void)sums, (void)F, (void)share;
        return true;
    }

    /// Computes the derivatives at the last evaluate(), for products.
    virtual void linearise(const Iterate& at) = 0;
    /// Adds the change of its forces along a direction to f, (nodes) N, and writes the change of its own rows into y.
    virtual void add_product(const Direction& d, Field& f, VectorRef y) = 0;
    /// Computes the derivatives at the last evaluate(), for add_transposed().
    virtual void linearise_transposed(const Iterate& at) { linearise(at); }
    /// Adds the products of the transposed derivatives with weights: of its forces, (nodes) in the unit of the weighted sum per N, and
    /// of its own rows; to those of displacements, (nodes) per m, and of contact forces, (couplings) per N.
    virtual void add_transposed(const Weights& of, Weights& by) const { (void)of, (void)by; }
    /// Adds to `couplings`, one for each coupling of the unknowns, the nodes that its derivatives may reach from the
    /// last evaluate(); true if `couplings` already had all of them.
    [[nodiscard]] virtual bool add_pattern(std::vector<linear::Coupling>& couplings) const {
        (void)couplings;
        return true;
    }
    /// Computes its derivatives and adds them to a matrix that contains the bodies' stiffness.
    virtual void add_derivatives(linear::SystemMatrix& matrix) { (void)matrix; }
    /// Adds its data for the preconditioner.
    virtual void add_soft(std::vector<linear::SoftContact>& soft) const { (void)soft; }

    /// Sets its part of the state from the unknowns z.
    virtual void complete(const ConstVectorRef& z, model::State& state) const { (void)z, (void)state; }
};

} // namespace osculate::equilibrium
