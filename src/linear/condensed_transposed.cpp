/// The transposed system on the nodes of the contact pairs. With weights w of the rows of equilibrium, on the contact nodes w_c, and v
/// of those of contact laws,
///     K w + G^T w_c + A^T v = b_u,    E^T w_c + D^T v = b_lambda
/// and in P^T, K w + C^T B^T v = b_u and -C w_c + D^T v = b_lambda: T^T solves it.

#include "osculate/linear/condensed_tangent.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace osculate::linear {

namespace {
/// GMRES iterations beyond which T is worth making anew.
constexpr int worth_keeping_transposed = 12;
} // namespace

Vector CondensedTangent::law_weights(const Vector& u, const double* r) const {
    Vector v;
    relative(*schur_, u.data(), v);
    v.head(forces()) += Eigen::Map<const Vector>(r, forces());
    schur_->T.solve_transposed(v.data());
    return v;
}

void CondensedTangent::subtract_laws(const Vector& weights, double* reduced) const {
    Vector forces(weights.size());
    for (std::size_t j = 0; j < schur_->terms.size(); ++j) {
        const Index at = 3 * static_cast<Index>(j);
        forces.segment<3>(at).noalias() = -schur_->B[j].transpose() * weights.segment<3>(at);
    }
    add_forces(forces, reduced);
}

bool CondensedTangent::solve_transposed(const Unknowns& rows, std::span<const Mat3> D, const TransposedContact& contact,
                                        const ConstVectorRef& b, VectorRef w, double tolerance, Timings& timings) {
    if (!prepare(timings)) return false;
    const ScopedTimer timer(timings, Part::solve);
    const Index equations = constraints_.equations(), n = first_.back(), size = n + forces();
    double stiffness = 0;
    for (const BearingContact& c : *contacts_) stiffness = std::max(stiffness, c.law.c);
    if (!(stiffness > 0)) stiffness = 1;
    const double allowed =
        tolerance * std::hypot(b.head(equations).norm(), stiffness * b.tail(b.size() - equations).norm());
    const auto of_force = [&](Index coupling) {
        return constraints_.to_global(slaves_[coupling], b.segment<3>(rows.multiplier(coupling)));
    };

    Field of_nodes(static_cast<std::size_t>(constraints_.nodes())), by_nodes = of_nodes;
    std::vector<Vec3> of_laws(slaves_.size(), Vec3::Zero()), by_forces = of_laws;
    // z = (-C^T B^T v + G^T u + A^T v, E^T u + D^T v) of contacts alone: springs cancel
    const auto apply_contact = [&](const Vector& v, const Vector& u, double* z) {
        Vector bearing = v;
        bearing.tail(v.size() - forces()).setZero();
        std::fill_n(z, n, 0.0);
        subtract_laws(bearing, z);
        Nodal nodal;
        spread(u.data(), nodal);
        for (std::size_t c = 0; c < nodes_.size(); ++c) {
            of_nodes[nodes_[c]] = nodal[c];
            by_nodes[nodes_[c]].setZero();
        }
        for (std::size_t j = 0; j < contacts_->size(); ++j) {
            const Index coupling = (*contacts_)[j].law.coupling;
            of_laws[coupling] = v.segment<3>(3 * static_cast<Index>(j));
            by_forces[coupling].setZero();
        }
        contact(of_nodes, of_laws, by_nodes, by_forces);
        for (std::size_t c = 0; c < nodes_.size(); ++c) nodal[c] = by_nodes[nodes_[c]];
        collect(nodal, z);
        for (std::size_t j = 0; j < contacts_->size(); ++j)
            Eigen::Map<Vec3>(z + n + 3 * static_cast<Index>(j)) = by_forces[(*contacts_)[j].law.coupling];
    };

    Vector r = b.head(equations), w_u(equations);
    for (const auto& body : bodies_) body->solve(r.data(), w_u.data());

    // x0 = P^-T b: within the bodies it is exact
    Vector u(n), f = Vector::Zero(n), more(n), rest(size), y(size), right(forces());
    for (std::size_t body = 0; body < bodies_.size(); ++body)
        for (std::size_t i = 0; i < bodies_[body]->equations().size(); ++i)
            u(first_[body] + static_cast<Index>(i)) = w_u(bodies_[body]->equations()[i]);
    for (std::size_t j = 0; j < contacts_->size(); ++j)
        right.segment<3>(3 * static_cast<Index>(j)) = of_force((*contacts_)[j].law.coupling);
    Vector v = law_weights(u, right.data());
    subtract_laws(v, f.data());
    apply_compliance(f.data(), more.data());
    u += more;

    // J^T x' = b - J^T x0 with x' = P^-T y
    apply_contact(v, u, rest.data());
    rest = -rest;
    rest.tail(forces()) += right;
    rest.tail(forces()) *= stiffness;
    bool worn = false;
    if (rest.norm() > allowed) {
        Vector v_y, u_y(n), f_y, unscaled(forces());
        const auto precondition = [&](const double* from) {
            unscaled = Eigen::Map<const Vector>(from + n, forces()) / stiffness;
            apply_compliance(from, u_y.data());
            v_y = law_weights(u_y, unscaled.data());
            f_y = Eigen::Map<const Vector>(from, n);
            subtract_laws(v_y, f_y.data());
            apply_compliance(f_y.data(), u_y.data());
        };
        if (size != gmres_size_) gmres_ = std::make_unique<solve::Gmres>(size, nullptr, threads_);
        gmres_size_ = size;
        const auto J = [&](const double* from, double* to) {
            precondition(from);
            apply_contact(v_y, u_y, to);
            Eigen::Map<Vector>(to, n) += Eigen::Map<const Vector>(from, n);
            Eigen::Map<Vector>(to + n, forces()) *= stiffness;
        };
        const auto result = gmres_->solve(J, {}, rest.data(), y.data(), allowed);
        worn = !result.converged || result.iterations > worth_keeping_transposed;
        if (!result.converged) {
            schur_ = nullptr;
            return false;
        }
        precondition(y.data());
        v += v_y;
        f += f_y;
    }

    for (std::size_t body = 0; body < bodies_.size(); ++body)
        for (std::size_t i = 0; i < bodies_[body]->equations().size(); ++i)
            r(bodies_[body]->equations()[i]) += f(first_[body] + static_cast<Index>(i));
    for (const auto& body : bodies_) body->solve(r.data(), w_u.data());
    for (Index node = 0; node < constraints_.nodes(); ++node)
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held)
                w[rows.equilibrium_row(node, k)] = w_u(e);
    std::vector<char> bears(slaves_.size(), 0);
    const auto write = [&](Index coupling, const Vec3& weight) {
        const Vec3 local = constraints_.to_local(slaves_[coupling], weight);
        for (int k = 0; k < 3; ++k) w[rows.contact_row(coupling, k)] = local(k);
    };
    for (std::size_t j = 0; j < contacts_->size(); ++j) {
        const Index coupling = (*contacts_)[j].law.coupling;
        bears[coupling] = 1;
        write(coupling, v.segment<3>(3 * static_cast<Index>(j)));
    }
    for (Index coupling = 0; coupling < static_cast<Index>(slaves_.size()); ++coupling) {
        if (bears[coupling] != 0) continue; // its force acts on its slave node, and on nothing else
        Vec3 local = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(slaves_[coupling], k); e != Constraints::held) local(k) = w_u(e);
        write(coupling, D[coupling].transpose().inverse() *
                            (of_force(coupling) + constraints_.to_global(slaves_[coupling], local)));
    }
    if (worn) schur_ = nullptr;
    return true;
}

} // namespace osculate::linear
