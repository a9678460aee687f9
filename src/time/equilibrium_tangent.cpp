#include "osculate/time/equilibrium_tangent.hpp"

#include "osculate/model/nodal_unknowns.hpp"

namespace osculate::time {

using model::Constraints;

EquilibriumTangent::EquilibriumTangent(const model::Model& model, const Constraints& constraints,
                                       const model::Unknowns& unknowns, std::span<Term* const> terms, BodyTerm& bodies,
                                       ContactTerm& contact, const Iterate& at, const TangentChoice& choice,
                                       Timings& timings, int threads)
    : constraints_(constraints), unknowns_(unknowns), terms_(terms), bodies_(bodies), contact_(contact), at_(at),
      timings_(timings), threads_(threads), may_buckle_(model.finite_strain != nullptr),
      products_(goes_by_products(model, choice.linear)) {
    const model::BlockMatrix& K = bodies_.bodies().tangent();
    for (Index j = 0; j < unknowns.couplings(); ++j) couplings_.push_back({unknowns.slave(j), {}});
    kept_couplings_ = couplings_;
    const bool symmetric = bodies_.bodies().symmetric();
    if (goes_by_multigrid(model, choice.linear))
        preconditioner_ = std::make_unique<ContactPreconditioner>(
            model, constraints_, K, solve::make_multigrid(model::nodal_unknowns(model, constraints_)), threads);
    else if ((!model.pairs.empty() || !symmetric) && choice.linear != LinearSolver::direct)
        preconditioner_ = std::make_unique<ContactPreconditioner>(model, constraints_, K, nullptr, threads);
    if (condenses(model, choice.linear, choice.follower_pressure)) {
        std::vector<Index> slaves;
        for (const model::Coupling& c : couplings_) slaves.push_back(c.slave);
        condensed_ = std::make_unique<CondensedTangent>(model, constraints_, K, slaves, choice.dynamic, threads_);
    }
}

void EquilibriumTangent::begin(double dt, bool changed) {
    const ScopedTimer timer(timings_, Part::assembly);
    if (condensed_) condensed_->begin(dt, changed);
    if (!changed) return;
    if (matrix_) matrix_->stiffness_changed();
    if (preconditioner_) preconditioner_->stiffness_changed();
}

void EquilibriumTangent::stiffness_replaced() {
    const model::BlockMatrix& K = bodies_.bodies().tangent();
    if (matrix_) matrix_->use(K);
    if (preconditioner_) preconditioner_->use(K);
}

void EquilibriumTangent::use_pattern(std::vector<model::Coupling> couplings) {
    couplings_ = std::move(couplings);
    matrix_ = nullptr;
    ++patterns_built_;
}

void EquilibriumTangent::commit() {
    if (kept_patterns_ != patterns_built_) kept_couplings_ = couplings_;
    kept_patterns_ = patterns_built_;
    if (preconditioner_) preconditioner_->keep_pattern();
    if (condensed_) condensed_->keep();
}

void EquilibriumTangent::rollback() {
    const ScopedTimer timer(timings_, Part::assembly);
    if (kept_patterns_ != patterns_built_) {
        use_pattern(kept_couplings_);
        kept_patterns_ = patterns_built_;
    }
    if (preconditioner_) preconditioner_->restore_pattern();
    if (condensed_) condensed_->restore();
}

EquilibriumMemory EquilibriumTangent::memory() const {
    EquilibriumMemory memory;
    if (kept_patterns_ > 0) memory.couplings = kept_couplings_;
    if (preconditioner_) memory.springs = preconditioner_->kept_pattern();
    if (condensed_ && condensed_->kept() != nullptr) memory.laws = *condensed_->kept();
    return memory;
}

void EquilibriumTangent::recall(const EquilibriumMemory& memory) {
    if (!memory.couplings.empty()) {
        kept_couplings_ = memory.couplings;
        use_pattern(kept_couplings_);
        kept_patterns_ = patterns_built_;
    }
    if (preconditioner_ && memory.springs) preconditioner_->restore_pattern(*memory.springs);
    if (condensed_ && memory.laws) condensed_->restore(*memory.laws);
}

solve::FactorStatus EquilibriumTangent::factorise() {
    if (stale_preconditioner_) preconditioner_->stiffness_changed();
    stale_preconditioner_ = false;
    std::vector<SoftContact> soft;
    for (const Term* term : terms_) term->add_soft(soft);
    return preconditioner_->factorise(std::move(soft));
}

void EquilibriumTangent::precondition(const double* r, double* z) {
    preconditioner_->apply(unknowns_, r, z);
}

void EquilibriumTangent::update_stiffness() {
    if (bodies_.update_stiffness(at_)) stale_preconditioner_ = stale_matrix_ = true;
}

void EquilibriumTangent::linearise() {
    update_stiffness();
    for (Term* term : terms_) term->linearise(at_);
}

void EquilibriumTangent::multiply(const double* x, double* y) {
    std::vector<Vec3>&u = product_u_, &f = product_f_;
    u.assign(at_.u.size(), Vec3::Zero());
    f.assign(at_.u.size(), Vec3::Zero());
    for (Index node = 0; node < constraints_.nodes(); ++node) {
        Vec3 local = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held) local(k) = x[e];
        u[node] = constraints_.to_global(node, local);
    }
    for (Term* term : terms_) term->add_product({u, x}, f, y);
    for (Index node = 0; node < constraints_.nodes(); ++node) {
        const Vec3 local = constraints_.to_local(node, f[node]);
        for (int k = 0; k < 3; ++k)
            if (const Index row = unknowns_.equilibrium_row(node, k); row != Constraints::held) y[row] = local(k);
    }
}

bool EquilibriumTangent::solve(const double* b, double* x, double allowed) {
    // condensation takes for granted that a body's solution balances: where displacements are large and forces small, round-off
    // is in the way, and only the tangent itself tells
    constexpr int most_corrections = 2;
    condensed_->set(contact_.bearing());
    const Index size = unknowns_.size();
    Eigen::Map<Vector> solution(x, size);
    Vector left = Eigen::Map<const Vector>(b, size), more(size), product(size);
    solution.setZero();
    for (int k = 0; k <= most_corrections; ++k) {
        if (!condensed_->solve(unknowns_, contact_.open_laws(), left.data(), more.data(), allowed, timings_))
            return false;
        if (!more.allFinite()) return false;
        solution += more;
        const ScopedTimer timer(timings_, Part::solve);
        multiply(x, product.data());
        left = Eigen::Map<const Vector>(b, size) - product;
        if (left.norm() <= 2 * allowed) return true; // its own measure, and round-off
    }
    return false;
}

void EquilibriumTangent::cover_patterns() {
    std::vector<model::Coupling> couplings = couplings_;
    bool covered = true;
    for (const Term* term : terms_) covered = term->add_pattern(couplings) && covered;
    if (!covered) use_pattern(std::move(couplings));
}

const solve::SparseMatrix& EquilibriumTangent::jacobian() {
    update_stiffness();
    {
        const ScopedTimer timer(timings_, Part::assembly);
        const bool contact = unknowns_.couplings() > 0;
        if (contact) cover_patterns();
        if (!matrix_) {
            matrix_ = std::make_unique<model::SystemMatrix>(constraints_, bodies_.bodies().tangent(), couplings_);
            if (may_buckle_) matrix_->expect_buckling();
            if (!bodies_.bodies().symmetric()) matrix_->expect_unsymmetric();
        } else if (stale_matrix_) {
            matrix_->stiffness_changed();
        }
        stale_matrix_ = false;
        if (!contact) return matrix_->matrix(); // constant without finite strain: factorised once
        matrix_->reset();
    }
    for (Term* term : terms_) term->add_derivatives(*matrix_);
    matrix_->finish();
    return matrix_->matrix();
}

} // namespace osculate::time
