/// ContactEvaluation where several processes share a run.

#include "osculate/model/contact_evaluation.hpp"

#include <algorithm>
#include <type_traits>

namespace osculate::model {

namespace {
/// Slave nodes in contact take more evaluations of variations, and products; the others may have no point at all.
constexpr int work_closed = 4, work_open = 1;
/// General contact has many small pairs: with fewer slave nodes, telling takes longer than evaluating all.
constexpr Index worth_telling = 1000;

class Writer {
public:
    explicit Writer(std::vector<double>& numbers) : numbers_(numbers) {}
    void add(double number) { numbers_.push_back(number); }
    template <class Values> void add_all(const Values& values) {
        for (const auto value : values) add(static_cast<double>(value));
    }

private:
    std::vector<double>& numbers_;
};

class Reader {
public:
    explicit Reader(const double* at) : at_(at) {}
    [[nodiscard]] const double* at() const { return at_; }
    double number() { return *at_++; }
    Index index() { return static_cast<Index>(number()); }
    template <class Values> void fill(Values&& values) {
        for (auto& value : values) value = static_cast<std::remove_reference_t<decltype(value)>>(number());
    }

private:
    const double* at_;
};

/// All but ContactPoint::trace.
void pack(const contact::ContactPoint& point, std::vector<double>& numbers) {
    Writer to(numbers);
    to.add_all(std::vector<Index>{point.found ? 1 : 0, point.behind ? 1 : 0, point.facet, point.side});
    to.add(point.gap);
    if (!point.found) return;
    to.add_all(point.normal);
    to.add_all(point.foot);
    to.add(static_cast<double>(point.nodes.size()));
    to.add_all(point.nodes);
    to.add(static_cast<double>(point.weights.size()));
    to.add_all(point.weights);
    to.add(static_cast<double>(point.pressing.rows()));
    numbers.insert(numbers.end(), point.pressing.data(), point.pressing.data() + point.pressing.size());
}

const double* unpack(const double* numbers, contact::ContactPoint& point) {
    Reader from(numbers);
    point.found = from.number() != 0;
    point.behind = from.number() != 0;
    point.facet = from.index();
    point.side = from.index();
    point.gap = from.number();
    point.nodes.clear();
    if (!point.found) return from.at();
    from.fill(point.normal);
    from.fill(point.foot);
    point.nodes.resize(static_cast<std::size_t>(from.index()));
    from.fill(point.nodes);
    point.weights.resize(from.index());
    from.fill(point.weights);
    const Index rows = from.index();
    point.pressing = Eigen::Map<const contact::MatrixX3>(from.at(), rows, 3);
    return from.at() + 3 * rows;
}

} // namespace

const contact::SlaveShare* ContactEvaluation::shared_points() const {
    const SlaveNodes& slaves = pair_->slaves();
    const bool general = !slaves.around.empty() || !slaves.along.empty();
    const bool alike = slaves.edges || slaves.own || (general && pair_->size() < worth_telling);
    return alike ? nullptr : share();
}

void ContactEvaluation::share_out_by_work(const ContactHistory& history) {
    std::vector<int> work;
    for (const contact::Status status : history.status)
        work.push_back(contact::is_closed(status) ? work_closed : work_open);
    share_->share_out(work);
}

void ContactEvaluation::exchange_hits() {
    share_->exchange(
        [&](Index j, std::vector<double>& numbers) {
            const contact::FacetHit& hit = tracking_.hits[j];
            numbers.insert(numbers.end(),
                           {static_cast<double>(hit.facet), hit.u.x(), hit.u.y(), hit.distance, hit.overhang,
                            hit.beyond, hit.boundary ? 1.0 : 0.0, hit.latched ? 1.0 : 0.0, hit.limited ? 1.0 : 0.0});
        },
        [&](Index j, const double* numbers) {
            Reader from(numbers);
            contact::FacetHit& hit = tracking_.hits[j];
            hit.facet = from.index();
            from.fill(hit.u);
            hit.distance = from.number();
            hit.overhang = from.number();
            hit.beyond = from.number();
            hit.boundary = from.number() != 0;
            hit.latched = from.number() != 0;
            hit.limited = from.number() != 0;
            return from.at();
        });
}

void ContactEvaluation::exchange_points() {
    const contact::PairPositions at = positions();
    const bool rounds = !tails_.slaves.empty();
    rounded_.resize(points_.size(), 0);
    share_->exchange(
        [&](Index j, std::vector<double>& numbers) {
            rounded_[j] = rounds && points_[j].found ? discretisation_->gap_rounded_off(j, at, points_[j]) : 0;
            numbers.push_back(rounded_[j]);
            pack(points_[j], numbers);
            discretisation_->pack(j, numbers);
        },
        [&](Index j, const double* numbers) {
            rounded_[j] = *numbers++;
            return discretisation_->unpack(j, unpack(numbers, points_[j]));
        });
}

void ContactEvaluation::evaluate_all_here(int threads) {
    if (tracking_.share == nullptr || holds_geometry()) return;
    tracking_.share = nullptr;
    discretisation_->evaluate(positions(), tracking_, points_, threads);
}

} // namespace osculate::model
