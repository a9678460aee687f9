#pragma once
/// Measures of a solved step that judge() looks at.

#include "osculate/linear/constraints.hpp"
#include "osculate/time/ledger.hpp"
#include "osculate/time/stage.hpp"
#include "osculate/time/step_control.hpp"

namespace osculate::time {

/// Masses that contact forces accelerate, and the directions in which nothing holds their bodies.
struct CentreMasses {
    std::vector<double> mass; ///< (bodies) kg
    std::vector<Eigen::Array<bool, 3, 1>> free;

    CentreMasses(const model::Model& model, const equilibrium::Dynamics& dynamics,
                 const linear::Constraints& constraints, int threads);
};

[[nodiscard]] bool touches(const model::State& state);
/// What the energy of a step in which something touches has risen by beyond external work, of the kinetic and strain energy
/// at its start. Contact may feed it through its own work, and through the integrator: a force that ends with a node's
/// release acts on, in the formulas that take it as linear over the step, along the way that opens the gap.
[[nodiscard]] double energy_from_nowhere(const Ledger& before, const Ledger& after);
/// All energy there has been up to a ledger's state, as far as contact and integrator have not brought it in, J.
[[nodiscard]] double energy_so_far(const Ledger& ledger);
/// StepEvidence::closing_energy: a force at the end of a step has done work along the whole gap that it has closed.
[[nodiscard]] double closing_energy(const Ledger& before, const Ledger& after);
/// StepEvidence::velocity_error, of an energy. From contact forces and not from accelerations: those of a rule that damps
/// nothing alternate for ever after a shock.
[[nodiscard]] double velocity_error(const model::Model& model, const equilibrium::Dynamics& dynamics,
                                    const CentreMasses& masses, const model::ContactEvaluations& contact,
                                    const model::State& from, const model::State& to, double dt, double energy);
/// Largest of Integrator::local_error() over the nodes with mass, free directions, m.
[[nodiscard]] AtNode local_error(const model::Model& model, const equilibrium::Dynamics& dynamics,
                                 const linear::Constraints& constraints, const model::State& from,
                                 const model::State& to, double dt);
/// StepEvidence::unseen.
[[nodiscard]] GapEvidence deepest_unseen(const model::ContactEvaluations& contact);

} // namespace osculate::time
