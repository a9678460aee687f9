#include "osculate/linear/condensed_tangent.hpp"

#include "osculate/core/parallel.hpp"
#include "osculate/linear/penalty_stiffness.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace osculate::linear {

namespace {

/// GMRES iterations beyond which T is worth making anew.
constexpr int worth_keeping = 10;

} // namespace

std::vector<Index> three_apart(const std::vector<Index>& nodes, const Field& X) {
    const auto farthest = [&](auto&& distance) {
        return *std::max_element(nodes.begin(), nodes.end(),
                                 [&](Index a, Index b) { return distance(X[a]) < distance(X[b]); });
    };
    const Vec3 first = X[nodes.front()];
    const Index a = farthest([&](const Vec3& x) { return (x - first).norm(); });
    const Index b = farthest([&](const Vec3& x) { return (x - X[a]).norm(); });
    const Vec3 along = (X[b] - X[a]).normalized();
    const Index c = farthest([&](const Vec3& x) { return (x - X[a]).cross(along).norm(); });
    std::vector<Index> result{a, b, c};
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

CondensedTangent::CondensedTangent(const Constraints& constraints, const BlockMatrix& K, const Field& X,
                                   const std::vector<CondensedBody>& bodies, std::vector<Index> contact,
                                   std::vector<Index> slaves, int threads, const CondensedTangent* before)
    : constraints_(constraints), K_(&K), threads_(threads), slaves_(std::move(slaves)), nodes_(std::move(contact)),
      place_(X.size(), -1) {
    for (std::size_t c = 0; c < nodes_.size(); ++c) place_[nodes_[c]] = static_cast<Index>(c);
    reduced_.assign(3 * nodes_.size(), -1);
    first_.push_back(0);
    for (const CondensedBody& body : bodies) {
        std::vector<Index> kept, sprung;
        for (Index node = body.first_node; node < body.first_node + body.nodes; ++node)
            if (place_[node] >= 0) kept.push_back(node);
        body_of_.insert(body_of_.end(), kept.size(), static_cast<Index>(bodies_.size()));
        if (body.loose && !kept.empty()) sprung = three_apart(kept, X);
        for (const Index node : sprung) sprung_.push_back(place_[node]);
        const std::size_t b = bodies_.size();
        if (before != nullptr && before->bodies_[b]->keeps(kept, sprung))
            bodies_.push_back(before->bodies_[b]);
        else
            bodies_.push_back(std::make_shared<BodyCompliance>(constraints, body.first_node, body.nodes, kept, sprung));
        Index next = first_.back();
        for (const Index node : kept)
            for (int k = 0; k < 3; ++k)
                if (constraints.equation(node, k) != Constraints::held)
                    reduced_[3 * static_cast<std::size_t>(place_[node]) + k] = next++;
        first_.push_back(next);
    }
}

void CondensedTangent::begin(double mass_factor, bool changed) {
    mass_factor_ = mass_factor;
    if (changed) {
        factorised_ = false;
        for (const auto& body : bodies_) body->stiffness_changed();
    }
    if (schur_ && schur_->mass_factor != mass_factor) schur_ = nullptr;
}

void CondensedTangent::factorise_bodies() {
    factorised_ = true;
    usable_ = true;
    spring_ = 0;
    for (const Index c : sprung_) {
        const Index node = nodes_[c];
        spring_ = std::max(spring_, K_->block(K_->slot(node, node)).diagonal().maxCoeff());
    }
    std::optional<PenaltyStiffness> all;
    for (std::shared_ptr<BodyCompliance>& body : bodies_) { // not side by side: METIS has one source of random numbers
        if (body->is_factorised(spring_)) continue;
        if (body.use_count() > 1) body = std::make_shared<BodyCompliance>(body->afresh());
        if (!all) {
            all.emplace(constraints_, *K_);
            all->set_springs({});
        }
        usable_ = body->factorise(all->matrix(), spring_) == solve::FactorStatus::ok && usable_;
    }
    factorisations_ += all ? 1 : 0;
}

bool CondensedTangent::covers(const std::vector<BearingContact>& contacts) const {
    const auto reached = [&](Index node) { return place_[node] >= 0; };
    return std::ranges::all_of(contacts, [&](const BearingContact& c) {
        return reached(c.law.where.slave) && std::ranges::all_of(c.law.where.masters, reached) &&
               std::ranges::all_of(c.nodes, reached);
    });
}

void CondensedTangent::set(const std::vector<BearingContact>& contacts) {
    contacts_ = &contacts;
    const auto same = [](Index coupling, const BearingContact& c) { return coupling == c.law.coupling; };
    if (schur_ && !std::ranges::equal(schur_->couplings, contacts, same)) schur_ = nullptr;
}

void CondensedTangent::spread(const double* reduced, Nodal& nodal) const {
    nodal.resize(nodes_.size());
    for (std::size_t c = 0; c < nodes_.size(); ++c) {
        Vec3 local;
        for (int k = 0; k < 3; ++k) {
            const Index r = reduced_[3 * c + static_cast<std::size_t>(k)];
            local(k) = r < 0 ? 0 : reduced[r];
        }
        nodal[c] = constraints_.to_global(nodes_[c], local);
    }
}

void CondensedTangent::collect(const Nodal& nodal, double* reduced) const {
    for (std::size_t c = 0; c < nodes_.size(); ++c) {
        const Vec3 local = constraints_.to_local(nodes_[c], nodal[c]);
        for (int k = 0; k < 3; ++k)
            if (const Index r = reduced_[3 * c + static_cast<std::size_t>(k)]; r >= 0) reduced[r] += local(k);
    }
}

void CondensedTangent::add_forces(const Vector& lambda, double* reduced) const {
    Nodal nodal(nodes_.size(), Vec3::Zero());
    for (std::size_t j = 0; j < schur_->terms.size(); ++j)
        for (const Term& t : schur_->terms[j])
            nodal[t.node] += t.by.transpose() * lambda.segment<3>(3 * static_cast<Index>(j));
    collect(nodal, reduced);
}

void CondensedTangent::relative(const ContactLaws& laws, const double* reduced, Vector& w) const {
    Nodal nodal;
    spread(reduced, nodal);
    w.setZero(3 * static_cast<Index>(laws.terms.size()));
    for (std::size_t j = 0; j < laws.terms.size(); ++j)
        for (const Term& t : laws.terms[j]) w.segment<3>(3 * static_cast<Index>(j)) += t.by * nodal[t.node];
}

void CondensedTangent::each_body(const std::function<void(std::size_t)>& work) const {
    const auto lanes = static_cast<Index>(std::min<std::size_t>(bodies_.size(), static_cast<std::size_t>(threads_)));
    parallel_lanes(lanes, [&](Lane lane) {
        for (std::size_t b = 0; b < bodies_.size(); ++b)
            if (lane.owns(static_cast<Index>(b))) work(b);
    });
}

void CondensedTangent::apply_compliance(const double* f, double* u) const {
    each_body([&](std::size_t b) {
        const Index n = first_[b + 1] - first_[b];
        if (n == 0) return;
        Eigen::Map<Vector>(u + first_[b], n).noalias() =
            bodies_[b]->W().selfadjointView<Eigen::Lower>() * Eigen::Map<const Vector>(f + first_[b], n);
    });
}

std::shared_ptr<CondensedTangent::SchurComplement> CondensedTangent::schur_complement() const {
    auto schur = std::make_shared<SchurComplement>();
    auto& [mass_factor, couplings, terms, B, D] = static_cast<ContactLaws&>(*schur);
    mass_factor = mass_factor_;
    for (const BearingContact& c : *contacts_) {
        couplings.push_back(c.law.coupling);
        auto& list = terms.emplace_back();
        list.push_back({place_[c.law.where.slave], Mat3::Identity()});
        for (std::size_t i = 0; i < c.law.where.masters.size(); ++i)
            list.push_back({place_[c.law.where.masters[i]], -c.law.where.follow[i]});
        B.push_back(c.law.B);
        D.push_back(c.law.D);
    }
    for (const Index node : sprung_) { // mu = -spring u
        terms.push_back({{node, -Mat3::Identity()}});
        B.emplace_back(-spring_ * Mat3::Identity());
        D.emplace_back(Mat3::Identity());
    }
    return schur;
}

void CondensedTangent::factorise(SchurComplement& schur) const {
    const auto& terms = schur.terms;
    // columns of F = C W C^T
    const auto count = static_cast<Index>(terms.size()), reduced = first_.back();
    Matrix T(3 * count, 3 * count);
    parallel_for(threads_, count, [&](Index begin, Index end) {
        Vector u(reduced), w;
        for (Index column = 3 * begin; column < 3 * end; ++column) {
            u.setZero();
            for (const Term& t : terms[column / 3]) {
                const Vec3 local = constraints_.to_local(nodes_[t.node], Vec3(t.by.row(column % 3).transpose()));
                const auto b = static_cast<std::size_t>(body_of_[t.node]);
                for (int c = 0; c < 3; ++c)
                    if (const Index r = reduced_[3 * static_cast<std::size_t>(t.node) + static_cast<std::size_t>(c)];
                        r >= 0 && local(c) != 0)
                        u.segment(first_[b], first_[b + 1] - first_[b]) +=
                            local(c) * bodies_[b]->W().col(r - first_[b]);
            }
            relative(schur, u.data(), w);
            for (Index i = 0; i < count; ++i) T.block<3, 1>(3 * i, column) = schur.B[i] * w.segment<3>(3 * i);
        }
    });
    for (Index j = 0; j < count; ++j) T.block<3, 3>(3 * j, 3 * j) += schur.D[j];
    schur.usable = schur.T.factorise(std::move(T));
    schur.factorised = true;
}

Vector CondensedTangent::contact_forces(const Vector& u, const double* r) const {
    // T lambda = r - B C u, no right side for springs
    Vector lambda;
    relative(*schur_, u.data(), lambda);
    for (std::size_t j = 0; j < schur_->terms.size(); ++j) {
        const Index at = 3 * static_cast<Index>(j);
        lambda.segment<3>(at) = (-schur_->B[j] * lambda.segment<3>(at)).eval();
    }
    lambda.head(forces()) += Eigen::Map<const Vector>(r, forces());
    schur_->T.solve(lambda.data());
    return lambda;
}

void CondensedTangent::precondition(const double* y, Vector& lambda, Vector& u, Vector& f) const {
    const Index n = first_.back();
    u.resize(n);
    apply_compliance(y, u.data());
    lambda = contact_forces(u, y + n);
    f = Eigen::Map<const Vector>(y, n);
    add_forces(lambda, f.data());
    apply_compliance(f.data(), u.data());
}

void CondensedTangent::apply_contact(const Vector& lambda, const Vector& u, double* z) const {
    const Index n = first_.back();
    Vector bearing = lambda;
    bearing.tail(lambda.size() - forces()).setZero(); // the springs cancel
    std::fill_n(z, n, 0.0);
    add_forces(bearing, z);
    Nodal at, by(nodes_.size(), Vec3::Zero());
    spread(u.data(), at);
    const auto moved = [&](Index node) { return at[place_[node]]; };
    const auto add = [&](Index node, const Vec3& force) { by[place_[node]] += force; };
    on_.resize(contacts_->size());
    parallel_for(threads_, static_cast<Index>(contacts_->size()), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j)
            Eigen::Map<Vec3>(z + n + 3 * j) = (*contacts_)[j].multiply(moved, lambda.segment<3>(3 * j), on_[j]);
    });
    for (std::size_t j = 0; j < contacts_->size(); ++j)
        (*contacts_)[j].scatter(on_[j], lambda.segment<3>(3 * static_cast<Index>(j)), add);
    collect(by, z);
}

bool CondensedTangent::prepare(Timings& timings) {
    const ScopedTimer timer(timings, Part::factor);
    if (!factorised_) factorise_bodies();
    if (!usable_) return false;
    if (!schur_) {
        schur_ = schur_complement();
        ++factorisations_;
    }
    if (!schur_->factorised) factorise(*schur_);
    if (schur_->usable) return true;
    schur_ = nullptr;
    return false;
}

bool CondensedTangent::solve(const Unknowns& rows, std::span<const Mat3> D, const ConstVectorRef& b, VectorRef x,
                             double allowed, Timings& timings) {
    if (!prepare(timings)) return false;
    const ScopedTimer timer(timings, Part::solve);
    const Index equations = constraints_.equations(), n = first_.back();
    // equilibrium, and the forces of slave nodes that bear on nothing
    Vector r(equations);
    for (Index node = 0; node < constraints_.nodes(); ++node)
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held)
                r(e) = b[rows.equilibrium_row(node, k)];
    const auto law = [&](Index coupling) {
        Vec3 local;
        for (int k = 0; k < 3; ++k) local(k) = b[rows.contact_row(coupling, k)];
        return constraints_.to_global(slaves_[coupling], local);
    };
    std::vector<Vec3> lambda(slaves_.size());
    std::vector<char> bears(slaves_.size(), 0);
    for (const BearingContact& c : *contacts_) bears[c.law.coupling] = 1;
    for (std::size_t j = 0; j < slaves_.size(); ++j) {
        if (bears[j] != 0) continue;
        lambda[j] = D[j].inverse() * law(static_cast<Index>(j));
        const Vec3 local = constraints_.to_local(slaves_[j], lambda[j]);
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(slaves_[j], k); e != Constraints::held) r(e) += local(k);
    }
    Vector v(equations);
    for (const auto& body : bodies_) body->solve(r.data(), v.data());

    // x0 = P^-1 b: within the bodies it is exact
    const Index size = n + forces();
    Vector u(n), f = Vector::Zero(n), more(n), rest(size), y(size), right(forces());
    for (std::size_t body = 0; body < bodies_.size(); ++body)
        for (std::size_t i = 0; i < bodies_[body]->equations().size(); ++i)
            u(first_[body] + static_cast<Index>(i)) = v(bodies_[body]->equations()[i]);
    for (std::size_t j = 0; j < contacts_->size(); ++j)
        right.segment<3>(3 * static_cast<Index>(j)) = law((*contacts_)[j].law.coupling);
    Vector force = contact_forces(u, right.data());
    add_forces(force, f.data());
    apply_compliance(f.data(), more.data());
    u += more;

    // J x' = b - J x0 with x' = P^-1 y
    apply_contact(force, u, rest.data());
    rest = -rest;
    rest.tail(forces()) += right;
    bool worn = false;
    if (rest.norm() > allowed) {
        Vector lambda_y, u_y, f_y;
        if (size != gmres_size_) gmres_ = std::make_unique<solve::Gmres>(size, nullptr, threads_);
        gmres_size_ = size;
        const auto J = [&](const double* from, double* to) {
            precondition(from, lambda_y, u_y, f_y);
            apply_contact(lambda_y, u_y, to);
            Eigen::Map<Vector>(to, n) += Eigen::Map<const Vector>(from, n);
        };
        const auto result = gmres_->solve(J, {}, rest.data(), y.data(), allowed);
        worn = !result.converged || result.iterations > worth_keeping;
        if (!result.converged) {
            schur_ = nullptr;
            return false;
        }
        precondition(y.data(), lambda_y, u_y, f_y);
        force += lambda_y;
        f += f_y;
    }

    for (std::size_t body = 0; body < bodies_.size(); ++body)
        for (std::size_t i = 0; i < bodies_[body]->equations().size(); ++i)
            r(bodies_[body]->equations()[i]) += f(first_[body] + static_cast<Index>(i));
    for (const auto& body : bodies_) body->solve(r.data(), x.data());
    for (std::size_t j = 0; j < contacts_->size(); ++j)
        lambda[(*contacts_)[j].law.coupling] = force.segment<3>(3 * static_cast<Index>(j));
    for (std::size_t j = 0; j < slaves_.size(); ++j) {
        const Vec3 local = constraints_.to_local(slaves_[j], lambda[j]);
        for (int k = 0; k < 3; ++k) x[rows.multiplier(static_cast<Index>(j)) + k] = local(k);
    }
    if (worn) schur_ = nullptr;
    return true;
}

} // namespace osculate::linear
