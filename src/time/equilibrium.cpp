#include "osculate/time/equilibrium.hpp"

#include "osculate/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::time {

using contact::Status;
using model::Constraints;

namespace {
/// Contacts whose tangents are held as products, some 50 kB each on a smooth master; more go into a matrix.
constexpr Index most_products = 40000;
} // namespace

Equilibrium::Equilibrium(model::Model& model, const Constraints& constraints, const Dynamics* dynamics,
                         Timings& timings, int threads, bool follower_pressure, LinearSolver linear)
    : model_(model), constraints_(constraints), timings_(timings), threads_(threads),
      bodies_(model, dynamics, follower_pressure, threads), first_coupling_{0} {
    std::vector<model::Coupling> couplings;
    for (auto& pair : model.pairs) {
        std::vector<char> held;
        for (const Index node : pair->slaves().node) {
            couplings.push_back({node, {}});
            bool any = false;
            for (int k = 0; k < 3; ++k)
                if (const auto* c = constraints.constraint(node, k)) any = any || !c->symmetry;
            held.push_back(any);
        }
        pair->hold(std::move(held));
        pair->set_inertia(std::vector<double>(static_cast<std::size_t>(pair->size()), 0.0));
        first_coupling_.push_back(static_cast<Index>(couplings.size()));
        lambda_.emplace_back(pair->slaves().node.size(), Vec3::Zero());
        statuses_.emplace_back(pair->slaves().node.size(), Status::open);
    }
    const ScopedTimer timer(timings_, Part::assembly);
    matrix_ = std::make_unique<model::SystemMatrix>(constraints_, bodies_.tangent(), std::move(couplings),
                                                    model::SystemMatrix::Build::when_asked);
    if (model_.finite_strain) matrix_->expect_buckling();
    if (!bodies_.symmetric()) matrix_->expect_unsymmetric();
    kept_couplings_ = matrix_->couplings();
    size_ = matrix_->size();
    if ((!model.pairs.empty() || !bodies_.symmetric()) && linear != LinearSolver::direct)
        preconditioner_ = std::make_unique<ContactPreconditioner>(constraints_, bodies_.tangent());
    products_ = preconditioner_ && !model.pairs.empty() && first_coupling_.back() <= most_products;
    const bool pays = linear == LinearSolver::condensed ||
                      (linear == LinearSolver::automatic && CondensedTangent::cost(model).pays());
    if (!model.pairs.empty() && bodies_.symmetric() && !model.finite_strain && products_ && pays) {
        std::vector<Index> slaves;
        for (const model::Coupling& c : kept_couplings_) slaves.push_back(c.slave);
        condensed_ =
            std::make_unique<CondensedTangent>(model, constraints_, bodies_.tangent(), slaves, dynamics != nullptr);
    }
    const auto n = static_cast<std::size_t>(model.nodes());
    u_.assign(n, Vec3::Zero());
    x_ = internal_ = unbalanced_ = u_;
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
            for (auto& pair : model_.pairs) {
                std::vector<double> inertia;
                for (const Index node : pair->slaves().node) inertia.push_back(bodies_.inertia(node));
                pair->set_inertia(std::move(inertia));
            }
        }
    }
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = model_.X[i] + state.u[i];
    for (std::size_t p = 0; p < model_.pairs.size(); ++p)
        model_.pairs[p]->begin_step(x_, state.contact[p], timings_, threads_);
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
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] = model_.X[i] + u_[i];
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
        const model::ContactTerm& pair = *model_.pairs[p];
        model::ContactHistory history{std::vector<Vec3>(statuses_[p].size()), statuses_[p], pair.facets()};
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
        const model::ContactTerm& pair = *model_.pairs[p];
        auto& list = statuses.emplace_back(static_cast<std::size_t>(pair.size()), Status::open);
        for (Index j = 0; j < pair.size(); ++j)
            if (pair.point(j).found) list[j] = pair.law(j).status(pair.state(j, x_, lambda_[p][j]));
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
    before_z_.swap(last_z_);
    last_z_ = Eigen::Map<const Vector>(z, size_);
    unpack(z);
    if (!evaluate_bodies()) return Verdict::shorten;
    for (auto& pair : model_.pairs) pair->evaluate(x_, timings_, threads_);

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
            if (!model_.pairs[p]->point(j).found) statuses_[p][j] = Status::open;
    force_next_ = false;

    fill(F);
    record(F, status_changes);
    return cycles(records_.back().residual) ? Verdict::stop : Verdict::proceed;
}

void Equilibrium::fill(double* F) {
    const ScopedTimer timer(timings_, Part::assembly);
    for (std::size_t i = 0; i < internal_.size(); ++i) unbalanced_[i] = internal_[i] - load_.force[i];
    Index without_gap = -1; // node
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        const model::ContactTerm& pair = *model_.pairs[p];
        for (Index j = 0; j < pair.size(); ++j) {
            const Vec3& lambda = lambda_[p][j];
            const Index slave = pair.slaves().node[j], coupling = first_coupling_[p] + j;
            unbalanced_[slave] -= lambda;
            const contact::ContactPoint& point = pair.point(j);
            if (point.found)
                for (Index i = 0; i < pair.carriers(j); ++i)
                    unbalanced_[pair.point_nodes(j)[i]] -= pair.master_force(j, i, lambda);
            const auto law = pair.law(j).residual(pair.state(j, x_, lambda), statuses_[p][j]);
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
        line.facet_changes += model_.pairs[p]->facet_changes();
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
    return model_.pairs[p]->point(j).found && (contact::is_closed(statuses_[p][j]) || !lambda_[p][j].isZero(0));
}

void Equilibrium::cover_patches() {
    bool covered = true;
    for (std::size_t p = 0; p < model_.pairs.size() && covered; ++p)
        for (Index j = 0; j < model_.pairs[p]->size() && covered; ++j)
            covered = !reaches(p, j) || matrix_->covers(first_coupling_[p] + j, model_.pairs[p]->point_nodes(j));
    if (covered) return;

    std::vector<model::Coupling> couplings = matrix_->couplings();
    for (std::size_t p = 0; p < model_.pairs.size(); ++p)
        for (Index j = 0; j < model_.pairs[p]->size(); ++j) {
            auto& masters = couplings[static_cast<std::size_t>(first_coupling_[p] + j)].masters;
            if (!reaches(p, j)) continue;
            // room for the point to move about its facet
            masters = model_.pairs[p]->patch_nodes(model_.pairs[p]->facets()[j]);
            const auto& own = model_.pairs[p]->point_nodes(j);
            masters.insert(masters.end(), own.begin(), own.end());
            std::sort(masters.begin(), masters.end());
            masters.erase(std::unique(masters.begin(), masters.end()), masters.end()); // mirror images repeat nodes
        }
    matrix_ = std::make_unique<model::SystemMatrix>(constraints_, bodies_.tangent(), std::move(couplings));
    ++patterns_built_;
}

void Equilibrium::linearise(std::size_t p, Index j, contact::VariationForm form, ContactTangent& tangent) const {
    tangent.variation.form = form;
    const model::ContactTerm& pair = *model_.pairs[p];
    const Vec3& lambda = lambda_[p][j];
    const Status status = statuses_[p][j];
    const auto law = pair.law(j).residual(pair.state(j, x_, lambda), status);
    const Mat3 mirrored = symmetry_directions(pair.slaves().node[j]), kept = Mat3::Identity() - mirrored;
    tangent.D = kept * law.by_lambda + mirrored;
    tangent.reaches = reaches(p, j);
    if (!tangent.reaches) return;
    pair.vary(j, x_, tangent.variation);
    pair.drift_variation(j, x_, tangent.variation, tangent.dd);
    tangent.A.noalias() =
        law.by_gap * tangent.variation.dg + law.by_normal * tangent.variation.dn + law.by_drift * tangent.dd;
    tangent.A = kept * tangent.A;
    tangent.E = -pair.master_force_by_lambda(j); // the forces stand on the right of the equilibrium
    pair.fold(j, tangent.A, tangent.E);
    if (tangent.variation.form != contact::VariationForm::matrices) return;
    pair.master_force_by_y(j, lambda, tangent.variation, tangent.G);
    tangent.G = -tangent.G;
    pair.fold(j, tangent.G);
}

double Equilibrium::least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& pair : model_.pairs) least = std::min(least, pair->least_gap());
    return least;
}

solve::FactorStatus Equilibrium::factorise() {
    if (stale_preconditioner_) preconditioner_->stiffness_changed();
    stale_preconditioner_ = false;
    std::vector<SoftContact> contacts;
    for (std::size_t p = 0; p < model_.pairs.size(); ++p)
        for (Index j = 0; j < model_.pairs[p]->size(); ++j) contacts.push_back(soften(p, j));
    return preconditioner_->factorise(std::move(contacts));
}

SoftContact Equilibrium::soften(std::size_t p, Index j) const {
    const model::ContactTerm& pair = *model_.pairs[p];
    SoftContact soft;
    const auto law = pair.law(j).residual(pair.state(j, x_, lambda_[p][j]), statuses_[p][j]);
    const Index slave = pair.slaves().node[j];
    const Mat3 mirrored = symmetry_directions(slave), kept = Mat3::Identity() - mirrored;
    soft.coupling = first_coupling_[p] + j;
    soft.where.slave = slave;
    soft.D = kept * law.by_lambda + mirrored;
    soft.c = pair.stiffness(j);
    if (!pair.point(j).found || !contact::is_closed(statuses_[p][j])) return soft;
    soft.normal = pair.point(j).normal;
    soft.B = kept * (law.by_gap * soft.normal.transpose() + law.by_drift);
    pair.follow_master(j, soft.where.masters, soft.where.follow);
    return soft;
}

void Equilibrium::precondition(const double* r, double* z) {
    preconditioner_->apply(*matrix_, r, z);
}

void Equilibrium::linearise_bodies() {
    const ScopedTimer timer(timings_, Part::assembly);
    if (linearised_ || bodies_.linearise(u_)) stale_preconditioner_ = stale_matrix_ = true;
}

void Equilibrium::linearise() {
    linearise_bodies();
    const ScopedTimer timer(timings_, Part::contact);
    tangents_.resize(static_cast<std::size_t>(first_coupling_.back()));
    open_laws_.assign(tangents_.size(), Mat3::Zero());
    bearing_.clear();
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        model::ContactTerm& pair = *model_.pairs[p];
        std::vector<char> reached;
        for (Index j = 0; j < pair.size(); ++j) reached.push_back(reaches(p, j));
        pair.prepare_variations(x_, reached, threads_);
        ContactTangent* own = tangents_.data() + first_coupling_[p];
        parallel_for(threads_, pair.size(), [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j) linearise(p, j, contact::VariationForm::products, own[j]);
        });
        for (Index j = 0; j < pair.size(); ++j)
            if (own[j].reaches)
                bearing_.push_back({&own[j], &pair, j, lambda_[p][j], pair.point_nodes(j), soften(p, j)});
            else
                open_laws_[static_cast<std::size_t>(first_coupling_[p] + j)] = own[j].D;
    }
}

void Equilibrium::multiply(const double* x, double* y) {
    std::vector<Vec3>&u = product_u_, &f = product_f_;
    u.assign(u_.size(), Vec3::Zero());
    f.assign(u_.size(), Vec3::Zero());
    for (Index node = 0; node < model_.nodes(); ++node) {
        Vec3 local = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held) local(k) = x[e];
        u[node] = constraints_.to_global(node, local);
    }
    bodies_.tangent().multiply_add(u, f, threads_);
    const auto moved = [&](Index node) -> const Vec3& { return u[node]; };
    const auto add = [&](Index node, const Vec3& force) { f[node] += force; };
    auto next = bearing_.begin();
    for (Index coupling = 0; coupling < first_coupling_.back(); ++coupling) {
        const Index slave = matrix_->couplings()[coupling].slave;
        const double* force = x + matrix_->multiplier(coupling);
        const Vec3 lambda = constraints_.to_global(slave, Vec3(force[0], force[1], force[2]));
        Vec3 law;
        if (next != bearing_.end() && next->law.coupling == coupling) {
            law = (next++)->multiply(moved, lambda, add);
        } else {
            law = open_laws_[coupling] * lambda;
            f[slave] -= lambda;
        }
        law = constraints_.to_local(slave, law);
        for (int k = 0; k < 3; ++k) y[matrix_->contact_row(coupling, k)] = law(k);
    }
    for (Index node = 0; node < model_.nodes(); ++node) {
        const Vec3 local = constraints_.to_local(node, f[node]);
        for (int k = 0; k < 3; ++k)
            if (const Index row = matrix_->equilibrium_row(node, k); row != Constraints::held) y[row] = local(k);
    }
}

bool Equilibrium::solve(const double* b, double* x, double allowed) {
    // condensation takes for granted that a body's solution balances: where displacements are large and forces small, round-off
    // is in the way, and only the tangent itself tells
    constexpr int most_corrections = 2;
    condensed_->set(bearing_);
    Eigen::Map<Vector> solution(x, size_);
    Vector left = Eigen::Map<const Vector>(b, size_), more(size_), product(size_);
    solution.setZero();
    for (int k = 0; k <= most_corrections; ++k) {
        if (!condensed_->solve(*matrix_, open_laws_, left.data(), more.data(), allowed, timings_)) return false;
        if (!more.allFinite()) return false;
        solution += more;
        const ScopedTimer timer(timings_, Part::solve);
        multiply(x, product.data());
        left = Eigen::Map<const Vector>(b, size_) - product;
        if (left.norm() <= 2 * allowed) return true; // its own measure, and round-off
    }
    return false;
}

const solve::SparseMatrix& Equilibrium::jacobian() {
    linearise_bodies();
    {
        const ScopedTimer timer(timings_, Part::assembly);
        matrix_->build();
        if (stale_matrix_) matrix_->stiffness_changed();
        stale_matrix_ = false;
        if (model_.pairs.empty()) return matrix_->matrix(); // constant without finite strain: factorised once
        cover_patches();
        matrix_->reset();
    }
    constexpr Index batch = 64; // tangents held at a time: each takes some 100 kB on a smooth master
    if (tangents_.size() < batch) tangents_.resize(batch);
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        model::ContactTerm& pair = *model_.pairs[p];
        {
            const ScopedTimer timer(timings_, Part::contact);
            std::vector<char> reached;
            for (Index j = 0; j < pair.size(); ++j) reached.push_back(reaches(p, j));
            pair.prepare_variations(x_, reached, threads_);
        }
        for (Index first = 0; first < pair.size(); first += batch) {
            const Index count = std::min(batch, pair.size() - first);
            {
                const ScopedTimer timer(timings_, Part::contact);
                parallel_for(threads_, count, [&](Index begin, Index end) {
                    for (Index k = begin; k < end; ++k)
                        linearise(p, first + k, contact::VariationForm::matrices, tangents_[k]);
                });
            }
            const ScopedTimer timer(timings_, Part::assembly);
            parallel_lanes(threads_, [&](Lane lane) { // each the rows of its own nodes, in the order of the slaves
                for (Index k = 0; k < count; ++k) {
                    const ContactTangent& t = tangents_[k];
                    const Index j = first + k, coupling = first_coupling_[p] + j;
                    if (t.reaches)
                        matrix_->add_contact(coupling, pair.point_nodes(j), t.A, t.D, t.E, t.G, lane);
                    else
                        matrix_->add_contact(coupling, t.D, lane);
                }
            });
        }
    }
    matrix_->finish();
    return matrix_->matrix();
}

} // namespace osculate::time
