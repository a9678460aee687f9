#include "osculate/equilibrium/equilibrium.hpp"

#include "osculate/core/rounded_sum.hpp"

#include <cmath>
#include <limits>

namespace osculate::equilibrium {

using contact::Status;
using linear::Constraints;

namespace {
std::vector<Index> slaves_of(const model::ContactPairs& pairs) {
    std::vector<Index> slaves;
    for (const auto& pair : pairs) slaves.insert(slaves.end(), pair->slaves().node.begin(), pair->slaves().node.end());
    return slaves;
}
} // namespace

Equilibrium::Equilibrium(const model::Model& model, model::ContactPairs pairs, const linear::Constraints& constraints,
                         const Dynamics* dynamics, const TangentChoice& choice, Timings& timings, int threads,
                         bool follower_pressure)
    : model_(model), pairs_(std::move(pairs)), constraints_(constraints), unknowns_(constraints, slaves_of(pairs_)),
      timings_(timings), bodies_(model, dynamics, follower_pressure, timings, threads),
      contact_(pairs_, constraints, unknowns_, timings, threads),
      rigid_(model.has_dependent_nodes() ? std::make_unique<RigidTerm>(model, constraints, dynamics) : nullptr),
      terms_(list_of_terms()), tangent_(model, constraints, unknowns_, terms_, bodies_, contact_,
                                        rigid_ ? &rigid_->dependence() : nullptr, at_, choice, timings, threads),
      factorisable_(choice.factorisable), multigrid_(choice.multigrid) {
    if (dynamics != nullptr) contact_.set_dynamics(*dynamics);
    if (const Share* share = model.K.share()) contact_.share_out(share->ranks());
    at_.u.reset(model.X.size());
    at_.x = at_.tail = unbalanced_ = at_.u;
}

std::vector<Term*> Equilibrium::list_of_terms() {
    std::vector<Term*> terms{&bodies_, &loads_, &contact_};
    if (!rigid_) return terms;
    bodies_.bodies().add_to_tangent([this](linear::BlockMatrix& tangent) { rigid_->add_tangent(tangent); },
                                    rigid_->dependence());
    contact_.use(rigid_->dependence());
    std::vector<Index> nodes;
    for (const model::RigidBody& body : model_.rigid) {
        if (!body.coupling) nodes.insert(nodes.end(), body.nodes.begin(), body.nodes.end());
        nodes.insert(nodes.end(), {body.reference, body.rotation()});
    }
    bodies_.set_without_elements(std::move(nodes));
    terms.push_back(rigid_.get());
    return terms;
}

void Equilibrium::begin_attempt(const model::State& state, StepLoad load, double dt) {
    at_.u = state.u;
    at_.z = nullptr;
    place();
    bool changed = false;
    for (Term* term : terms_) {
        changed = term->begin(state, at_, load, dt) || changed;
        if (term != &bodies_) continue;
        tangent_.begin(bodies().mass_factor(), changed);
        if (changed) contact_.set_inertia(bodies());
    }
    prescribed_ = std::move(load.prescribed);
    records_.clear();
    cycles_.begin();
}

void Equilibrium::set_statuses(Statuses statuses, StatusRule rule, bool force_first) {
    contact_.set_statuses(std::move(statuses), rule, force_first);
    cycles_.restart();
}

void Equilibrium::stabilise(Stabilisation springs) {
    const ScopedTimer timer(timings_, Part::assembly);
    bodies_.bodies().stabilise(std::move(springs));
    tangent_.stiffness_replaced();
}

void Equilibrium::release() {
    if (!bodies().stabilised()) return;
    const ScopedTimer timer(timings_, Part::assembly);
    bodies_.bodies().release();
    tangent_.stiffness_replaced();
}

bool Equilibrium::advance_friction(Vector& z) {
    if (!friction_)
        friction_ = std::make_unique<FrictionStep>(constraints_, unknowns_, bodies_, contact_,
                                                   rigid_ ? &rigid_->dependence() : nullptr);
    return friction_->advance(at_, unbalanced_, z);
}

void Equilibrium::place() {
    for (std::size_t i = 0; i < at_.x.size(); ++i) at_.tail[i] = rounded_off(model_.X[i], at_.u[i], at_.x[i]);
}

void Equilibrium::unpack() {
    constraints_.scatter(last_z_, prescribed_, at_.u);
    if (rigid_) rigid_->place(at_.u);
    at_.z = &last_z_;
    place();
}

Vector Equilibrium::unknowns(const Field& u, const std::vector<model::ContactHistory>& contact) const {
    Vector z(size());
    constraints_.gather(u, z);
    contact_.pack(contact, z);
    return z;
}

Field Equilibrium::displacements(const Vector& z) const {
    Field u(at_.u.size());
    constraints_.scatter(z, prescribed_, u);
    if (rigid_) rigid_->place(u);
    return u;
}

Vector Equilibrium::kept(const Vector& z) const {
    const Slices* slices = tangent_.slices();
    if (slices == nullptr) return z;
    return z(slices->own());
}

Vector Equilibrium::restored(const Vector& kept) const {
    const Slices* slices = tangent_.slices();
    if (slices == nullptr) return kept;
    Vector z(size());
    slices->gather({kept.data(), static_cast<std::size_t>(kept.size())}, z.data());
    return z;
}

model::State Equilibrium::state(const Vector& z) const {
    model::State state;
    state.u = displacements(z);
    for (const Term* term : terms_) term->complete(z, state);
    return state;
}

solve::NonlinearProblem::Verdict Equilibrium::residual(const ConstVectorRef& z, VectorRef F) {
    rests_ = false;
    if (tangent_.slices() == nullptr)
        before_.swap(last_z_);
    else if (last_z_.size() > 0)
        before_ = kept(last_z_);
    last_z_ = z;
    unpack();
    for (Term* term : terms_)
        if (!term->evaluate(at_)) return Verdict::shorten;
    fill(F);
    record(F);
    constexpr int at_rest = 2; // iterates that have not halved it: Newton would have
    const bool round = cycles_.goes_round();
    rests_ = (round || cycles_.slow() >= at_rest) && at_round_off(F);
    return round || rests_ ? Verdict::stop : Verdict::proceed;
}

void Equilibrium::fill(VectorRef F) {
    const ScopedTimer timer(timings_, Part::assembly);
    unbalanced_.assign(unbalanced_.size(), Vec3::Constant(-0.0)); // what the first sum begins with, sign and all
    Index without_value = -1;                                     // node
    for (const Term* term : terms_) {
        term->add_forces(unbalanced_);
        if (const Index node = term->write_rows(F); node >= 0) without_value = node;
    }
    if (rigid_) rigid_->fold(unbalanced_);
    double worst = -1;
    for (Index node = 0; node < model_.nodes(); ++node) {
        const Vec3 local = constraints_.to_local(node, unbalanced_[node]);
        for (int k = 0; k < 3; ++k)
            if (const Index row = unknowns_.equilibrium_row(node, k); row != linear::Constraints::held) {
                F[row] = local(k);
                if (std::abs(local(k)) > worst) {
                    worst = std::abs(local(k));
                    worst_node_ = node;
                }
            }
    }
    if (without_value >= 0) worst_node_ = without_value;
}

void Equilibrium::record(const ConstVectorRef& F) {
    IterationRecord line;
    line.iteration = static_cast<int>(records_.size());
    line.residual = F.norm() / reference_force_;
    line.status_changes = contact_.status_changes();
    for (std::size_t p = 0; p < statuses().size(); ++p) {
        for (const Status status : statuses()[p]) {
            line.open += status == Status::open;
            line.stick += status == Status::stick;
            line.slip += status == Status::slip || status == Status::glide;
        }
        line.facet_changes += contact()[p].facet_changes();
    }
    records_.push_back(line);
    cycles_.note(statuses(), line.residual);
}

bool Equilibrium::at_round_off(const ConstVectorRef& F) const {
    // How much round-off a sum may gather, of the sum of the absolute values of its terms: a few last digits. Where edges cross,
    // weights and normal have been found to take 16
    constexpr double last_digits = 40 * std::numeric_limits<double>::epsilon();
    Field sums(at_.u.size());
    for (const Term* term : terms_) term->add_magnitudes(at_, sums);
    for (const Term* term : terms_)
        if (!term->rows_within(at_, sums, F, last_digits)) return false;
    if (rigid_) rigid_->dependence().fold_magnitudes(sums);
    for (Index node = 0; node < model_.nodes(); ++node) {
        const Vec3 local = constraints_.frame(node).cwiseAbs().transpose() * sums[node];
        for (int k = 0; k < 3; ++k)
            if (const Index row = unknowns_.equilibrium_row(node, k);
                row != linear::Constraints::held && !(std::abs(F[row]) <= last_digits * local(k)))
                return false;
    }
    return true;
}

bool Equilibrium::holds(const Vector& z, Statuses statuses, double tolerance) {
    set_statuses(std::move(statuses), StatusRule::frozen, false);
    Vector F(size());
    if (residual(z, F) != Verdict::proceed) return false;
    if (F.cwiseAbs().maxCoeff() <= tolerance * reference_force_) return true;
    rests_ = at_round_off(F);
    return rests_;
}

} // namespace osculate::equilibrium
