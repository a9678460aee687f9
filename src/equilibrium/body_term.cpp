#include "osculate/equilibrium/body_term.hpp"

namespace osculate::equilibrium {

BodyTerm::BodyTerm(const model::Model& model, const Dynamics* dynamics, bool follower_pressure, Timings& timings,
                   int threads)
    : bodies_(model, dynamics, follower_pressure, threads), timings_(timings), threads_(threads),
      nonlinear_(model.nonlinear != nullptr), internal_(model.X.size()) {}

bool BodyTerm::begin(const model::State& state, const Iterate&, const StepLoad& load, double dt) {
    const ScopedTimer timer(timings_, Part::assembly);
    return bodies_.begin(state, load.pressures, load.temperature, dt);
}

bool BodyTerm::evaluate(const Iterate& at) {
    const ScopedTimer timer(timings_, Part::assembly);
    if (!linear_about_.empty())
        for (const Index node : without_elements_) linear_about_[node] = at.u[node];
    linearised_ = !linear_about_.empty() && linear_about_ != at.u;
    const Field& u = linearised_ ? linear_about_ : at.u;
    worst_element_ = bodies_.evaluate(u, internal_);
    if (linearised_ && worst_element_.admissible()) {
        bodies_.linearise(u);
        bodies_.tangent().multiply_add(weighted(1, at.u, -1, u), internal_, threads_);
    }
    if (linearised_ && !without_elements_.empty()) linearised_about_ = linear_about_;
    linear_about_.clear();
    return worst_element_.admissible();
}

void BodyTerm::add_forces(Field& f) const {
    f.add(1, internal_);
}

bool BodyTerm::update_stiffness(const Iterate& at) {
    const ScopedTimer timer(timings_, Part::assembly);
    if (linearised_ && !without_elements_.empty()) return bodies_.linearise(linearised_about_); // others have moved on
    return linearised_ || bodies_.linearise(at.u);
}

void BodyTerm::add_product(const Direction& d, Field& f, VectorRef) {
    if (d.slices != nullptr)
        bodies_.tangent().multiply_add(d.slices->nodes(), d.u, f, threads_);
    else
        bodies_.tangent().multiply_add(d.u, f, threads_);
}

void BodyTerm::add_transposed(const Weights& of, Weights& by) const {
    bodies_.multiply_add_transposed(of.nodes, by.nodes);
}

void BodyTerm::complete(const ConstVectorRef&, model::State& state) const {
    bodies_.complete(state);
}

bool LoadTerm::begin(const model::State&, const Iterate&, const StepLoad& load, double) {
    force_ = load.force;
    return false;
}

void LoadTerm::add_forces(Field& f) const {
    f.add(-1, force_);
}

void LoadTerm::add_magnitudes(const Iterate&, Field& sums) const {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += force_[i].cwiseAbs();
}

} // namespace osculate::equilibrium
