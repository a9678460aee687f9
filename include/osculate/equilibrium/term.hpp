#pragma once
/// One term of the residual: what there is on the left of the equilibrium, and rows of its own.

#include "osculate/equilibrium/body_forces.hpp"
#include "osculate/linear/contact_preconditioner.hpp"
#include "osculate/linear/system_matrix.hpp"
#include "osculate/linear/unknowns.hpp"
#include "osculate/model/model.hpp"

#include <string_view>
#include <vector>

namespace osculate::equilibrium {

/// Loads and motions at the end of the step.
struct StepLoad {
    Field force;                           ///< (nodes) external forces, N
    Field prescribed;                      ///< (nodes) displacement of the held components, local axes, m
    std::vector<FollowerLoad> pressures{}; ///< of this step
};

/// A point of the iteration.
struct Iterate {
    Field u; ///< (nodes) displacements, m
    Field x,
        tail; ///< (nodes) positions and the digits they lack: x + tail = X + u to the last digit of u, m
    const Vector* z = nullptr; ///< all unknowns; null at the start of an attempt
};

/// A motion, and all unknowns that belong to it.
struct Direction {
    const Field& u; ///< (nodes) global components
    const ConstVectorRef& z;
};

/// The residual is a list of these. Rows of equilibrium are sums of nodal forces over all terms; a term with unknowns of its
/// own writes its own rows. What there is nothing of keeps the default.
class Term {
public:
    virtual ~Term() = default;
    [[nodiscard]] virtual std::string_view name() const = 0;

    /// Opens an attempt at the state it starts from. @returns whether derivatives that last for a step have changed
    virtual bool begin(const model::State& state, const Iterate& at, const StepLoad& load, double dt) = 0;
    /// Takes the term to an iterate. False where it has no value there.
    [[nodiscard]] virtual bool evaluate(const Iterate& at) = 0;
    /// Adds its forces on the left of the equilibrium, (nodes) N.
    virtual void add_forces(Field& f) const = 0;
    /// Writes its own rows of F. @returns a node whose row has no value though the rest has, -1: none
    [[nodiscard]] virtual Index write_rows(VectorRef F) const {
        (void)F;
        return -1;
    }
    /// Adds the absolute values of what its forces are summed up from, (nodes) N: their round-off is some last digits of that.
    virtual void add_magnitudes(const Iterate& at, Field& sums) const = 0;
    /// Whether no row of its own in F is more than such a `share` of what it is the sum of.
    [[nodiscard]] virtual bool rows_within(const Iterate& at, const ConstVectorRef& F, double share) const {
        (void)at, (void)F, (void)share;
        return true;
    }

    /// Takes the derivatives at the last evaluate(), for products.
    virtual void linearise(const Iterate& at) = 0;
    /// Adds the change of its forces along a direction to f, (nodes) N, and writes that of its own rows into y.
    virtual void add_product(const Direction& d, Field& f, VectorRef y) = 0;
    /// Lists in `couplings`, one for each coupling of the unknowns, the nodes its derivatives may reach from the last
    /// evaluate(); true where all have been there.
    [[nodiscard]] virtual bool add_pattern(std::vector<linear::Coupling>& couplings) const {
        (void)couplings;
        return true;
    }
    /// Adds its derivatives, taken anew, to a matrix that has the bodies' stiffness.
    virtual void add_derivatives(linear::SystemMatrix& matrix) { (void)matrix; }
    /// Adds what the preconditioner is to know of it.
    virtual void add_soft(std::vector<linear::SoftContact>& soft) const { (void)soft; }

    /// Its part of the state at the unknowns z.
    virtual void complete(const ConstVectorRef& z, model::State& state) const { (void)z, (void)state; }
};

} // namespace osculate::equilibrium
