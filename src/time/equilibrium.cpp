#include "osculate/time/equilibrium.hpp"

#include "osculate/core/parallel.hpp"
#include "osculate/model/nodal_unknowns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::time {

using contact::Status;
using model::Constraints;

Equilibrium::Equilibrium(const model::Model& model, const Constraints& constraints, const Dynamics* dynamics,
                         Timings& timings, int threads, bool follower_pressure, LinearSolver linear)
    : model_(model), constraints_(constraints), timings_(timings), threads_(threads), linear_(linear),
      bodies_(model, dynamics, follower_pressure, threads),
      contact_(model::contact_evaluations(model)), first_coupling_{0} {
    std::vector<model::Coupling> couplings;
    for (model::ContactEvaluation& evaluation : contact_) {
        const model::ContactPair& pair = evaluation.pair();
        std::vector<char> held;
        for (const Index node : pair.slaves().node) {
            couplings.push_back({node, {}});
            bool any = false;
            for (int k = 0; k < 3; ++k)
                if (const auto* c = constraints.constraint(node, k)) any = any || !c->symmetry;
            held.push_back(any);
        }
        evaluation.hold(std::move(held));
        first_coupling_.push_back(static_cast<Index>(couplings.size()));
        lambda_.emplace_back(pair.slaves().node.size(), Vec3::Zero());
        statuses_.emplace_back(pair.slaves().node.size(), Status::open);
    }
    const ScopedTimer timer(timings_, Part::assembly);
    matrix_ = std::make_unique<model::SystemMatrix>(constraints_, bodies_.tangent(), std::move(couplings),
                                                    model::SystemMatrix::Build::when_asked);
    if (model_.finite_strain) matrix_->expect_buckling();
    if (!bodies_.symmetric()) matrix_->expect_unsymmetric();
    kept_couplings_ = matrix_->couplings();
    size_ = matrix_->size();
    if (goes_by_multigrid(model, linear))
        preconditioner_ = std::make_unique<ContactPreconditioner>(
            model, constraints_, bodies_.tangent(), solve::make_multigrid(model::nodal_unknowns(model, constraints_)),
            threads);
    else if ((!model.pairs.empty() || !bodies_.symmetric()) && linear != LinearSolver::direct)
        preconditioner_ =
            std::make_unique<ContactPreconditioner>(model, constraints_, bodies_.tangent(), nullptr, threads);
    products_ = goes_by_products(model, linear);
    if (condenses(model, linear, follower_pressure)) {
        std::vector<Index> slaves;
        for (const model::Coupling& c : kept_couplings_) slaves.push_back(c.slave);
        condensed_ = std::make_unique<CondensedTangent>(model, constraints_, bodies_.tangent(), slaves,
                                                        dynamics != nullptr, threads_);
    }
    const auto n = static_cast<std::size_t>(model.nodes());
    u_.assign(n, Vec3::Zero());
    x_ = internal_ = unbalanced_ = tail_ = u_;
}

void Equilibrium::begin_attempt(const model::State& state, StepLoad load, double dt) {
    load_ = std::move(load);
    {
        const ScopedTimer timer(timings_, Part::assembly);
        const bool changed = bodies_.begin(state, load_.pressures, dt);
        if (condensed_) condensed_->begin(bodies_.dynamic() ? dt : 0, changed);
        if (changed) {
            matrix_->stiffness_changed();
            if (preconditioner_) preconditioner_->stiffness_changed();
            for (model::ContactEvaluation& evaluation : contact_) {
                std::vector<double> inertia;
                for (const Index node : evaluation.pair().slaves().node) inertia.push_back(bodies_.inertia(node));
                evaluation.set_inertia(std::move(inertia));
            }
        }
    }
    u_ = state.u;
    place();
    for (std::size_t p = 0; p < contact_.size(); ++p)
        contact_[p].begin_step(x_, state.contact[p], timings_, threads_, tail_);
    records_.clear();
    recent_statuses_.clear();
    visits_.clear();
    best_ = std::numeric_limits<double>::max();
    idle_ = 0;
    last_configuration_ = 0;
}

void Equilibrium::commit() {
    if (kept_patterns_ != patterns_built_) kept_couplings_ = matrix_->couplings();
    kept_patterns_ = patterns_built_;
    if (preconditioner_) preconditioner_->keep_pattern();
    if (condensed_) condensed_->keep();
}

void Equilibrium::rollback() {
    const ScopedTimer timer(timings_, Part::assembly);
    if (kept_patterns_ != patterns_built_) {
        matrix_ = std::make_unique<model::SystemMatrix>(constraints_, bodies_.tangent(), kept_couplings_,
                                                        model::SystemMatrix::Build::when_asked);
        kept_patterns_ = ++patterns_built_;
    }
    if (preconditioner_) preconditioner_->restore_pattern();
    if (condensed_) condensed_->restore();
}

EquilibriumMemory Equilibrium::memory() const {
    EquilibriumMemory memory;
    if (kept_patterns_ > 0) memory.couplings = kept_couplings_;
    if (preconditioner_) memory.springs = preconditioner_->kept_pattern();
    if (condensed_ && condensed_->kept() != nullptr) memory.laws = *condensed_->kept();
    return memory;
}

void Equilibrium::recall(const EquilibriumMemory& memory) {
    if (!memory.couplings.empty()) {
        kept_couplings_ = memory.couplings;
        matrix_ = std::make_unique<model::SystemMatrix>(constraints_, bodies_.tangent(), kept_couplings_,
                                                        model::SystemMatrix::Build::when_asked);
        kept_patterns_ = ++patterns_built_;
    }
    if (preconditioner_ && memory.springs) preconditioner_->restore_pattern(*memory.springs);
    if (condensed_ && memory.laws) condensed_->restore(*memory.laws);
}

void Equilibrium::set_statuses(std::vector<std::vector<Status>> statuses, StatusRule rule, bool force_first) {
    statuses_ = std::move(statuses);
    rule_ = rule;
    force_next_ = force_first;
    visits_.clear();
    best_ = std::numeric_limits<double>::max();
    idle_ = 0;
}

void Equilibrium::stabilise(Stabilisation springs) {
    const ScopedTimer timer(timings_, Part::assembly);
    bodies_.stabilise(std::move(springs));
    matrix_->use(bodies_.tangent());
    if (preconditioner_) preconditioner_->use(bodies_.tangent());
}

void Equilibrium::release() {
    if (!bodies_.stabilised()) return;
    const ScopedTimer timer(timings_, Part::assembly);
    bodies_.release();
    matrix_->use(bodies_.tangent());
    if (preconditioner_) preconditioner_->use(bodies_.tangent());
}

void Equilibrium::unpack(const double* z) {
    constraints_.scatter(z, load_.prescribed, u_);
    place();
    for (std::size_t p = 0; p < model_.pairs.size(); ++p)
        for (Index j = 0; j < model_.pairs[p]->size(); ++j) {
            const double* force = z + matrix_->multiplier(first_coupling_[p] + j);
            lambda_[p][j] =
                constraints_.to_global(model_.pairs[p]->slaves().node[j], Vec3(force[0], force[1], force[2]));
        }
}

Vector Equilibrium::unknowns(const std::vector<Vec3>& u, const std::vector<model::ContactHistory>& contact) const {
    Vector z(size_);
    constraints_.gather(u, z.data());
    for (std::size_t p = 0; p < model_.pairs.size(); ++p)
        for (Index j = 0; j < model_.pairs[p]->size(); ++j)
            z.segment<3>(matrix_->multiplier(first_coupling_[p] + j)) =
                constraints_.to_local(model_.pairs[p]->slaves().node[j], contact[p].lambda[j]);
    return z;
}

std::vector<Vec3> Equilibrium::displacements(const Vector& z) const {
    std::vector<Vec3> u(u_.size(), Vec3::Zero());
    constraints_.scatter(z.data(), load_.prescribed, u);
    return u;
}

model::State Equilibrium::state(const Vector& z) const {
    model::State state;
    state.u = displacements(z);
    bodies_.complete(state);
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        const model::ContactEvaluation& evaluation = contact_[p];
        const model::ContactPair& pair = evaluation.pair();
        model::ContactHistory history{std::vector<Vec3>(statuses_[p].size()), statuses_[p], evaluation.facets(),
                                      evaluation.master()};
        for (Index j = 0; j < pair.size(); ++j) {
            const Vec3 local = z.segment<3>(matrix_->multiplier(first_coupling_[p] + j));
            history.lambda[j] = constraints_.to_global(pair.slaves().node[j], local);
            // open nodes carry nothing: what is left is the solver's round-off
            if (statuses_[p][j] == Status::open) history.lambda[j].setZero();
        }
        state.contact.push_back(std::move(history));
    }
    return state;
}

std::vector<std::vector<Status>> Equilibrium::natural_statuses() const {
    std::vector<std::vector<Status>> statuses;
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        const model::ContactEvaluation& evaluation = contact_[p];
        const model::ContactPair& pair = evaluation.pair();
        auto& list = statuses.emplace_back(static_cast<std::size_t>(pair.size()), Status::open);
        for (Index j = 0; j < pair.size(); ++j)
            if (evaluation.point(j).found) list[j] = evaluation.law(j).status(evaluation.state(j, lambda_[p][j]));
    }
    return statuses;
}

Mat3 Equilibrium::symmetry_directions(Index node) const {
    Mat3 sum = Mat3::Zero();
    for (int k = 0; k < 3; ++k)
        if (const auto* c = constraints_.constraint(node, k); c != nullptr && c->symmetry) {
            const Vec3 e = constraints_.frame(node).col(k);
            sum += e * e.transpose();
        }
    return sum;
}

void Equilibrium::linearise_first_about(const std::vector<Vec3>& u) {
    if (model_.finite_strain) linear_about_ = u;
}

bool Equilibrium::evaluate_bodies() {
    const ScopedTimer timer(timings_, Part::assembly);
    linearised_ = !linear_about_.empty() && linear_about_ != u_;
    const std::vector<Vec3>& at = linearised_ ? linear_about_ : u_;
    worst_element_ = bodies_.evaluate(at, internal_);
    if (linearised_ && worst_element_.admissible()) {
        bodies_.linearise(at);
        std::vector<Vec3> rest(u_.size());
        for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = u_[i] - at[i];
        bodies_.tangent().multiply_add(rest, internal_, threads_);
    }
    linear_about_.clear();
    return worst_element_.admissible();
}

solve::NonlinearProblem::Verdict Equilibrium::residual(const double* z, double* F) {
    rests_ = false;
    before_z_.swap(last_z_);
    last_z_ = Eigen::Map<const Vector>(z, size_);
    unpack(z);
    if (!evaluate_bodies()) return Verdict::shorten;
    for (model::ContactEvaluation& evaluation : contact_) evaluation.evaluate(x_, timings_, threads_, tail_);

    int status_changes = 0;
    if (rule_ == StatusRule::natural && !force_next_) {
        auto statuses = natural_statuses();
        for (std::size_t p = 0; p < statuses.size(); ++p)
            for (std::size_t j = 0; j < statuses[p].size(); ++j) status_changes += statuses[p][j] != statuses_[p][j];
        statuses_ = std::move(statuses);
    }
    // a status that was imposed cannot hold where there is no contact partner
    for (std::size_t p = 0; p < statuses_.size(); ++p)
        for (Index j = 0; j < model_.pairs[p]->size(); ++j)
            if (!contact_[p].point(j).found) statuses_[p][j] = Status::open;
    force_next_ = false;

    fill(F);
    record(F, status_changes);
    constexpr int at_rest = 3; // iterates that have gained nothing: Newton would have
    const bool round = cycles(records_.back().residual);
    rests_ = (round || idle_ >= at_rest) && at_round_off(F);
    return round || rests_ ? Verdict::stop : Verdict::proceed;
}

void Equilibrium::fill(double* F) {
    const ScopedTimer timer(timings_, Part::assembly);
    for (std::size_t i = 0; i < internal_.size(); ++i) unbalanced_[i] = internal_[i] - load_.force[i];
    Index without_gap = -1; // node
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        const model::ContactEvaluation& evaluation = contact_[p];
        const model::ContactPair& pair = evaluation.pair();
        for (Index j = 0; j < pair.size(); ++j) {
            const Vec3& lambda = lambda_[p][j];
            const Index slave = pair.slaves().node[j], coupling = first_coupling_[p] + j;
            const contact::ContactPoint& point = evaluation.point(j);
            evaluation.for_each_force(j, lambda, [&](Index node, const Vec3& force) { unbalanced_[node] -= force; });
            const auto law = evaluation.law(j).residual(evaluation.state(j, lambda_[p][j]), statuses_[p][j]);
            const Mat3 mirrored = symmetry_directions(slave);
            const Vec3 value = constraints_.to_local(slave, Vec3(law.value - mirrored * law.value + mirrored * lambda));
            for (int k = 0; k < 3; ++k) F[matrix_->contact_row(coupling, k)] = value(k);
            if (point.found && !(std::isfinite(point.gap) && point.normal.allFinite())) {
                // it counts as open, and the law of an open node does not ask for its gap
                F[matrix_->contact_row(coupling, 0)] = std::numeric_limits<double>::quiet_NaN();
                without_gap = slave;
            }
        }
    }
    double worst = -1;
    for (Index node = 0; node < model_.nodes(); ++node) {
        const Vec3 local = constraints_.to_local(node, unbalanced_[node]);
        for (int k = 0; k < 3; ++k)
            if (const Index row = matrix_->equilibrium_row(node, k); row != Constraints::held) {
                F[row] = local(k);
                if (std::abs(local(k)) > worst) {
                    worst = std::abs(local(k));
                    worst_node_ = node;
                }
            }
    }
    if (without_gap >= 0) worst_node_ = without_gap;
}

void Equilibrium::record(const double* F, int status_changes) {
    IterationRecord line;
    line.iteration = static_cast<int>(records_.size());
    line.residual = Eigen::Map<const Vector>(F, size_).norm() / reference_force_;
    line.status_changes = status_changes;
    for (std::size_t p = 0; p < statuses_.size(); ++p) {
        for (const Status status : statuses_[p]) {
            line.open += status == Status::open;
            line.stick += status == Status::stick;
            line.slip += status == Status::slip || status == Status::glide;
        }
        line.facet_changes += contact_[p].facet_changes();
    }
    records_.push_back(line);
    constexpr std::size_t most_remembered = 8;
    if (!recent_statuses_.empty() && recent_statuses_.back() == statuses_) return;
    if (recent_statuses_.size() == most_remembered) recent_statuses_.erase(recent_statuses_.begin());
    recent_statuses_.push_back(statuses_);
}

bool Equilibrium::cycles(double residual) {
    // in the slip branch Newton can also alternate with all statuses at rest
    constexpr int patience = 8;
    idle_ = residual < 0.99 * best_ ? 0 : idle_ + 1;
    best_ = std::min(best_, residual);
    if (idle_ >= patience) return true;
    // the iteration goes round when it comes back to a contact configuration it has left, for the second time and
    // without having gained anything
    std::size_t configuration = 1469598103934665603ULL;
    const auto mix = [&](std::size_t value) { configuration = (configuration ^ value) * 1099511628211ULL; };
    for (std::size_t p = 0; p < statuses_.size(); ++p)
        for (std::size_t j = 0; j < statuses_[p].size(); ++j) mix(static_cast<std::size_t>(statuses_[p][j]) + 1);
    auto& [times, least] = visits_.try_emplace(configuration, 0, residual).first->second;
    bool round = false;
    if (configuration != last_configuration_ && times > 0) {
        round = times > 1 && residual > 0.5 * least;
        ++times;
    } else if (times == 0) {
        times = 1;
    }
    least = std::min(least, residual);
    last_configuration_ = configuration;
    return round;
}

bool Equilibrium::reaches(std::size_t p, Index j) const {
    return contact_[p].point(j).found && (contact::is_closed(statuses_[p][j]) || !lambda_[p][j].isZero(0));
}

double Equilibrium::least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const model::ContactEvaluation& evaluation : contact_) least = std::min(least, evaluation.least_gap());
    return least;
}

} // namespace osculate::time
