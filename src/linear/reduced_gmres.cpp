#include "osculate/linear/reduced_gmres.hpp"

#include "osculate/core/parallel.hpp"

#include <algorithm>

namespace osculate::linear {

void ReducedGmres::reach(const std::vector<BearingContact>& contacts) {
    std::vector<char> needed(static_cast<std::size_t>(constraints_.nodes()), 0);
    const auto mark = [&](Index node) { needed[node] = 1; };
    for (Index j = 0; j < rows_.couplings(); ++j) mark(rows_.slave(j));
    for (const SoftContact& c : preconditioner_.contacts()) std::ranges::for_each(c.where.masters, mark);
    for (const BearingContact& c : contacts) std::ranges::for_each(c.nodes, mark);
    // Nodes that contact has left may stay: they add zeros to sums, and a new choice would copy factors
    constexpr double most = 1.5; // nodes over those needed
    const auto count = static_cast<double>(std::ranges::count(needed, 1));
    const auto there = [&](Index node) { return needed[node] == 1; };
    const auto kept = static_cast<double>(std::ranges::count_if(nodes_, there));
    const double all = count + static_cast<double>(nodes_.size()) - kept;
    const bool few = all <= most * count;
    if (few) std::ranges::for_each(nodes_, mark);
    if (!few || kept < count) choose(needed);
    preconditioner_.factors().select(equations_);
}

void ReducedGmres::choose(const std::vector<char>& needed) {
    place_.assign(needed.size(), -1);
    nodes_.clear();
    reduced_.clear();
    equations_.clear();
    for (Index node = 0; node < constraints_.nodes(); ++node) {
        if (needed[node] == 0) continue;
        place_[node] = static_cast<Index>(nodes_.size());
        nodes_.push_back(node);
        for (int k = 0; k < 3; ++k) {
            const Index e = constraints_.equation(node, k);
            reduced_.push_back(e == Constraints::held ? -1 : static_cast<Index>(equations_.size()));
            if (e != Constraints::held) equations_.push_back(e);
        }
    }
    const auto couplings = static_cast<std::size_t>(rows_.couplings());
    u_.resize(nodes_.size());
    f_.resize(nodes_.size());
    for (auto* of : {&lambda_, &mu_, &laws_}) of->resize(couplings);
}

Vec3 ReducedGmres::relative(std::size_t j, const std::vector<Vec3>& u) const {
    const Spring& spring = preconditioner_.contacts()[j].where;
    Vec3 w = u[place_[spring.slave]];
    for (std::size_t i = 0; i < spring.masters.size(); ++i) w -= spring.follow[i] * u[place_[spring.masters[i]]];
    return w;
}

void ReducedGmres::add_force(std::size_t j, const Vec3& force, std::vector<Vec3>& f) const {
    const Spring& spring = preconditioner_.contacts()[j].where;
    f[place_[spring.slave]] += force;
    for (std::size_t i = 0; i < spring.masters.size(); ++i)
        f[place_[spring.masters[i]]] -= spring.follow[i].transpose() * force;
}

void ReducedGmres::complete(const double* displacements, const double* laws) {
    for (std::size_t c = 0; c < nodes_.size(); ++c) {
        Vec3 local;
        for (std::size_t k = 0; k < 3; ++k) {
            const Index r = reduced_[3 * c + k];
            local(static_cast<Index>(k)) = r < 0 ? 0 : displacements[r];
        }
        u_[c] = constraints_.to_global(nodes_[c], local);
    }
    const auto& contacts = preconditioner_.contacts();
    for (std::size_t j = 0; j < contacts.size(); ++j) {
        const Mat3& S = preconditioner_.law_stiffness(j);
        lambda_[j] = mu_[j] = S * law(laws, static_cast<Index>(j));
        if (contacts[j].where.masters.empty()) continue;
        const Vec3 w = relative(j, u_);
        lambda_[j] -= S * (contacts[j].B * w);
        mu_[j] -= preconditioner_.spring_stiffness(j) * w;
    }
}

void ReducedGmres::add_law_forces(const double* laws, double* load) {
    std::ranges::fill(f_, Vec3::Zero());
    for (std::size_t j = 0; j < preconditioner_.contacts().size(); ++j)
        add_force(j, preconditioner_.law_stiffness(j) * law(laws, static_cast<Index>(j)), f_);
    for (std::size_t c = 0; c < nodes_.size(); ++c) {
        const Vec3 local = constraints_.to_local(nodes_[c], f_[c]);
        for (std::size_t k = 0; k < 3; ++k)
            if (const Index r = reduced_[3 * c + k]; r >= 0) load[r] += local(static_cast<Index>(k));
    }
}

void ReducedGmres::apply_contact(const std::vector<BearingContact>& contacts, std::span<const Mat3> D, double* z) {
    const auto moved = [&](Index node) -> const Vec3& { return u_[place_[node]]; };
    const auto add = [&](Index node, const Vec3& force) { f_[place_[node]] += force; };
    on_.resize(contacts.size());
    parallel_for(threads_, static_cast<Index>(contacts.size()), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j) {
            const auto coupling = static_cast<std::size_t>(contacts[j].law.coupling);
            laws_[coupling] = contacts[j].multiply(moved, lambda_[coupling], on_[j]);
        }
    });
    std::ranges::fill(f_, Vec3::Zero());
    std::size_t next = 0;
    for (std::size_t j = 0; j < lambda_.size(); ++j) {
        add_force(j, mu_[j], f_);
        if (next < contacts.size() && contacts[next].law.coupling == static_cast<Index>(j)) {
            contacts[next].scatter(on_[next], lambda_[j], add);
            ++next;
        } else {
            laws_[j] = D[j] * lambda_[j];
            add(rows_.slave(static_cast<Index>(j)), -lambda_[j]);
        }
    }
    for (std::size_t c = 0; c < nodes_.size(); ++c) {
        const Vec3 local = constraints_.to_local(nodes_[c], f_[c]);
        for (std::size_t k = 0; k < 3; ++k)
            if (const Index r = reduced_[3 * c + k]; r >= 0) z[r] = local(static_cast<Index>(k));
    }
    double* laws = z + equations_.size();
    for (std::size_t j = 0; j < laws_.size(); ++j) Eigen::Map<Vec3>(laws + 3 * j) = laws_[j];
}

solve::Gmres::Result ReducedGmres::solve(const std::vector<BearingContact>& contacts, std::span<const Mat3> D,
                                         const ConstVectorRef& b, VectorRef x, double allowed) {
    reach(contacts);
    const auto n = static_cast<Index>(equations_.size()), couplings = rows_.couplings(), size = n + 3 * couplings;
    // right sides: of the equilibrium by equation, of the laws in global components
    Vector load(constraints_.equations()), laws(3 * couplings), displacements(constraints_.equations());
    for (Index node = 0; node < constraints_.nodes(); ++node)
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held)
                load(e) = b[rows_.equilibrium_row(node, k)];
    for (Index j = 0; j < couplings; ++j) {
        Vec3 local;
        for (int k = 0; k < 3; ++k) local(k) = b[rows_.contact_row(j, k)];
        laws.segment<3>(3 * j) = constraints_.to_global(rows_.slave(j), local);
    }
    Vector at(n); // of displacements, or their right sides, at the equations of contact
    const auto solve_all = [&] {
        at.setZero();
        add_law_forces(laws.data(), at.data());
        Vector f = load;
        for (Index r = 0; r < n; ++r) f(equations_[r]) += at(r);
        preconditioner_.factors().solve(f.data(), displacements.data());
        for (Index r = 0; r < n; ++r) at(r) = displacements(equations_[r]);
        complete(at.data(), laws.data());
    };
    solve_all();
    Vector rest(size), y(size);
    apply_contact(contacts, D, rest.data());
    rest = -rest;
    rest.tail(3 * couplings) += laws;
    solve::Gmres::Result result{true, 0};
    if (rest.norm() > allowed) {
        if (size != size_) gmres_ = std::make_unique<solve::Gmres>(size, nullptr, threads_);
        size_ = size;
        const auto J = [&](const double* from, double* to) {
            std::copy_n(from, n, at.data());
            add_law_forces(from + n, at.data());
            preconditioner_.factors().solve_selected(at.data(), at.data());
            complete(at.data(), from + n);
            apply_contact(contacts, D, to);
            Eigen::Map<Vector>(to, n) += Eigen::Map<const Vector>(from, n);
        };
        result = gmres_->solve(J, {}, rest.data(), y.data(), allowed);
        for (Index r = 0; r < n; ++r) load(equations_[r]) += y(r);
        laws += y.tail(3 * couplings);
        solve_all();
    }
    x.head(constraints_.equations()) = displacements;
    for (Index j = 0; j < couplings; ++j) {
        const Vec3 local = constraints_.to_local(rows_.slave(j), lambda_[j]);
        for (int k = 0; k < 3; ++k) x[rows_.multiplier(j) + k] = local(k);
    }
    return result;
}

} // namespace osculate::linear
