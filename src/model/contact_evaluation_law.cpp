/// The law of contact at a slave node: exact, yielding, or of an interface that gives way.

#include "osculate/model/contact_evaluation.hpp"

#include <algorithm>

namespace osculate::model {

namespace {
/// Stick stiffness of held slave nodes over c: elastic slip far below the elastic displacements of the bodies.
constexpr double held_stick_stiffness = 100;
/// Part of its own compliance by which a contact yields that may hold the same place as others.
constexpr double shared_yield = 0.01;
/// The same at most for pairs that are soft: c, which results do not depend on, is no more than this part of their stiffness.
constexpr double most_yield = 0.5;
/// Least area that a force of a soft pair presses on, of the node's: at the edge of the master it goes to zero.
constexpr double least_area = 1e-6;
} // namespace

double ContactEvaluation::soft_area(Index j) const {
    return std::max(area(j), least_area * pair_->slaves().area[j]);
}

ContactEvaluation::GivesWay ContactEvaluation::gives_way(Index j, const Vec3& lambda) const {
    const double area = soft_area(j);
    const contact::Overclosure::Point at = pair_->options().overclosure->at(lambda.dot(points_[j].normal) / area);
    return {at.overclosure, at.compliance / area};
}

double ContactEvaluation::friction(Index j) const {
    const ContactOptions& options = pair_->options();
    return slides_.empty() || slides_[static_cast<std::size_t>(j)] != 0 ? options.friction : options.static_friction;
}

std::vector<char> ContactEvaluation::slides(const std::vector<contact::Status>& statuses) const {
    std::vector<char> result = slides_; // what flies goes on as it was
    for (std::size_t j = 0; j < result.size(); ++j)
        if (contact::is_closed(statuses[j])) result[j] = statuses[j] == contact::Status::slip ? 1 : 0;
    return result;
}

double ContactEvaluation::drag(Index j) const {
    const double damping = pair_->options().tangential_damping;
    // not for what closes now: there is no equilibrium where the force of a touch lifts it again
    const bool touched = damping > 0 && step_.dt > 0 && points_[j].found && !status_start_.empty() &&
                         contact::is_closed(status_start_[static_cast<std::size_t>(j)]);
    return touched ? damping * soft_area(j) / step_.dt : 0;
}

double ContactEvaluation::stiffness(Index j, const Vec3& lambda) const {
    if (!overclosure_start_.empty()) return law_of_means(j).parameter();
    const double c = pair_->slaves().stiffness[j] + inertia_[j];
    return pair_->options().overclosure ? std::min(c, most_yield / gives_way(j, lambda).compliance) : c;
}

contact::Coulomb ContactEvaluation::law(Index j, const Vec3& lambda) const {
    if (!overclosure_start_.empty()) return law_of_means(j);
    const ContactOptions& options = pair_->options();
    const double c = stiffness(j, lambda), friction = this->friction(j), drag = this->drag(j);
    const bool yields = this->yields(j), soft = options.overclosure.has_value(), slips = options.stick_stiffness > 0;
    if (!yields && !soft && !slips && !(drag > 0) && held_[j] == 0) return {friction, c};
    const bool sticks_exactly = !yields && !slips && held_[j] == 0;
    const double spring = slips ? options.stick_stiffness * soft_area(j) : held_stick_stiffness * c;
    contact::Coulomb law = sticks_exactly ? contact::Coulomb(friction, c)
                                          : contact::Coulomb::elastic(friction, c, spring, lambda_start_[j]);
    law.resist(drag);
    if (yields) {
        law.yield(shared_yield);
    } else if (soft) {
        const GivesWay gives = this->gives_way(j, lambda);
        law.yield(c * gives.compliance, gives.overclosure - gives.compliance * lambda.dot(points_[j].normal));
    }
    return law;
}

void ContactEvaluation::take_step(const std::vector<Vec3>& x, const DynamicStep& step, Timings& timings, int threads,
                                  const std::vector<Vec3>& tails) {
    step_ = step;
    if (!pair_->options().overclosure) return;
    evaluate(x, timings, threads, tails);
    for (Index j = 0; j < pair_->size(); ++j) // what comes from beside the master begins to touch where it is seen
        overclosure_start_.push_back(points_[j].found ? -states_[j].gap : pair_->options().overclosure->first());
    forget_path();
}

contact::Overclosure::Mean ContactEvaluation::mean_force(Index j) const {
    const contact::Overclosure& law = *pair_->options().overclosure;
    const double start = overclosure_start_[j], end = -states_[j].gap, first = law.first(), area = soft_area(j);
    contact::Overclosure::Mean mean = law.mean(start, end);
    const double late = step_.weight - 0.5, rate = pair_->options().damping / step_.dt;
    mean.pressure +=
        late * (law.pressure(end) - law.pressure(start)) + rate * (std::max(end, first) - std::max(start, first));
    if (end > first) mean.slope += late / law.at(law.pressure(end)).compliance + rate;
    return {area * mean.pressure, area * mean.slope};
}

contact::Coulomb ContactEvaluation::law_of_means(Index j) const {
    constexpr double least_slope = 1e-6; // of that where contact begins: the mean of a step begins with none
    const contact::Overclosure& law = *pair_->options().overclosure;
    const double first_slope = soft_area(j) / law.at(0).compliance;
    const contact::Overclosure::Mean mean = mean_force(j);
    const bool apart = !(mean.pressure > 0) && -states_[j].gap <= law.first();
    const double slope = apart ? first_slope : std::max(mean.slope, least_slope * first_slope),
                 from = apart ? law.first() : -states_[j].gap - mean.pressure / slope, friction = this->friction(j);
    contact::Coulomb result =
        held_[j] == 0 ? contact::Coulomb(friction, slope)
                      : contact::Coulomb::elastic(friction, slope, held_stick_stiffness * slope, lambda_start_[j]);
    result.resist(drag(j));
    result.yield(1, from); // lambda . n = -slope (g + from), the tangent of the mean force; open where that would pull
    return result;
}

double ContactEvaluation::stored(Index j) const {
    const auto& law = pair_->options().overclosure;
    return law && points_[j].found ? soft_area(j) * law->energy(-states_[j].gap) : 0;
}

Taken ContactEvaluation::taken(Index j, const Vec3& lambda) const {
    if (overclosure_start_.empty() || !points_[j].found) return {};
    const contact::Overclosure& law = *pair_->options().overclosure;
    const double start = overclosure_start_[j], end = -states_[j].gap, force = lambda.dot(points_[j].normal),
                 late = force > 0 ? step_.weight - 0.5 : 0;
    Taken taken;
    taken.algorithmic = soft_area(j) * late * (law.pressure(end) - law.pressure(start)) * (end - start);
    taken.damping = force * (end - start) - soft_area(j) * (law.energy(end) - law.energy(start)) - taken.algorithmic;
    return taken;
}

} // namespace osculate::model
