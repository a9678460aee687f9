#include "osculate/app/run_checks.hpp"

#include "osculate/time/force_balance.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace osculate::app {

namespace {

double share(double part, double whole) {
    return whole > 0 ? part / whole : 0;
}

} // namespace

void RunChecks::accepted(const time::AcceptedStep& step) {
    const time::ForceBalance forces = time::force_balance(model_, step.equilibrium, step.state);
    left_over_ = std::max(left_over_, forces.left_over);
    acting_ = std::max(acting_, forces.acting);
    add_penetration(step);
    add_audit(step);
    if (!model_.cyclic.empty() && crossed_ < 0) add_crossing(step);
    rotations_.accepted(step.state, step.equilibrium.constraints());
    if (step.ledger == nullptr)
        contact_ = settling_ = 0; // the next dynamic stage opens a ledger of its own
    else
        add_energies(*step.ledger, step.stage);
}

void RunChecks::add_crossing(const time::AcceptedStep& step) {
    constexpr double least = 0.01; // of the facet size: ends that deform leave chords by less
    std::vector<char> ends(model_.X.size(), 0);
    for (const model::CyclicSymmetry& ring : model_.cyclic)
        for (const model::LikeNode& one : ring.nodes)
            ends[static_cast<std::size_t>(one.node)] = ends[static_cast<std::size_t>(one.like)] = 1;
    for (const model::ContactEvaluation& evaluation : step.equilibrium.contact()) {
        const model::ContactPair& pair = evaluation.pair();
        for (Index j = 0; j < pair.size() && crossed_ < 0; ++j) {
            const contact::FacetHit& hit = evaluation.hit(j);
            if (hit.facet < 0) continue;
            const double size = pair.surface().facet_size(hit.facet);
            if (!(hit.beyond > least * size) || hit.distance > size) continue;
            const auto on_end = std::ranges::count_if(pair.surface().facet_vertices(hit.facet), [&](Index v) {
                return ends[static_cast<std::size_t>(model::material_node(model_, pair.node(v)))] != 0;
            });
            if (on_end < 2) continue;
            crossed_ = pair.slaves().node[static_cast<std::size_t>(j)];
            crossed_time_ = step.state.time;
        }
    }
}

void RunChecks::add_penetration(const time::AcceptedStep& step) {
    const time::StepLimits& limits = step.stage.limits;
    std::size_t p = 0;
    for (const model::ContactEvaluation& evaluation : step.equilibrium.contact()) {
        const model::ContactPair& pair = evaluation.pair();
        const std::vector<Vec3>& lambda = step.state.contact[p++].lambda;
        for (Index j = 0; j < pair.size(); ++j) {
            const contact::ContactPoint& point = evaluation.point(j);
            // what has no partner and only seems to be behind a surface is for the audit to judge
            const bool seen = point.found || (point.behind && step.audit == nullptr);
            double gap = seen ? point.gap : evaluation.unseen_gap(j);
            if (point.found && pair.options().overclosure) // beyond what the pair gives way
                gap = evaluation.distance(j, lambda[static_cast<std::size_t>(j)]);
            const Index facet = seen ? point.facet : evaluation.facets()[j];
            if (facet < 0 || !(gap < 0)) continue;
            const double size = pair.surface().facet_size(facet), depth = -gap / size;
            penetration_ = std::max(penetration_, depth);
            penetration_m_ = std::max(penetration_m_, -gap);
            const double allowed = limits.allowed_interpenetration / (limits.in_metres ? size : 1);
            const double bound = expect_ && expect_->penetration                 ? *expect_->penetration
                                 : !limits.usual_bound && std::isfinite(allowed) ? allowed
                                                                                 : scene::Expectation::exact;
            if (depth / bound <= excess_) continue;
            excess_ = depth / bound;
            excessive_ = depth;
            bound_ = bound;
        }
    }
}

void RunChecks::add_audit(const time::AcceptedStep& step) {
    if (step.audit == nullptr) return;
    const contact::Intrusion* worst = step.audit->worst();
    if (worst == nullptr || !(worst->excess > 0)) return;
    if (deepest_.body < 0 || worst->relative() > deepest_.relative()) {
        deepest_ = *worst;
        deepest_time_ = step.state.time;
    }
    penetration_ = std::max(penetration_, worst->relative());
    penetration_m_ = std::max(penetration_m_, worst->excess);
    // what no scene bounds by itself has the audit's own bound
    if (!expect_ || !expect_->penetration || worst->relative() / *expect_->penetration <= excess_) return;
    bound_ = *expect_->penetration;
    excessive_ = worst->relative();
    excess_ = excessive_ / bound_;
}

output::Summary::Audit RunChecks::audit() const {
    output::Summary::Audit found;
    if (deepest_.body < 0) return found;
    const auto name = [&](Index body) { return model_.bodies[static_cast<std::size_t>(body)].name; };
    found.depth = deepest_.depth;
    found.excess = deepest_.excess;
    found.relative = deepest_.relative();
    found.body = name(deepest_.body);
    found.other = name(deepest_.other);
    found.node = deepest_.node - model_.bodies[static_cast<std::size_t>(deepest_.body)].first_node;
    found.time = deepest_time_;
    const Vec3 place = deepest_.place + model_.origin;
    found.place = {place.x(), place.y(), place.z()};
    return found;
}

void RunChecks::add_energies(const time::Ledger& ledger, const time::Stage& stage) {
    dynamic_ = true;
    const double dissipated = ledger.friction + ledger.damping + ledger.algorithmic;
    const double rise = ledger.contact + ledger.balance - dissipated, energy = ledger.kinetic + ledger.strain;
    // energy - rise - external is what there was at the start
    energy_ = std::max({energy_, energy, energy - rise - ledger.external, std::abs(ledger.external)});
    balance_ = std::max(balance_, std::abs(ledger.balance));
    growth_ = std::max(growth_, rise);
    closing_ += std::max(0.0, contact_ - ledger.contact);
    contact_ = ledger.contact;
    if (settles_by_rule_ && stage.limits.inelastic_impacts) settled_ += ledger.settling - settling_;
    settling_ = ledger.settling;
}

std::vector<double> RunChecks::memory() const {
    const contact::Intrusion& d = deepest_;
    std::vector<double> numbers{left_over_,
                                acting_,
                                penetration_,
                                penetration_m_,
                                excess_,
                                excessive_,
                                bound_,
                                dynamic_ ? 1.0 : 0.0,
                                energy_,
                                balance_,
                                growth_,
                                static_cast<double>(d.body),
                                static_cast<double>(d.other),
                                static_cast<double>(d.node),
                                d.depth,
                                d.excess,
                                d.length,
                                d.place.x(),
                                d.place.y(),
                                d.place.z(),
                                deepest_time_,
                                contact_,
                                closing_,
                                static_cast<double>(crossed_),
                                crossed_time_,
                                settles_by_rule_ ? 1.0 : 0.0,
                                settled_,
                                settling_};
    const std::vector<double> rotations = rotations_.memory();
    numbers.insert(numbers.end(), rotations.begin(), rotations.end());
    return numbers;
}

void RunChecks::recall(const std::vector<double>& memory) {
    double dynamic = 0, body = -1, other = -1, node = -1, crossed = -1, by_rule = 0;
    contact::Intrusion& d = deepest_;
    double* const members[] = {&left_over_,    &acting_,     &penetration_,  &penetration_m_, &excess_,  &excessive_,
                               &bound_,        &dynamic,     &energy_,       &balance_,       &growth_,  &body,
                               &other,         &node,        &d.depth,       &d.excess,       &d.length, &d.place.x(),
                               &d.place.y(),   &d.place.z(), &deepest_time_, &contact_,       &closing_, &crossed,
                               &crossed_time_, &by_rule,     &settled_,      &settling_};
    constexpr std::size_t count = std::size(members);
    if (memory.size() < count) throw std::runtime_error("the checkpoint holds no checks of the run");
    for (std::size_t i = 0; i < count; ++i) *members[i] = memory[i];
    rotations_.recall(std::span(memory).subspan(count));
    dynamic_ = dynamic != 0;
    settles_by_rule_ = settles_by_rule_ || by_rule != 0; // the scene of a run's folder has the rule's choice filled in
    d.body = static_cast<Index>(body);
    d.other = static_cast<Index>(other);
    d.node = static_cast<Index>(node);
    crossed_ = static_cast<Index>(crossed);
}

output::Summary::Checks RunChecks::checks() const {
    output::Summary::Checks checks;
    checks.force_balance = share(left_over_, acting_);
    checks.penetration = penetration_;
    checks.penetration_m = penetration_m_;
    checks.rotation_strain = rotations_.largest();
    if (dynamic_) {
        checks.energy_balance = share(balance_, energy_);
        checks.energy_growth = share(growth_, energy_);
        checks.closing_loss = share(closing_, energy_);
        if (settles_by_rule_) checks.settling_loss = share(settled_, energy_);
    }
    return checks;
}

std::vector<std::string> RunChecks::warnings() const {
    constexpr double much = 0.05; // a rebound at 0.975 of the exact speed
    std::vector<std::string> warnings;
    if (const std::optional<std::string> turned = rotations_.warning()) warnings.push_back(*turned);
    for (const model::Tie& tie : model_.ties)
        if (tie.left_out > 0 || tie.adjusted > tie.near)
            warnings.push_back(fmt::format("ties.{}: {} nodes of the slave are tied, moved by up to {:.3g} m; {} are "
                                           "not, which are beside the master or "
                                           "farther from it than `distance`",
                                           tie.name, tie.nodes.size(), tie.adjusted, tie.left_out));
    if (crossed_ >= 0) {
        const Vec3 X = model_.X[static_cast<std::size_t>(crossed_)] + model_.origin;
        warnings.push_back(fmt::format(
            "at {:.4g} s the slave node that began at ({:.4g}, {:.4g}, {:.4g}) m has left its master over the end of a "
            "sector: the next one would bear it, but contact does not see that. Choose ends that nothing slides over",
            crossed_time_, X.x(), X.y(), X.z()));
    }
    if (dynamic_ && share(settled_, energy_) > much)
        warnings.push_back(fmt::format(
            "impacts, which are inelastic by default with general contact, and the stiffness damping that goes with "
            "them took {:.2g} of the largest energy: rebounds are too small, and vibrations die out. Set impacts of "
            "the dynamic stages to resolved where these matter, to inelastic where bodies should come to rest",
            share(settled_, energy_)));
    if (dynamic_ && share(closing_, energy_) > much)
        warnings.push_back(
            fmt::format("gaps that closed took {:.2g} of the largest energy, and exact contact takes none: rebounds "
                        "are too slow. Smaller steps lose less: set control.step_size to controlled if it is fixed, "
                        "otherwise make control.closing_energy or solver.smallest_step smaller; nodes that keep their "
                        "mass (see check) lose its energy at every impact",
                        share(closing_, energy_)));
    return warnings;
}

std::optional<output::Summary::Expectation> RunChecks::judge(const std::string& failure) const {
    if (!expect_) return {};
    output::Summary::Expectation result;
    const auto miss = [&](std::string words) { result.misses.push_back(std::move(words)); };
    if (expect_->outcome == scene::Outcome::completed) {
        if (!failure.empty()) miss("gave up but should complete");
    } else if (failure.empty()) {
        miss("completed but should give up");
    } else if (failure.find(expect_->cause) == std::string::npos) {
        miss(fmt::format("gave up without the words '{}'", expect_->cause));
    }
    const output::Summary::Checks found = checks();
    if (found.force_balance > expect_->force_balance)
        miss(fmt::format("force balance {:.3g} above {:.3g}", found.force_balance, expect_->force_balance));
    if (found.energy_growth && *found.energy_growth > expect_->energy_growth)
        miss(fmt::format("energy growth {:.3g} above {:.3g}", *found.energy_growth, expect_->energy_growth));
    if (excess_ > 1) miss(fmt::format("penetration {:.3g} above {:.3g} facet sizes", excessive_, bound_));
    return result;
}

} // namespace osculate::app
