#include "osculate/linear/contact_preconditioner.hpp"

#include "osculate/core/dense_algebra.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace osculate::linear {

namespace {
/// c / gamma. Ten times smaller and friction, which the condensed stiffness leaves out, costs iterations; three times larger
/// changes nothing. Cycles take twice as many for springs ten times stiffer than what they lean on.
constexpr double softness_factorised = 0.1, softness_multigrid = 1;

/// Nearest positive semidefinite matrix to the symmetric part of M.
Mat3 positive_part(const Mat3& M) {
    const auto [values, vectors] = principal_axes(0.5 * (M + M.transpose()));
    return vectors * values.cwiseMax(0).asDiagonal() * vectors.transpose();
}
} // namespace

ContactPreconditioner::ContactPreconditioner(const Constraints& constraints, const BlockMatrix& K,
                                             std::unique_ptr<solve::Multigrid> multigrid,
                                             std::function<BlockMatrix()> undeformed)
    : constraints_(constraints), K_(&K), first_(&K), undeformed_(std::move(undeformed)), stiffness_(constraints, K),
      solver_(multigrid ? nullptr : solve::make_condensing_cholesky({})), multigrid_(std::move(multigrid)),
      softness_(multigrid_ ? softness_multigrid : softness_factorised), load_(constraints.equations()) {
    if (K.share() != nullptr) forget({load_.data(), static_cast<std::size_t>(load_.size())}); // written in part
}

solve::FactorStatus ContactPreconditioner::factorise(std::vector<SoftContact> contacts) {
    contacts_ = std::move(contacts);
    S_.clear();
    springs_.assign(contacts_.size(), Mat3::Zero());
    std::vector<Spring> springs;
    for (const SoftContact& k : contacts_) {
        S_.push_back(Mat3((k.D + softness_ / k.c * k.B).inverse()));
        if (!S_.back().allFinite()) return solve::FactorStatus::singular;
        if (k.where.masters.empty()) continue;
        const Mat3 SB = S_.back() * k.B, N = k.normal * k.normal.transpose(), T = Mat3::Identity() - N;
        Spring& spring = springs.emplace_back(k.where);
        spring.stiffness = springs_[S_.size() - 1] = positive_part(N * SB * N + T * SB * T);
    }
    if (multigrid_) return couple(springs);
    stiffness_.set_springs(springs);
    return solver_->factorise(stiffness_.matrix());
}

solve::FactorStatus ContactPreconditioner::couple(const std::vector<Spring>& springs) {
    if (!coarsened_) {
        // grids of the undeformed bodies: those of the moment would depend on when they were chosen
        if (undeformed_)
            multigrid_->coarsen(undeformed_().view());
        else
            multigrid_->coarsen(first_->view());
        changed_ = undeformed_ || K_ != first_;
        coarsened_ = true;
    }
    if (changed_) multigrid_->take(K_->view());
    changed_ = false;
    std::vector<solve::NodalBlock> blocks;
    blocks.reserve(most_blocks_);
    for (const Spring& s : springs)
        for_each_block(s, [&](Index row, Index column, const Mat3& block) {
            if (multigrid_->reads_row(row)) blocks.push_back({row, column, block});
        });
    most_blocks_ = std::max(most_blocks_, blocks.size());
    return multigrid_->couple(blocks);
}

double ContactPreconditioner::effort() const {
    constexpr double of_multigrid = 15; // cycles
    constexpr double least = 10;        // what of a factorisation does not grow with its operations
    constexpr double most = 100;        // an iteration is more than a solution
    return multigrid_ ? of_multigrid + multigrid_->cycles_to_couple() : std::min(least + solver_->effort(), most);
}

void ContactPreconditioner::apply(const Unknowns& rows, const ConstVectorRef& r, VectorRef z,
                                  UnknownSlices* slices) const {
    const auto equilibrium_rows = [&](Index node, auto&& each) {
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held) each(e, k);
    };
    const auto take = [&](Index node) {
        equilibrium_rows(node, [&](Index e, int k) { load_(e) = r[rows.equilibrium_row(node, k)]; });
    };
    if (slices == nullptr) {
        for (Index node = 0; node < constraints_.nodes(); ++node) take(node);
    } else {
        for (const Index node : slices->nodes()) take(node);
        // filled in for hubs; nobody reads what contact adds to others
        for (const Index node : slices->ghosts()) take(node);
    }
    const auto add = [&](Index node, const Vec3& force) {
        const Vec3 local = constraints_.to_local(node, force);
        equilibrium_rows(node, [&](Index e, int k) { load_(e) += local(k); });
    };
    const auto law = [&](const SoftContact& c) {
        Vec3 local;
        for (int k = 0; k < 3; ++k) local(k) = r[rows.contact_row(c.coupling, k)];
        return constraints_.to_global(c.where.slave, local);
    };
    // K u - W^T lambda = r_e and lambda = S (r_c - B W u)
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
        const SoftContact& c = contacts_[j];
        const Vec3 force = S_[j] * law(c);
        add(c.where.slave, force);
        for (std::size_t i = 0; i < c.where.masters.size(); ++i)
            add(c.where.masters[i], Vec3(-c.where.follow[i].transpose() * force));
    }
    if (multigrid_)
        multigrid_->cycle(load_.data(), z.data());
    else
        solver_->solve(load_.data(), z.data());
    if (slices != nullptr) slices->fill_unknowns(z.data());
    const auto moved = [&](Index node) {
        Vec3 local = Vec3::Zero();
        equilibrium_rows(node, [&](Index e, int k) { local(k) = z[e]; });
        return constraints_.to_global(node, local);
    };
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
        const SoftContact& c = contacts_[j];
        Vec3 force = law(c);
        if (!c.where.masters.empty()) {
            Vec3 w = moved(c.where.slave);
            for (std::size_t i = 0; i < c.where.masters.size(); ++i) w -= c.where.follow[i] * moved(c.where.masters[i]);
            force -= c.B * w;
        }
        const Vec3 lambda = constraints_.to_local(c.where.slave, Vec3(S_[j] * force));
        for (int k = 0; k < 3; ++k) z[rows.multiplier(c.coupling) + k] = lambda(k);
    }
}

void ContactPreconditioner::apply_transposed(const Unknowns& rows, const ConstVectorRef& r, VectorRef z) const {
    const auto at = [&](const ConstVectorRef& from, Index node) {
        Vec3 local = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held) local(k) = from[e];
        return constraints_.to_global(node, local);
    };
    const auto add = [&](Index node, const Vec3& weight) {
        const Vec3 local = constraints_.to_local(node, weight);
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held) load_(e) += local(k);
    };
    // u = K_s^-1 (r_e + W^T S r_c) and lambda = S (r_c - B W u), from the end
    load_ = r.head(constraints_.equations());
    std::vector<Vec3> of_law(contacts_.size());
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
        const SoftContact& c = contacts_[j];
        const Vec3 local = r.segment<3>(rows.multiplier(c.coupling));
        of_law[j] = S_[j].transpose() * constraints_.to_global(c.where.slave, local);
        if (c.where.masters.empty()) continue;
        const Vec3 weight = c.B.transpose() * of_law[j];
        add(c.where.slave, -weight);
        for (std::size_t i = 0; i < c.where.masters.size(); ++i)
            add(c.where.masters[i], Vec3(c.where.follow[i].transpose() * weight));
    }
    Vector w(constraints_.equations());
    if (multigrid_)
        multigrid_->cycle(load_.data(), w.data());
    else
        solver_->solve(load_.data(), w.data());
    for (Index node = 0; node < constraints_.nodes(); ++node)
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held)
                z[rows.equilibrium_row(node, k)] = w(e);
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
        const SoftContact& c = contacts_[j];
        Vec3 moved = at(w, c.where.slave);
        for (std::size_t i = 0; i < c.where.masters.size(); ++i) moved -= c.where.follow[i] * at(w, c.where.masters[i]);
        const Vec3 local = constraints_.to_local(c.where.slave, Vec3(of_law[j] + S_[j].transpose() * moved));
        for (int k = 0; k < 3; ++k) z[rows.contact_row(c.coupling, k)] = local(k);
    }
}

} // namespace osculate::linear
