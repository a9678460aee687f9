#include "osculate/equilibrium/contact_term.hpp"

#include "osculate/core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::equilibrium {

using contact::Status;
using linear::Constraints;

ContactTerm::ContactTerm(const model::ContactPairs& pairs, const linear::Constraints& constraints,
                         const linear::Unknowns& unknowns, Timings& timings, int threads)
    : pairs_(pairs), constraints_(constraints), unknowns_(unknowns), timings_(timings), threads_(threads),
      evaluations_(model::contact_evaluations(pairs)), first_{0} {
    for (model::ContactEvaluation& evaluation : evaluations_) {
        const std::vector<Index>& slaves = evaluation.pair().slaves().node;
        std::vector<char> held;
        for (const Index node : slaves) {
            bool any = false;
            for (int k = 0; k < 3; ++k)
                if (const auto* c = constraints.constraint(node, k))
                    any = any || !c->symmetry;
                else // dependent nodes have no equations of their own
                    any = any || constraints.equation(node, k) == Constraints::held;
            held.push_back(any);
        }
        evaluation.hold(std::move(held));
        first_.push_back(first_.back() + static_cast<Index>(slaves.size()));
        lambda_.emplace_back(slaves.size(), Vec3::Zero());
        statuses_.emplace_back(slaves.size(), Status::open);
    }
}

void ContactTerm::share_out(Ranks& ranks) {
    ranks_ = &ranks;
    for (model::ContactEvaluation& evaluation : evaluations_) evaluation.share_out(ranks);
}

void ContactTerm::set_statuses(Statuses statuses, StatusRule rule, bool force_first) {
    statuses_ = std::move(statuses);
    rule_ = rule;
    force_next_ = force_first;
}

void ContactTerm::set_inertia(const BodyForces& bodies) {
    for (model::ContactEvaluation& evaluation : evaluations_) {
        std::vector<double> inertia;
        for (const Index node : evaluation.pair().slaves().node) inertia.push_back(bodies.inertia(node));
        evaluation.set_inertia(std::move(inertia));
    }
}

double ContactTerm::least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const model::ContactEvaluation& evaluation : evaluations_) least = std::min(least, evaluation.least_gap());
    return least;
}

bool ContactTerm::can_hold_geometry() const {
    return std::ranges::all_of(evaluations_, [](const model::ContactEvaluation& evaluation) {
        return evaluation.pair().slaves().edges || evaluation.pair().options().discretisation == Discretisation::node;
    });
}

void ContactTerm::hold_geometry() {
    for (model::ContactEvaluation& evaluation : evaluations_) {
        evaluation.evaluate_all_here(threads_);
        evaluation.hold_geometry();
    }
}

void ContactTerm::let_go() {
    for (model::ContactEvaluation& evaluation : evaluations_) evaluation.let_go();
}

double ContactTerm::geometry_error(const Iterate& at) const {
    constexpr double along = 0.1; // what moves along a surface meets other normals only after a while
    double largest = 0;
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        const model::ContactEvaluation& held = evaluations_[p];
        model::ContactEvaluation now = held;
        now.evaluate(at.x, timings_, threads_, at.tail);
        for (Index j = 0; j < held.pair().size(); ++j) {
            const bool closed = contact::is_closed(statuses_[p][j]);
            const auto size = [&](const contact::ContactPoint& point) {
                return held.pair().surface().facet_size(point.facet);
            };
            if (now.point(j).found) {
                const double gap = now.distance(j, lambda_[p][j]);
                largest = std::max(largest, (closed ? std::abs(gap) : -gap) / size(now.point(j)));
            }
            if (closed && held.point(j).found)
                largest = std::max(largest, along * held.moved_since_held(j) / size(held.point(j)));
        }
    }
    return largest;
}

Vec3 ContactTerm::force(const ConstVectorRef& z, Index coupling) const {
    return constraints_.to_global(unknowns_.slave(coupling), Vec3(z.segment<3>(unknowns_.multiplier(coupling))));
}

void ContactTerm::pack(const std::vector<model::ContactHistory>& contact, VectorRef z) const {
    for (std::size_t p = 0; p < evaluations_.size(); ++p)
        for (std::size_t j = 0; j < contact[p].lambda.size(); ++j) {
            const Index coupling = first_[p] + static_cast<Index>(j);
            z.segment<3>(unknowns_.multiplier(coupling)) =
                constraints_.to_local(unknowns_.slave(coupling), contact[p].lambda[j]);
        }
}

bool ContactTerm::begin(const model::State& state, const Iterate& at, const StepLoad&, double dt) {
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        evaluations_[p].begin_step(at.x, state.contact[p], timings_, threads_, at.tail);
        if (dynamics_ == nullptr) continue;
        if (const double recovery = dynamics_->recovery_time; dt < recovery)
            evaluations_[p].keep_depths(1 - dt / recovery, at.x, timings_, threads_, at.tail);
        evaluations_[p].take_step(at.x, {dt, 1 - dynamics_->integrator.alpha_f}, timings_, threads_, at.tail);
    }
    return false;
}

bool ContactTerm::evaluate(const Iterate& at) {
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        for (Index j = 0; j < evaluations_[p].pair().size(); ++j) lambda_[p][j] = force(*at.z, first_[p] + j);
        evaluations_[p].evaluate(at.x, timings_, threads_, at.tail);
    }
    status_changes_ = 0;
    if (rule_ == StatusRule::natural && !force_next_) {
        Statuses statuses = natural_statuses();
        for (std::size_t p = 0; p < statuses.size(); ++p)
            for (std::size_t j = 0; j < statuses[p].size(); ++j) status_changes_ += statuses[p][j] != statuses_[p][j];
        statuses_ = std::move(statuses);
    }
    // a status that was imposed cannot hold where there is no contact partner
    for (std::size_t p = 0; p < statuses_.size(); ++p)
        for (Index j = 0; j < evaluations_[p].pair().size(); ++j)
            if (!evaluations_[p].point(j).found) statuses_[p][j] = Status::open;
    force_next_ = false;
    return true;
}

Statuses ContactTerm::natural_statuses() const {
    Statuses statuses;
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        const model::ContactEvaluation& evaluation = evaluations_[p];
        auto& list = statuses.emplace_back(lambda_[p].size(), Status::open);
        for (Index j = 0; j < evaluation.pair().size(); ++j)
            if (evaluation.point(j).found)
                list[j] = evaluation.law(j, lambda_[p][j]).status(evaluation.state(j, lambda_[p][j]));
    }
    return statuses;
}

Mat3 ContactTerm::symmetry_directions(Index node) const {
    Mat3 sum = Mat3::Zero();
    for (int k = 0; k < 3; ++k)
        if (const auto* c = constraints_.constraint(node, k); c != nullptr && c->symmetry) {
            const Vec3 e = constraints_.frame(node).col(k);
            sum += e * e.transpose();
        }
    return sum;
}

contact::ContactResidual ContactTerm::law(std::size_t p, Index j) const {
    const model::ContactEvaluation& evaluation = evaluations_[p];
    return evaluation.law(j, lambda_[p][j]).residual(evaluation.state(j, lambda_[p][j]), statuses_[p][j]);
}

void ContactTerm::add_forces(Field& f) const {
    for (std::size_t p = 0; p < evaluations_.size(); ++p)
        for (Index j = 0; j < evaluations_[p].pair().size(); ++j)
            evaluations_[p].for_each_force(j, lambda_[p][j], [&](Index node, const Vec3& force) { f[node] -= force; });
}

Index ContactTerm::write_rows(VectorRef F) const {
    Index without_gap = -1;
    for (std::size_t p = 0; p < evaluations_.size(); ++p)
        for (Index j = 0; j < evaluations_[p].pair().size(); ++j) {
            const Index coupling = first_[p] + j, slave = unknowns_.slave(coupling);
            const Vec3 value = law(p, j).value;
            const Mat3 mirrored = symmetry_directions(slave);
            const Vec3 local = constraints_.to_local(slave, Vec3(value - mirrored * value + mirrored * lambda_[p][j]));
            for (int k = 0; k < 3; ++k) F[unknowns_.contact_row(coupling, k)] = local(k);
            const contact::ContactPoint& point = evaluations_[p].point(j);
            if (point.found && !(std::isfinite(point.gap) && point.normal.allFinite())) {
                // it counts as open, and the law of an open node does not ask for its gap
                F[unknowns_.contact_row(coupling, 0)] = std::numeric_limits<double>::quiet_NaN();
                without_gap = slave;
            }
        }
    return without_gap;
}

void ContactTerm::add_magnitudes(const Iterate&, Field& sums) const {
    for (std::size_t p = 0; p < evaluations_.size(); ++p)
        for (Index j = 0; j < evaluations_[p].pair().size(); ++j)
            evaluations_[p].for_each_force(j, lambda_[p][j],
                                           [&](Index node, const Vec3& force) { sums[node] += force.cwiseAbs(); });
}

Vec3 ContactTerm::law_magnitudes(const Iterate& at, std::size_t p, Index j) const {
    const model::ContactEvaluation& evaluation = evaluations_[p];
    const contact::ContactPoint& point = evaluation.point(j);
    const Index slave = evaluation.pair().slaves().node[j];
    Vec3 terms = lambda_[p][j].cwiseAbs();
    if (point.found && contact::is_closed(statuses_[p][j])) {
        const contact::ContactResidual law = this->law(p, j);
        const Vec3 n = point.normal.cwiseAbs();
        // what gap and drift are differences of: displacements, and offsets within the patch, which cancel along n
        Vec3 moved = at.u[slave].cwiseAbs();
        double offsets = 0;
        for (Index i = 0; i < evaluation.carriers(j); ++i) {
            const Index node = evaluation.point_nodes(j)[i];
            const double weight = std::abs(point.weights(i));
            if (evaluation.pair().mirrored())
                moved.array() += weight * at.u[node].norm();
            else
                moved += weight * at.u[node].cwiseAbs();
            offsets += weight * n.dot((at.x[node] - at.x[slave]).cwiseAbs());
        }
        terms += law.value.cwiseAbs() + law.by_lambda.cwiseAbs() * lambda_[p][j].cwiseAbs() +
                 law.by_gap.cwiseAbs() * (offsets + n.dot(moved)) + law.by_drift.cwiseAbs() * moved;
    }
    return constraints_.frame(slave).cwiseAbs().transpose() * terms;
}

bool ContactTerm::rows_within(const Iterate& at, const Field& sums, const ConstVectorRef& F, double share) const {
    // a contact force that grows without bound makes any gap its round-off
    constexpr double no_gap = 1e-6; // of the facet size
    for (std::size_t p = 0; p < evaluations_.size(); ++p)
        for (Index j = 0; j < evaluations_[p].pair().size(); ++j) {
            const contact::ContactPoint& point = evaluations_[p].point(j);
            const Index slave = evaluations_[p].pair().slaves().node[j];
            if (point.found && contact::is_closed(statuses_[p][j])) {
                if (!(std::abs(evaluations_[p].distance(j, lambda_[p][j])) <=
                      no_gap * evaluations_[p].pair().surface().facet_size(point.facet)))
                    return false;
            }
            // what the solution of a linear system leaves of the other forces at the nodes that contact joins
            Vec3 others = sums[slave];
            if (point.found)
                for (Index i = 0; i < evaluations_[p].carriers(j); ++i)
                    others += std::abs(point.weights(i)) * sums[evaluations_[p].point_nodes(j)[i]];
            const Vec3 terms = law_magnitudes(at, p, j) + constraints_.frame(slave).cwiseAbs().transpose() * others;
            for (int k = 0; k < 3; ++k)
                if (!(std::abs(F[unknowns_.contact_row(first_[p] + j, k)]) <= share * terms(k))) return false;
        }
    return true;
}

bool ContactTerm::reaches(std::size_t p, Index j) const {
    return evaluations_[p].point(j).found &&
           (contact::is_closed(statuses_[p][j]) || !lambda_[p][j].isZero(0) || evaluations_[p].drag(j) > 0);
}

void ContactTerm::complete(const ConstVectorRef& z, model::State& state) const {
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        const model::ContactEvaluation& evaluation = evaluations_[p];
        model::ContactHistory history{pairs_[p],           std::vector<Vec3>(statuses_[p].size()),
                                      statuses_[p],        evaluation.facets(),
                                      evaluation.master(), evaluation.slides(statuses_[p])};
        for (Index j = 0; j < evaluation.pair().size(); ++j) {
            history.lambda[j] = force(z, first_[p] + j);
            // open nodes carry nothing: what is left is the solver's round-off
            if (statuses_[p][j] == Status::open && !(evaluation.drag(j) > 0)) history.lambda[j].setZero();
        }
        state.contact.push_back(std::move(history));
    }
}

} // namespace osculate::equilibrium
