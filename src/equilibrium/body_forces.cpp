#include "osculate/equilibrium/body_forces.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/field.hpp"
#include "osculate/fe/facet_quadrature.hpp"

#include <algorithm>

namespace osculate::equilibrium {

namespace {

bool damped(const Dynamics& dynamics) {
    return dynamics.mass_damping > 0 || dynamics.stiffness_damping > 0;
}

/// f += C v
void add_damping(const model::Model& model, const Dynamics& dynamics, const Field& v, Field& f, int threads) {
    const double by_M = dynamics.mass_damping, by_K = dynamics.stiffness_damping;
    if (by_M > 0) model.mass(dynamics.lumped_mass).multiply_add(weighted(by_M, v, 0, v), f, threads);
    if (by_K > 0) model.K.multiply_add_relative(weighted(by_K, v, 0, v), f, threads);
}
} // namespace

void add_follower_forces(const std::vector<FollowerLoad>& pressures, const model::Model& model, const Field& u,
                         Field& f) {
    if (pressures.empty()) return;
    const Field x = sum(model.X, u);
    for (const FollowerLoad& load : pressures)
        for (const mesh::SurfaceFace& face : *load.faces) fe::add_pressure_forces(face, x, load.start, f.values());
}

BodyForces::BodyForces(const model::Model& model, const Dynamics* dynamics, bool follower_pressure, int threads)
    : model_(model), dynamics_(dynamics), follower_pressure_(follower_pressure), threads_(threads) {
    if (dynamics_ != nullptr || varies()) tangent_ = model_.K;
    if (varies()) constant_ = model_.K;
    if (dynamics_ == nullptr) return;
    Field sums(model_.X.size());
    mass().multiply_add(Field(model_.X.size(), Vec3::UnitX()), sums, threads_);
    for (const Vec3& row : sums) row_mass_.push_back(row.x());
}

void BodyForces::add_to_tangent(std::function<void(linear::BlockMatrix&)> part, const linear::Dependence& dependence) {
    also_ = std::move(part);
    dependence_ = &dependence;
    tangent_ = constant_ = model_.K;
}

void BodyForces::add_pressures(double factor, bool end, const Field& u, Field& f) const {
    std::vector<FollowerLoad> scaled = pressures_;
    for (FollowerLoad& load : scaled) load.start = factor * (end ? load.end : load.start);
    add_follower_forces(scaled, model_, u, f);
}

bool BodyForces::begin(const model::State& state, std::vector<FollowerLoad> pressures,
                       const std::vector<double>& temperature, double dt) {
    pressures_ = std::move(pressures);
    const model::HistoryPlace last = model::history_place(model_.bodies, model_.bodies.size() - 1);
    require(state.material.size() == last.first + last.size, "the state does not hold the histories of these elements");
    history_start_ = state.material;
    if (!temperature.empty() && nonlinear()) model_.nonlinear->heat(temperature, history_start_);
    if (dynamics_ != nullptr || !history_start_.empty()) u_start_ = state.u;
    if (dynamics_ == nullptr) return false;
    const Integrator& w = dynamics_->integrator;
    v_start_ = state.v;
    a_start_ = state.a;
    const bool changed = dt != dt_ || w != rule_;
    if (changed) {
        dt_ = dt;
        rule_ = w;
        kinematics_ = kinematics(w, dt);
        mean_ = fe::StepMean{1 - w.alpha_f, dynamics_->stiffness_damping / dt};
        const double inertia = (1 - w.alpha_m) * kinematics_.by_u_acceleration, rest = 1 - w.alpha_f,
                     rate = rest * kinematics_.by_u_velocity;
        (varies() ? constant_ : tangent_)
            .set_combination(rest + rate * dynamics_->stiffness_damping, model_.K,
                             inertia + rate * dynamics_->mass_damping, mass());
    }
    const std::size_t n = u_start_.size();
    Field by_M(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 a = kinematics_.acceleration(u_start_[i], u_start_[i], v_start_[i], a_start_[i]);
        by_M[i] = (1 - w.alpha_m) * a + w.alpha_m * a_start_[i];
    }
    force_start_.reset(n);
    mass().multiply_add(by_M, force_start_, threads_);
    model_.K.multiply_add_relative(u_start_, force_start_, threads_);
    if (damped(*dynamics_)) {
        Field mean_v(n);
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 v = kinematics_.velocity(u_start_[i], u_start_[i], v_start_[i], a_start_[i]);
            mean_v[i] = (1 - w.alpha_f) * v + w.alpha_f * v_start_[i];
        }
        add_damping(model_, *dynamics_, mean_v, force_start_, threads_);
    }
    if (follower_pressure_) add_pressures(-w.alpha_f, false, u_start_, force_start_);
    return changed;
}

void BodyForces::add_springs(linear::BlockMatrix& tangent) const {
    for (Index i = 0; i < tangent.rows(); ++i) // nodes of skins have no elements, and empty rows
        if (tangent.row_begin(i) < tangent.row_end(i))
            tangent.block(tangent.slot(i, i)).diagonal().array() +=
                springs_.stiffness * (*springs_.share)[static_cast<std::size_t>(i)];
}

void BodyForces::stabilise(Stabilisation springs) {
    springs_ = std::move(springs);
    if (varies()) return; // linearise() adds them
    tangent_ = model_.K;
    add_springs(tangent_);
}

void BodyForces::release() {
    springs_ = {};
    if (dynamics_ == nullptr && !varies()) tangent_ = {};
}

model::WorstElement BodyForces::evaluate(const Field& u, Field& f) const {
    model::WorstElement worst;
    if (dynamics_ == nullptr) {
        f.reset(u.size());
        model_.K.multiply_add_relative(u, f, threads_);
        if (nonlinear()) worst = model_.nonlinear->add_force(model_.X, step_to(u), f, threads_);
        if (follower_pressure_) add_pressures(-1, true, u, f);
        if (stabilised())
            for (std::size_t i = 0; i < f.size(); ++i)
                f[i] += springs_.stiffness * (*springs_.share)[i] * (u[i] - springs_.anchor[i]);
        return worst;
    }
    f = force_start_;
    if (follower_pressure_) add_pressures(dynamics_->integrator.alpha_f - 1, true, u, f);
    (varies() ? constant_ : tangent_).multiply_add(weighted(1, u, -1, u_start_), f, threads_);
    if (nonlinear()) worst = model_.nonlinear->add_force(model_.X, step_to(u), f, threads_);
    return worst;
}

void BodyForces::add_terms(const Field& u, Field& terms) const {
    const linear::BlockMatrix& A = tangent();
    if (shared()) {
        Field own(terms.size());
        add_own_terms(A, u, own);
        model_.share->replicate(own);
        terms.add(1, own);
    } else {
        add_own_terms(A, u, terms);
    }
}

void BodyForces::add_own_terms(const linear::BlockMatrix& A, const Field& u, Field& terms) const {
    for (Index i = 0; i < A.rows(); ++i) {
        Vec3& sum = terms[static_cast<std::size_t>(i)];
        for (Index k = A.row_begin(i); k < A.row_end(i); ++k)
            sum += A.block(k).cwiseAbs() * u[static_cast<std::size_t>(A.column(k))].cwiseAbs();
        if (dynamics_ != nullptr) sum += force_start_[static_cast<std::size_t>(i)].cwiseAbs();
    }
    // at finite strain stresses come of F = 1 + du/dX: the digits of the 1 are those of offsets between nodes
    for (const model::Body& body : model_.bodies) {
        if (std::ranges::none_of(body.kernels, [](const auto& kernel) { return kernel->finite_strain(); })) continue;
        for (Index i = body.first_node; i < body.first_node + body.nodes(); ++i)
            for (Index k = A.row_begin(i); k < A.row_end(i); ++k) {
                const auto j = static_cast<std::size_t>(A.column(k)), own = static_cast<std::size_t>(i);
                terms[own] += A.block(k).cwiseAbs() * (model_.X[j] - model_.X[own]).cwiseAbs();
            }
    }
}

bool BodyForces::linearise(const Field& u) {
    if (!varies()) return false;
    tangent_ = constant_;
    if (stabilised()) add_springs(tangent_);
    if (nonlinear()) model_.nonlinear->add_tangent(model_.X, step_to(u), tangent_, threads_);
    if (also_) also_(tangent_);
    if (!follower_pressure_) return true;
    const double factor = dynamics_ != nullptr ? dynamics_->integrator.alpha_f - 1 : -1;
    const Field x = sum(model_.X, u);
    for (const FollowerLoad& load : pressures_)
        for (const mesh::SurfaceFace& face : *load.faces) add_pressure_tangent(face, x, factor * load.end);
    return true;
}

void BodyForces::add_pressure_tangent(const mesh::SurfaceFace& face, const Field& x, double pressure) {
    const std::vector<Index> nodes(face.begin(), face.end());
    const Matrix tangent = fe::pressure_tangent(face, x, pressure);
    const Index first = nodes.front(); // a node that carries elements is folded with them
    if (dependence_ == nullptr || !dependence_->depends(first) ||
        !tangent_.has_row(first) || // as its carriers have none
        tangent_.row_end(first) - tangent_.row_begin(first) > 1) {
        tangent_.add(nodes, tangent);
        return;
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) // all of one body, on whose nodes they depend alike
        for (std::size_t j = 0; j < nodes.size(); ++j) {
            const Mat3 block = tangent.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j));
            for (const linear::Dependence::Carrier& row : dependence_->carriers(nodes[i]))
                for (const linear::Dependence::Carrier& column : dependence_->carriers(nodes[j]))
                    tangent_.block(tangent_.slot(row.node, column.node)) += row.loads * block * column.moves;
        }
}

void BodyForces::complete(model::State& state) const {
    if (!history_start_.empty()) state.material = model_.nonlinear->history(model_.X, step_to(state.u), threads_);
    if (dynamics_ == nullptr) return;
    state.v.reset(state.u.size());
    state.a.reset(state.u.size());
    for (std::size_t i = 0; i < state.u.size(); ++i) {
        state.v[i] = kinematics_.velocity(state.u[i], u_start_[i], v_start_[i], a_start_[i]);
        state.a[i] = kinematics_.acceleration(state.u[i], u_start_[i], v_start_[i], a_start_[i]);
    }
}

double BodyForces::inertia(Index node) const {
    return dynamics_ == nullptr ? 0 : mass_factor() * row_mass_[static_cast<std::size_t>(node)];
}

BodyWork BodyForces::work(const model::State& state) const {
    const Integrator& w = dynamics_->integrator;
    const Field Du = weighted(1, state.u, -1, u_start_);
    BodyWork work;
    Field f(Du.size());
    mass().multiply_add(weighted(1 - w.alpha_m, state.a, w.alpha_m, a_start_), f, threads_);
    work.inertia = dot(Du, f);

    f.reset(f.size());
    model_.K.multiply_add_relative(weighted(1 - w.alpha_f, state.u, w.alpha_f, u_start_), f, threads_);
    const auto add_step = [&](double viscosity) {
        model::BodyStep step = step_to(state.u);
        step.mean->viscosity = viscosity;
        (void)model_.nonlinear->add_force(model_.X, step, f, threads_);
    };
    if (nonlinear()) add_step(0);
    work.internal = dot(Du, f);

    if (follower_pressure_) {
        f.reset(f.size());
        add_pressures(1 - w.alpha_f, true, state.u, f);
        add_pressures(w.alpha_f, false, u_start_, f);
        work.follower = dot(Du, f);
    }

    if (!damped(*dynamics_)) return work;
    f.reset(f.size());
    add_damping(model_, *dynamics_, weighted(1 - w.alpha_f, state.v, w.alpha_f, v_start_), f, threads_);
    work.damping = dot(Du, f);
    if (nonlinear() && mean_->viscosity > 0) { // what the viscous stress adds
        f.reset(f.size());
        add_step(mean_->viscosity);
        work.damping += dot(Du, f);
        f.reset(f.size());
        add_step(0);
        work.damping -= dot(Du, f);
    }
    work.stiffness_damping = work.damping;
    if (const double by_M = dynamics_->mass_damping; by_M > 0) {
        f.reset(f.size());
        mass().multiply_add(weighted(1 - w.alpha_f, state.v, w.alpha_f, v_start_), f, threads_);
        work.stiffness_damping -= by_M * dot(Du, f);
    }
    return work;
}

Field BodyForces::outer_forces(const model::State& state) const {
    if (dynamics_ == nullptr && !follower_pressure_) return {};
    Field f(state.u.size());
    if (dynamics_ == nullptr) {
        add_pressures(1, true, state.u, f);
        return f;
    }
    const Integrator& w = dynamics_->integrator;
    if (follower_pressure_) {
        add_pressures(1 - w.alpha_f, true, state.u, f);
        add_pressures(w.alpha_f, false, u_start_, f);
    }
    mass().multiply_add(weighted(w.alpha_m - 1, state.a, -w.alpha_m, a_start_), f, threads_);
    if (const double by_M = dynamics_->mass_damping; by_M > 0)
        mass().multiply_add(weighted(by_M * (w.alpha_f - 1), state.v, -by_M * w.alpha_f, v_start_), f, threads_);
    return f;
}

Field body_forces(const model::Model& model, const Dynamics& dynamics, const model::State& state, int threads) {
    Field f = model::internal_force(model, state.at_rest(), threads);
    add_damping(model, dynamics, state.v, f, threads);
    return f;
}

} // namespace osculate::equilibrium
