/// Equilibrium's derivatives: as products, as a matrix, preconditioned and condensed.

#include "osculate/core/parallel.hpp"
#include "osculate/time/equilibrium.hpp"

#include <algorithm>

namespace osculate::time {

using contact::Status;
using model::Constraints;

void Equilibrium::cover_patches() {
    bool covered = true;
    for (std::size_t p = 0; p < model_.pairs.size() && covered; ++p)
        for (Index j = 0; j < model_.pairs[p]->size() && covered; ++j)
            covered = !reaches(p, j) || matrix_->covers(first_coupling_[p] + j, contact_[p].point_nodes(j));
    if (covered) return;

    std::vector<model::Coupling> couplings = matrix_->couplings();
    for (std::size_t p = 0; p < model_.pairs.size(); ++p)
        for (Index j = 0; j < model_.pairs[p]->size(); ++j) {
            auto& masters = couplings[static_cast<std::size_t>(first_coupling_[p] + j)].masters;
            if (!reaches(p, j)) continue;
            // room for the point to move about its facet
            masters = contact_[p].patch_nodes(contact_[p].facets()[j]);
            const auto& own = contact_[p].point_nodes(j);
            masters.insert(masters.end(), own.begin(), own.end());
            std::sort(masters.begin(), masters.end());
            masters.erase(std::unique(masters.begin(), masters.end()), masters.end()); // mirror images repeat nodes
        }
    matrix_ = std::make_unique<model::SystemMatrix>(constraints_, bodies_.tangent(), std::move(couplings));
    ++patterns_built_;
}

void Equilibrium::linearise(std::size_t p, Index j, contact::VariationForm form, ContactTangent& tangent) const {
    tangent.variation.form = form;
    const model::ContactEvaluation& evaluation = contact_[p];
    const model::ContactPair& pair = evaluation.pair();
    const Vec3& lambda = lambda_[p][j];
    const Status status = statuses_[p][j];
    const auto law = evaluation.law(j).residual(evaluation.state(j, lambda_[p][j]), status);
    const Mat3 mirrored = symmetry_directions(pair.slaves().node[j]), kept = Mat3::Identity() - mirrored;
    tangent.D = kept * law.by_lambda + mirrored;
    tangent.reaches = reaches(p, j);
    if (!tangent.reaches) return;
    evaluation.vary(j, tangent.variation);
    tangent.A.noalias() = law.by_gap * tangent.variation.dg + law.by_normal * tangent.variation.dn;
    if (pair.options().friction > 0) {
        evaluation.drift_variation(j, tangent.variation, tangent.dd);
        tangent.A.noalias() += law.by_drift * tangent.dd;
    }
    tangent.A = kept * tangent.A;
    tangent.E = -evaluation.master_force_by_lambda(j); // the forces stand on the right of the equilibrium
    evaluation.fold(j, tangent.A, tangent.E);
    if (tangent.variation.form != contact::VariationForm::matrices) return;
    evaluation.master_force_by_y(j, lambda, tangent.variation, tangent.G);
    tangent.G = -tangent.G;
    evaluation.fold(j, tangent.G);
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
    const model::ContactEvaluation& evaluation = contact_[p];
    const model::ContactPair& pair = evaluation.pair();
    SoftContact soft;
    const auto law = evaluation.law(j).residual(evaluation.state(j, lambda_[p][j]), statuses_[p][j]);
    const Index slave = pair.slaves().node[j];
    const Mat3 mirrored = symmetry_directions(slave), kept = Mat3::Identity() - mirrored;
    soft.coupling = first_coupling_[p] + j;
    soft.where.slave = slave;
    soft.D = kept * law.by_lambda + mirrored;
    soft.c = evaluation.stiffness(j);
    if (!evaluation.point(j).found || !contact::is_closed(statuses_[p][j])) return soft;
    soft.normal = evaluation.point(j).normal;
    soft.B = kept * (law.by_gap * soft.normal.transpose() + law.by_drift);
    evaluation.follow_master(j, soft.where.masters, soft.where.follow);
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
        model::ContactEvaluation& evaluation = contact_[p];
        const model::ContactPair& pair = evaluation.pair();
        std::vector<char> reached;
        for (Index j = 0; j < pair.size(); ++j) reached.push_back(reaches(p, j));
        evaluation.prepare_variations(reached, threads_);
        ContactTangent* own = tangents_.data() + first_coupling_[p];
        parallel_for(threads_, pair.size(), [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j) linearise(p, j, contact::VariationForm::products, own[j]);
        });
        for (Index j = 0; j < pair.size(); ++j)
            if (own[j].reaches)
                bearing_.push_back({&own[j], &evaluation, j, lambda_[p][j], evaluation.point_nodes(j), soften(p, j)});
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
    const auto change = [&](Index coupling) {
        const double* force = x + matrix_->multiplier(coupling);
        return constraints_.to_global(matrix_->couplings()[coupling].slave, Vec3(force[0], force[1], force[2]));
    };
    product_on_.resize(bearing_.size());
    product_law_.resize(bearing_.size());
    parallel_for(threads_, static_cast<Index>(bearing_.size()), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j)
            product_law_[j] = bearing_[j].multiply(moved, change(bearing_[j].law.coupling), product_on_[j]);
    });
    std::size_t next = 0;
    for (Index coupling = 0; coupling < first_coupling_.back(); ++coupling) {
        const Index slave = matrix_->couplings()[coupling].slave;
        const Vec3 lambda = change(coupling);
        Vec3 law;
        if (next < bearing_.size() && bearing_[next].law.coupling == coupling) {
            bearing_[next].scatter(product_on_[next], lambda, add);
            law = product_law_[next++];
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
        model::ContactEvaluation& evaluation = contact_[p];
        const model::ContactPair& pair = evaluation.pair();
        {
            const ScopedTimer timer(timings_, Part::contact);
            std::vector<char> reached;
            for (Index j = 0; j < pair.size(); ++j) reached.push_back(reaches(p, j));
            evaluation.prepare_variations(reached, threads_);
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
                        matrix_->add_contact(coupling, evaluation.point_nodes(j), t.A, t.D, t.E, t.G, lane);
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
