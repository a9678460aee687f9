#include "osculate/equilibrium/equilibrium_tangent.hpp"

#include "osculate/linear/gathered.hpp"
#include "osculate/model/nodal_unknowns.hpp"
#include "osculate/model/rigid_motion.hpp"

#include <algorithm>

namespace osculate::equilibrium {

using linear::Constraints;

namespace {
/// Whether supports leave a body a rigid motion.
bool loose(const model::Body& body, const Field& X, const Constraints& constraints) {
    model::RigidHold hold(body, X);
    for (Index node = body.first_node; node < body.first_node + body.nodes(); ++node)
        for (int k = 0; k < 3; ++k)
            if (constraints.constraint(node, k) != nullptr) hold.hold(X[node], constraints.frame(node).col(k));
    return hold.free() > 0;
}

/// For products and preconditioner, on one of the processes that share the model.
std::unique_ptr<linear::UnknownSlices> make_slices(const model::Model& model, const linear::Constraints& constraints,
                                                   const linear::Unknowns& unknowns,
                                                   const model::ContactEvaluations& contact,
                                                   const linear::Dependence* dependence) {
    std::vector<Index> read, hubs;
    const auto add = [&](const std::vector<Index>& nodes) { read.insert(read.end(), nodes.begin(), nodes.end()); };
    for (const Index row : model.share->nodes_of(model.share->ranks().rank())) // others have its pattern
        for (Index k = model.K.row_begin(row); k < model.K.row_end(row); ++k)
            if (!model.share->owns(model.K.column(k))) read.push_back(model.K.column(k));
    for (const model::ContactEvaluation& evaluation : contact) {
        const model::ContactPair& pair = evaluation.pair();
        add(pair.slaves().node);
        add(pair.master_nodes());
        if (pair.slaves().edges) add(pair.slaves().edges->others);
    }
    if (dependence != nullptr) { // what the nodes that are read here follow, and one's own
        std::vector<char> here(static_cast<std::size_t>(constraints.nodes()), 0);
        for (const Index node : read) here[static_cast<std::size_t>(node)] = 1;
        for (const Index node : dependence->nodes())
            if (here[static_cast<std::size_t>(node)] != 0 || model.share->owns(node))
                for (const linear::Dependence::Carrier& carrier : dependence->carriers(node))
                    read.push_back(carrier.node);
    }
    for (const model::RigidBody& rigid : model.rigid) hubs.insert(hubs.end(), {rigid.reference, rigid.rotation()});
    add(hubs);
    return std::make_unique<linear::UnknownSlices>(*model.share, constraints, unknowns, read, hubs);
}
} // namespace

EquilibriumTangent::EquilibriumTangent(const model::Model& model, const linear::Constraints& constraints,
                                       const linear::Unknowns& unknowns, std::span<Term* const> terms, BodyTerm& bodies,
                                       ContactTerm& contact, const linear::Dependence* dependence, const Iterate& at,
                                       const TangentChoice& choice, Timings& timings, int threads)
    : constraints_(constraints), unknowns_(unknowns), terms_(terms), bodies_(bodies), contact_(contact),
      dependence_(dependence), at_(at), timings_(timings), multigrid_(choice.multigrid),
      may_buckle_(model.nonlinear != nullptr || dependence != nullptr), products_(choice.products) {
    if (dependence != nullptr && linear::needs_folding(*dependence, bodies_.bodies().tangent())) {
        folded_ = std::make_unique<linear::FoldedMatrix>(*dependence, bodies_.bodies().tangent());
        fold_stiffness();
    }
    const linear::BlockMatrix& K = stiffness();
    for (Index j = 0; j < unknowns.couplings(); ++j) {
        couplings_.push_back({unknowns.slave(j), {}});
        if (dependence == nullptr) continue; // the force on a dependent node acts elsewhere, even if it is open
        linear::replace_dependent(*dependence, unknowns.slave(j), couplings_.back().masters);
        std::ranges::sort(couplings_.back().masters);
    }
    kept_couplings_ = couplings_;
    if (choice.preconditioned) {
        std::function<linear::BlockMatrix()> undeformed;
        if (&K != &model.K)
            undeformed = [this, &model, threads] {
                linear::BlockMatrix stiffness_then = model::undeformed_stiffness(model, threads);
                return folded_ ? folded_->folded(stiffness_then) : stiffness_then;
            };
        preconditioner_ = std::make_unique<linear::ContactPreconditioner>(
            constraints_, K,
            choice.multigrid ? solve::make_multigrid(model::nodal_unknowns(model, constraints_), threads) : nullptr,
            std::move(undeformed));
    }
    if (model.share && preconditioner_)
        slices_ = make_slices(model, constraints_, unknowns_, contact_.evaluations(), dependence_);
    if (choice.reduced)
        reduced_ = std::make_unique<linear::ReducedGmres>(constraints_, unknowns_, *preconditioner_, threads);
    if (!choice.condensed) return;
    std::vector<linear::CondensedBody> condensed;
    for (const model::Body& body : model.bodies)
        condensed.push_back(
            {body.first_node, body.nodes(), !bodies_.bodies().dynamic() && loose(body, model.X, constraints_)});
    std::vector<Index> slaves;
    for (const linear::Coupling& c : couplings_) slaves.push_back(c.slave);
    condensed_ = std::make_unique<Condensation>(model, constraints_, K, std::move(condensed), std::move(slaves), choice,
                                                threads);
}

const linear::BlockMatrix& EquilibriumTangent::stiffness() const {
    return folded_ ? folded_->matrix() : bodies_.bodies().tangent();
}

void EquilibriumTangent::fold_stiffness() {
    if (folded_) folded_->fold(bodies_.bodies().tangent());
}

void EquilibriumTangent::begin(double mass_factor, bool changed) {
    const ScopedTimer timer(timings_, Part::assembly);
    if (condensed_) condensed_->begin(mass_factor, changed);
    mass_factor_ = mass_factor;
    if (made_for_.mass_factor != mass_factor) wear().usable = false;
    if (!changed) return;
    in_force_ = false;
    fold_stiffness();
    take_to_matrix();
    if (preconditioner_) preconditioner_->stiffness_changed();
}

void EquilibriumTangent::stiffness_replaced() {
    in_force_ = wear().usable = false;
    fold_stiffness();
    const linear::BlockMatrix& K = stiffness();
    if (whole_)
        take_to_matrix();
    else if (matrix_)
        matrix_->use(K);
    if (preconditioner_) preconditioner_->use(K);
}

void EquilibriumTangent::take_to_matrix() {
    if (whole_) { // gathered again if it is needed again
        matrix_ = nullptr;
        whole_ = nullptr;
    } else if (matrix_) {
        matrix_->stiffness_changed();
    }
}

const linear::BlockMatrix& EquilibriumTangent::whole_stiffness() {
    if (stiffness().share() == nullptr) return stiffness();
    if (!whole_) whole_ = std::make_unique<linear::BlockMatrix>(linear::gathered(stiffness()));
    return *whole_;
}

void EquilibriumTangent::use_pattern(std::vector<linear::Coupling> couplings) {
    couplings_ = std::move(couplings);
    matrix_ = nullptr;
    ++patterns_built_;
}

void EquilibriumTangent::commit() {
    if (kept_patterns_ != patterns_built_) kept_couplings_ = couplings_;
    kept_patterns_ = patterns_built_;
    if (preconditioner_) preconditioner_->keep_pattern();
    if (condensed_) condensed_->commit();
    kept_for_ = made_for_;
    kept_wear_ = wear();
    if (bodies_.bodies().stabilised()) kept_wear_.usable = false;
}

void EquilibriumTangent::rollback() {
    const ScopedTimer timer(timings_, Part::assembly);
    if (kept_patterns_ != patterns_built_) {
        use_pattern(kept_couplings_);
        kept_patterns_ = patterns_built_;
    }
    if (preconditioner_) preconditioner_->restore_pattern();
    if (condensed_) condensed_->rollback();
    if (made_for_.contacts != kept_for_.contacts) in_force_ = false;
    made_for_ = kept_for_;
    wear() = kept_wear_;
}

EquilibriumMemory EquilibriumTangent::memory() const {
    EquilibriumMemory memory;
    if (kept_patterns_ > 0) memory.couplings = kept_couplings_;
    if (preconditioner_) memory.springs = preconditioner_->kept_pattern();
    if (reduced_ && kept_wear_.usable) {
        memory.factors = kept_for_;
        memory.factors->fresh = kept_wear_.fresh;
        memory.factors->wasted = kept_wear_.wasted;
    }
    if (condensed_) {
        memory.condensed = condensed_->kept_nodes();
        if (const linear::ContactLaws* laws = condensed_->kept_laws()) memory.laws = *laws;
    }
    return memory;
}

void EquilibriumTangent::recall(const EquilibriumMemory& memory) {
    if (!memory.couplings.empty()) {
        kept_couplings_ = memory.couplings;
        use_pattern(kept_couplings_);
        kept_patterns_ = patterns_built_;
    }
    if (preconditioner_ && memory.springs) preconditioner_->restore_pattern(*memory.springs);
    if (reduced_ && memory.factors) {
        made_for_ = kept_for_ = *memory.factors;
        wear() = kept_wear_ = {true, memory.factors->fresh, memory.factors->wasted};
        in_force_ = false;
    }
    if (condensed_) condensed_->recall(memory.condensed, memory.laws ? &*memory.laws : nullptr);
}

solve::FactorStatus EquilibriumTangent::factorise() {
    if (stale_preconditioner_) preconditioner_->stiffness_changed();
    stale_preconditioner_ = false;
    std::vector<linear::SoftContact> soft;
    for (const Term* term : terms_) term->add_soft(soft);
    made_for_.mass_factor = mass_factor_;
    made_for_.contacts = std::make_shared<const std::vector<linear::SoftContact>>(std::move(soft));
    in_force_ = true;
    return preconditioner_->factorise(*made_for_.contacts);
}

solve::FactorStatus EquilibriumTangent::refresh() {
    if (in_force_) return solve::FactorStatus::ok;
    in_force_ = true;
    return preconditioner_->factorise(*made_for_.contacts);
}

void EquilibriumTangent::precondition(const ConstVectorRef& r, VectorRef z) {
    preconditioner_->apply(unknowns_, r, z, slices_.get());
}

void EquilibriumTangent::update_stiffness() {
    if (!bodies_.update_stiffness(at_)) return;
    const ScopedTimer timer(timings_, Part::assembly);
    fold_stiffness();
    stale_preconditioner_ = stale_matrix_ = true;
}

void EquilibriumTangent::linearise() {
    update_stiffness();
    for (Term* term : terms_) term->linearise(at_);
}

void EquilibriumTangent::multiply(const ConstVectorRef& x, VectorRef y) {
    Field &u = product_u_, &f = product_f_;
    const auto unpack = [&](Index node) {
        Vec3 local = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != linear::Constraints::held) local(k) = x[e];
        u[node] = constraints_.to_global(node, local);
    };
    const auto pack = [&](Index node) {
        const Vec3 local = constraints_.to_local(node, f[node]);
        for (int k = 0; k < 3; ++k)
            if (const Index row = unknowns_.equilibrium_row(node, k); row != linear::Constraints::held)
                y[row] = local(k);
    };
    if (slices_ == nullptr || u.empty()) {
        u.reset(at_.u.size());
        f.reset(at_.u.size());
        for (const Field* field : {&u, &f})
            if (slices_ != nullptr) forget(*field); // written in part
    }
    if (slices_ == nullptr) {
        for (Index node = 0; node < constraints_.nodes(); ++node) unpack(node);
    } else {
        const auto begin = [&](Index node) {
            unpack(node);
            f[node].setZero();
        };
        for (const Index node : slices_->nodes()) begin(node);
        for (const Index node : slices_->ghosts()) begin(node);
    }
    if (dependence_ != nullptr) dependence_->move(u);
    for (Term* term : terms_) term->add_product({u, x, slices_.get()}, f, y);
    if (dependence_ != nullptr) dependence_->fold(f);
    if (slices_ == nullptr)
        for (Index node = 0; node < constraints_.nodes(); ++node) pack(node);
    else
        for (const Index node : slices_->nodes()) pack(node);
}

std::optional<solve::Gmres::Result> EquilibriumTangent::solve_with(const ConstVectorRef& b, VectorRef x,
                                                                   double allowed) {
    if (!reduced_) return std::nullopt;
    constexpr int most_corrections = 2;
    const Index size = unknowns_.size();
    Vector left = b, more(size), product(size);
    x.setZero();
    solve::Gmres::Result all{true, 0};
    for (int k = 0; k <= most_corrections; ++k) {
        const solve::Gmres::Result one = reduced_->solve(contact_.bearing(), contact_.open_laws(), left, more, allowed);
        all.iterations += one.iterations;
        all.converged = one.converged && more.allFinite();
        if (!all.converged) return all;
        x += more;
        multiply(x, product);
        left = b - product;
        if (left.norm() <= 2 * allowed) return all; // its own measure, and round-off
    }
    return std::nullopt;
}

bool EquilibriumTangent::solve(const ConstVectorRef& b, VectorRef x, double allowed) {
    // condensation takes for granted that a body's solution balances: where displacements are large and forces small, round-off
    // is in the way, and only the tangent itself tells
    constexpr int most_corrections = 2;
    linear::CondensedTangent& condensed = condensed_->tangent_for(contact_.bearing());
    if (!condensed.covers(contact_.bearing())) return false;
    condensed.set(contact_.bearing());
    const Index size = unknowns_.size();
    Vector left = b, more(size), product(size);
    x.setZero();
    for (int k = 0; k <= most_corrections; ++k) {
        if (!condensed.solve(unknowns_, contact_.open_laws(), left, more, allowed, timings_)) return false;
        if (!more.allFinite()) return false;
        x += more;
        const ScopedTimer timer(timings_, Part::solve);
        multiply(x, product);
        left = b - product;
        if (left.norm() <= 2 * allowed) return true; // its own measure, and round-off
    }
    return false;
}

void EquilibriumTangent::cover_patterns() {
    std::vector<linear::Coupling> couplings = couplings_;
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
        if (stale_matrix_) take_to_matrix();
        stale_matrix_ = false;
        if (!matrix_) {
            matrix_ = std::make_unique<linear::SystemMatrix>(constraints_, whole_stiffness(), couplings_);
            if (may_buckle_) matrix_->expect_buckling();
            if (!bodies_.bodies().symmetric()) matrix_->expect_unsymmetric();
        }
        if (!contact) return matrix_->matrix(); // constant without nonlinear elements: factorised once
        matrix_->reset();
    }
    for (Term* term : terms_) term->add_derivatives(*matrix_);
    matrix_->finish();
    return matrix_->matrix();
}

} // namespace osculate::equilibrium
