#include "osculate/equilibrium/body_term.hpp"

namespace osculate::equilibrium {

BodyTerm::BodyTerm(const model::Model& model, const Dynamics* dynamics, bool follower_pressure, Timings& timings,
                   int threads)
    : bodies_(model, dynamics, follower_pressure, threads), timings_(timings), threads_(threads),
      finite_strain_(model.finite_strain != nullptr), internal_(model.X.size(), Vec3::Zero()) {}

bool BodyTerm::begin(const model::State& state, const Iterate&, const StepLoad& load, double dt) {
    const ScopedTimer timer(timings_, Part::assembly);
    return bodies_.begin(state, load.pressures, dt);
}

bool BodyTerm::evaluate(const Iterate& at) {
    const ScopedTimer timer(timings_, Part::assembly);
    linearised_ = !linear_about_.empty() && linear_about_ != at.u;
    const std::vector<Vec3>& u = linearised_ ? linear_about_ : at.u;
    worst_element_ = bodies_.evaluate(u, internal_);
    if (linearised_ && worst_element_.admissible()) {
        bodies_.linearise(u);
        std::vector<Vec3> rest(u.size());
        for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = at.u[i] - u[i];
        bodies_.tangent().multiply_add(rest, internal_, threads_);
    }
    linear_about_.clear();
    return worst_element_.admissible();
}

void BodyTerm::add_forces(std::vector<Vec3>& f) const {
    for (std::size_t i = 0; i < f.size(); ++i) f[i] += internal_[i];
}

bool BodyTerm::update_stiffness(const Iterate& at) {
    const ScopedTimer timer(timings_, Part::assembly);
    return linearised_ || bodies_.linearise(at.u);
}

void BodyTerm::add_product(const Direction& d, std::vector<Vec3>& f, double*) {
    bodies_.tangent().multiply_add(d.u, f, threads_);
}

void BodyTerm::complete(const double*, model::State& state) const {
    bodies_.complete(state);
}

bool LoadTerm::begin(const model::State&, const Iterate&, const StepLoad& load, double) {
    force_ = load.force;
    return false;
}

void LoadTerm::add_forces(std::vector<Vec3>& f) const {
    for (std::size_t i = 0; i < f.size(); ++i) f[i] -= force_[i];
}

void LoadTerm::add_magnitudes(const Iterate&, std::vector<Vec3>& sums) const {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += force_[i].cwiseAbs();
}

} // namespace osculate::equilibrium
