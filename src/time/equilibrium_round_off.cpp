/// Round-off in the residual: where positions lose digits, and how much of a row the last digits of its terms are.

#include "osculate/core/rounded_sum.hpp"
#include "osculate/time/equilibrium.hpp"

#include <cmath>
#include <limits>

namespace osculate::time {

using contact::Status;

namespace {
/// How much round-off a sum may gather, of the sum of the absolute values of its terms: a few last digits.
constexpr double last_digits = 10 * std::numeric_limits<double>::epsilon();
} // namespace

void Equilibrium::place() {
    for (std::size_t i = 0; i < x_.size(); ++i) tail_[i] = rounded_off(model_.X[i], u_[i], x_[i]);
}

Vec3 Equilibrium::law_terms(std::size_t p, Index j) const {
    const model::ContactEvaluation& evaluation = contact_[p];
    const model::ContactPair& pair = evaluation.pair();
    const contact::ContactPoint& point = evaluation.point(j);
    const Index slave = pair.slaves().node[j];
    Vec3 terms = lambda_[p][j].cwiseAbs();
    if (point.found && contact::is_closed(statuses_[p][j])) {
        const contact::ContactState state = evaluation.state(j, lambda_[p][j]);
        const contact::ContactResidual law = evaluation.law(j).residual(state, statuses_[p][j]);
        const Vec3 n = state.normal.cwiseAbs();
        // what gap and drift are differences of: displacements, and offsets within the patch, which cancel along n
        Vec3 moved = u_[slave].cwiseAbs();
        double offsets = 0;
        for (Index i = 0; i < evaluation.carriers(j); ++i) {
            const Index node = evaluation.point_nodes(j)[i];
            const double weight = std::abs(point.weights(i));
            if (pair.mirrored())
                moved.array() += weight * u_[node].norm();
            else
                moved += weight * u_[node].cwiseAbs();
            offsets += weight * n.dot((x_[node] - x_[slave]).cwiseAbs());
        }
        terms += law.value.cwiseAbs() + law.by_lambda.cwiseAbs() * lambda_[p][j].cwiseAbs() +
                 law.by_gap.cwiseAbs() * (offsets + n.dot(moved)) + law.by_drift.cwiseAbs() * moved;
    }
    return constraints_.frame(slave).cwiseAbs().transpose() * terms;
}

bool Equilibrium::at_round_off(const double* F) const {
    std::vector<Vec3> terms(u_.size(), Vec3::Zero());
    bodies_.add_terms(u_, terms);
    for (std::size_t i = 0; i < terms.size(); ++i) terms[i] += load_.force[i].cwiseAbs();
    const auto above = [&](Index row, double sum) { return !(std::abs(F[row]) <= last_digits * sum); };
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        const model::ContactEvaluation& evaluation = contact_[p];
        const model::ContactPair& pair = evaluation.pair();
        for (Index j = 0; j < pair.size(); ++j) {
            const Vec3 law = law_terms(p, j);
            for (int k = 0; k < 3; ++k)
                if (above(matrix_->contact_row(first_coupling_[p] + j, k), law(k))) return false;
            evaluation.for_each_force(j, lambda_[p][j],
                                      [&](Index node, const Vec3& force) { terms[node] += force.cwiseAbs(); });
        }
    }
    for (Index node = 0; node < model_.nodes(); ++node) {
        const Vec3 local = constraints_.frame(node).cwiseAbs().transpose() * terms[node];
        for (int k = 0; k < 3; ++k)
            if (const Index row = matrix_->equilibrium_row(node, k);
                row != model::Constraints::held && above(row, local(k)))
                return false;
    }
    return true;
}

bool Equilibrium::holds(const Vector& z, std::vector<std::vector<Status>> statuses, double tolerance) {
    set_statuses(std::move(statuses), StatusRule::frozen, false);
    Vector F(size_);
    if (residual(z.data(), F.data()) != Verdict::proceed) return false;
    if (F.cwiseAbs().maxCoeff() <= tolerance * reference_force_) return true;
    rests_ = at_round_off(F.data());
    return rests_;
}

} // namespace osculate::time
