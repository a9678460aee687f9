#pragma once
/// BodyForces and dead loads as terms of the residual.

#include "osculate/core/timing.hpp"
#include "osculate/equilibrium/term.hpp"

namespace osculate::equilibrium {

/// Inertia, damping, internal forces and follower pressures of all bodies. The other terms add their derivatives to its
/// matrix.
class BodyTerm final : public Term {
public:
    BodyTerm(const model::Model& model, const Dynamics* dynamics, bool follower_pressure, Timings& timings,
             int threads);

    /// Makes the next evaluate() linear in the displacements about u, (nodes) m. No effect without nonlinear elements.
    void linearise_next_about(const Field& u) {
        if (nonlinear_) linear_about_ = u;
    }
    /// Nodes that carry no elements: linearise_next_about() takes them where they are.
    void set_without_elements(std::vector<Index> nodes) { without_elements_ = std::move(nodes); }
    [[nodiscard]] BodyForces& bodies() { return bodies_; }
    [[nodiscard]] const BodyForces& bodies() const { return bodies_; }
    /// Forces at the last evaluate(), (nodes) N.
    [[nodiscard]] const Field& internal_force() const { return internal_; }
    /// Element with the least det F there; if this is not positive, evaluate() returned false.
    [[nodiscard]] const model::WorstElement& worst_element() const { return worst_element_; }
    /// Updates the stiffness to the last evaluate(); true if its values changed.
    bool update_stiffness(const Iterate& at);

    [[nodiscard]] std::string_view name() const override { return "bodies"; }
    bool begin(const model::State& state, const Iterate& at, const StepLoad& load, double dt) override;
    [[nodiscard]] bool evaluate(const Iterate& at) override;
    void add_forces(Field& f) const override;
    void add_magnitudes(const Iterate& at, Field& sums) const override { bodies_.add_terms(at.u, sums); }
    void linearise(const Iterate& at) override { (void)update_stiffness(at); }
    void add_product(const Direction& d, Field& f, VectorRef y) override;
    /// @pre its stiffness is symmetric
    void add_transposed(const Weights& of, Weights& by) const override;
    void complete(const ConstVectorRef& z, model::State& state) const override;

private:
    BodyForces bodies_;
    Timings& timings_;
    int threads_;
    bool nonlinear_;
    Field internal_;
    Field linear_about_;     ///< for the next evaluate(); empty: exact
    Field linearised_about_; ///< of the last evaluate(), if other terms add to the tangent
    std::vector<Index> without_elements_;
    bool linearised_ = false; ///< whether the last evaluate() was linear; the stiffness then belongs to it
    model::WorstElement worst_element_;
};

/// Dead loads.
class LoadTerm final : public Term {
public:
    /// The loads; in dynamics their mean over the step, (nodes) N.
    [[nodiscard]] const Field& force() const { return force_; }

    [[nodiscard]] std::string_view name() const override { return "loads"; }
    bool begin(const model::State& state, const Iterate& at, const StepLoad& load, double dt) override;
    [[nodiscard]] bool evaluate(const Iterate&) override { return true; }
    void add_forces(Field& f) const override;
    void add_magnitudes(const Iterate& at, Field& sums) const override;
    void linearise(const Iterate&) override {}
    void add_product(const Direction&, Field&, VectorRef) override {}

private:
    Field force_;
};

} // namespace osculate::equilibrium
