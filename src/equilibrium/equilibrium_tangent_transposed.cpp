/// Solutions with the transposed tangent.

#include "osculate/equilibrium/equilibrium_tangent.hpp"
#include "osculate/solve/direct_solver.hpp"
#include "osculate/solve/gmres.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::equilibrium {

namespace {

/// Without entries that are zero, of which there are many: rows have room for contact that moves on.
solve::SparseMatrix transposed(const solve::SparseMatrix& A) {
    const auto each = [&](auto&& entry) {
        for (solve::SparseIndex row = 0; row < A.rows(); ++row)
            for (auto k = A.row_start[row]; k < A.row_start[row + 1]; ++k)
                if (A.value[k] != 0) entry(row, A.column[k], A.value[k]);
    };
    solve::SparseMatrix T;
    T.row_start.assign(A.row_start.size(), 0);
    each([&](auto, auto column, double) { ++T.row_start[column + 1]; });
    for (std::size_t i = 1; i < T.row_start.size(); ++i) T.row_start[i] += T.row_start[i - 1];
    T.column.resize(T.row_start.back());
    T.value.resize(T.column.size());
    std::vector<solve::SparseIndex> next(T.row_start.begin(), T.row_start.end() - 1);
    each([&](auto row, auto column, double value) {
        const solve::SparseIndex at = next[column]++;
        T.column[at] = row;
        T.value[at] = value;
    });
    T.pattern = T.revision = 1;
    return T;
}

} // namespace

void EquilibriumTangent::linearise_transposed() {
    // a matrix is read once for each product; blocks of single slave nodes overlap and take several times as long
    transposed_ = multigrid_ || condensed_ ? std::nullopt : std::optional(transposed(jacobian()));
    if (transposed_) return;
    update_stiffness();
    for (Term* term : terms_) term->linearise_transposed(at_);
}

void EquilibriumTangent::add_transposed(const Weights& of, Weights& by) {
    update_stiffness();
    for (Term* term : terms_) {
        term->linearise_transposed(at_);
        term->add_transposed(of, by);
    }
}

void EquilibriumTangent::multiply_transposed(const ConstVectorRef& w, VectorRef b) {
    if (transposed_) {
        transposed_->multiply(w.data(), b.data());
        return;
    }
    unpack_rows(w, weights_of_);
    weights_by_.nodes.reset(at_.u.size());
    weights_by_.couplings.assign(weights_of_.couplings.size(), Vec3::Zero());
    for (const Term* term : terms_) term->add_transposed(weights_of_, weights_by_);
    pack_unknowns(weights_by_, b);
}

void EquilibriumTangent::unpack_rows(const ConstVectorRef& w, Weights& of) const {
    of.nodes.reset(at_.u.size());
    for (Index node = 0; node < constraints_.nodes(); ++node) {
        Vec3 local = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (const Index row = unknowns_.equilibrium_row(node, k); row != Constraints::held) local(k) = w[row];
        of.nodes[node] = constraints_.to_global(node, local);
    }
    of.couplings.resize(static_cast<std::size_t>(unknowns_.couplings()));
    for (Index j = 0; j < unknowns_.couplings(); ++j) {
        Vec3 local;
        for (int k = 0; k < 3; ++k) local(k) = w[unknowns_.contact_row(j, k)];
        of.couplings[j] = constraints_.to_global(unknowns_.slave(j), local);
    }
}

void EquilibriumTangent::pack_unknowns(const Weights& by, VectorRef b) const {
    constraints_.gather(by.nodes, b);
    for (Index j = 0; j < unknowns_.couplings(); ++j)
        b.segment<3>(unknowns_.multiplier(j)) = constraints_.to_local(unknowns_.slave(j), by.couplings[j]);
}

bool EquilibriumTangent::solve_condensed(const Vector& b, Vector& w, double tolerance) {
    constexpr int most_corrections = 2;
    if (!condensed_ || transposed_) return false;
    linear::CondensedTangent& condensed = condensed_->tangent_for(contact_.bearing());
    if (!condensed.covers(contact_.bearing())) return false;
    condensed.set(contact_.bearing());
    const auto contact = [&](const Field& of_nodes, const std::vector<Vec3>& of_laws, Field& by_nodes,
                             std::vector<Vec3>& by_forces) {
        contact_.add_transposed(of_nodes, of_laws, by_nodes, by_forces);
    };
    double stiffness = 0; // residuals are in one unit, see below
    for (const linear::BearingContact& one : contact_.bearing()) stiffness = std::max(stiffness, one.law.c);
    if (!(stiffness > 0)) stiffness = 1;
    const Index forces = 3 * unknowns_.couplings();
    const auto size_of = [&](const Vector& x) {
        return std::hypot(x.head(x.size() - forces).norm(), stiffness * x.tail(forces).norm());
    };
    Vector left = b, more(b.size()), product(b.size());
    for (int k = 0; k <= most_corrections; ++k) {
        const double allowed = tolerance * size_of(b) / size_of(left);
        if (!condensed.solve_transposed(unknowns_, contact_.open_laws(), contact, left, more, allowed, timings_))
            return false;
        if (!more.allFinite()) return false;
        w += more;
        multiply_transposed(w, product);
        left = b - product;
        if (size_of(left) <= 2 * tolerance * size_of(b)) return true; // its own measure, and round-off
    }
    return false;
}

bool EquilibriumTangent::solve_transposed(const Weights& weights, Vector& w, Weights& of, double tolerance) {
    require(slices_ == nullptr, "a transposed tangent is that of one process");
    constexpr int worth_keeping = 20; // iterations beyond which factors are worth making anew
    constexpr int most_restarts = 5;
    const Index size = unknowns_.size(), forces = 3 * unknowns_.couplings();
    Vector b(size);
    pack_unknowns(weights, b);
    w.setZero(size);
    bool done = b.isZero(0) || solve_condensed(b, w, tolerance), fresh = false;
    if (!done) w.setZero();
    if (!done && condensed_ && !transposed_) transposed_ = transposed(jacobian());
    while (!done) {
        if (worn_) {
            if (fresh || factorise() != solve::FactorStatus::ok) break;
            fresh = true;
            worn_ = false;
        }
        // unknowns of forces count by the stiffness of contact, so that all residuals are in one unit
        double stiffness = 0;
        for (const linear::SoftContact& contact : preconditioner_->contacts())
            stiffness = std::max(stiffness, contact.c);
        if (!(stiffness > 0)) stiffness = 1;
        Vector left(size), more(size), product(size), unscaled(size);
        const auto scale = [&](VectorRef y, double by_what) { y.tail(forces) *= by_what; };
        const auto J = [&](const double* x, double* y) {
            Eigen::Map<Vector> to(y, size);
            multiply_transposed(Eigen::Map<const Vector>(x, size), to);
            scale(to, stiffness);
        };
        const auto P = [&](const double* x, double* y) {
            unscaled = Eigen::Map<const Vector>(x, size);
            scale(unscaled, 1 / stiffness);
            preconditioner_->apply_transposed(unknowns_, unscaled, Eigen::Map<Vector>(y, size));
        };
        Vector right = b;
        scale(right, stiffness);
        const double allowed = tolerance * right.norm();
        solve::Gmres gmres(size);
        int iterations = 0;
        for (int k = 0; k < most_restarts && !done; ++k) {
            multiply_transposed(w, product);
            scale(product, stiffness);
            left = right - product;
            done = left.norm() <= allowed;
            if (done) break;
            const auto result = gmres.solve(J, P, left.data(), more.data(), 0.5 * allowed);
            iterations += result.iterations;
            if (!more.allFinite()) break;
            w += more;
            done = result.converged;
        }
        worn_ = !done || iterations > worth_keeping;
        if (!done && fresh) break;
        if (!done) w.setZero();
    }
    if (!done && !solve_transposed_directly(b, w)) return false;
    unpack_rows(w, of);
    return w.allFinite();
}

bool EquilibriumTangent::solve_transposed_directly(const Vector& b, Vector& w) {
    if (!transposed_) transposed_ = transposed(jacobian());
    const auto solver = solve::make_lu();
    if (solver->factorise(*transposed_) != solve::FactorStatus::ok) return false;
    solver->solve(b.data(), w.data());
    constexpr double of_factors = 1e-6; // what a tangent that is all but singular leaves more of
    Vector product(b.size());
    transposed_->multiply(w.data(), product.data());
    return (product - b).norm() <= of_factors * b.norm();
}

} // namespace osculate::equilibrium
