#include "app/plan/elimination.hpp"

#include <algorithm>

namespace osculate::app {

namespace {
/// A factor below this is round-off, of the largest of its equation, or of a unit vector.
constexpr double no_factor = 1e-12, aligned = 1e-9;
/// A node early in the equation leads if its factor is at least this of the largest.
constexpr double large_enough = 0.1;
} // namespace

HeldDirections::HeldDirections(const std::vector<time::Stage>& stages) {
    for (const time::Stage& stage : stages) {
        Constraints& at = stages_.emplace_back();
        for (const linear::NodeConstraint& c : stage.constraints) {
            at[c.node].push_back(&c);
            Mat3& P = all_.try_emplace(c.node, Mat3::Zero()).first->second;
            const Vec3 d = c.direction - P * c.direction;
            if (d.norm() > aligned) P += d * d.transpose() / d.squaredNorm();
        }
    }
}

Vec3 HeldDirections::part(Index node, const Vec3& factor) const {
    const auto at = all_.find(node);
    return at != all_.end() ? Vec3(at->second * factor) : Vec3(Vec3::Zero());
}

bool HeldDirections::satisfy(const EquationRow& row) const {
    return std::ranges::all_of(stages_, [&](const Constraints& stage) {
        std::map<Index, double> by_course; // and -1
        double largest = 0;
        for (const auto& [node, factor] : row) {
            const auto at = stage.find(node);
            if (at == stage.end()) return false;
            Vec3 left = factor; // along what is not held yet; directions are parallel or orthogonal to one another
            for (const linear::NodeConstraint* c : at->second) {
                const double along = left.dot(c->direction);
                left -= along * c->direction;
                if (c->driven) by_course[c->course] += along * c->target;
                if (c->driven) largest = std::max(largest, std::abs(along * c->target));
            }
            if (left.norm() > aligned * factor.norm()) return false;
        }
        return std::ranges::all_of(by_course,
                                   [&](const auto& one) { return std::abs(one.second) <= aligned * largest; });
    });
}

Elimination::Result Elimination::add(const EquationRow& equation, const std::vector<Index>& order) {
    double largest = 0;
    for (const auto& [node, factor] : equation) largest = std::max(largest, factor.norm());
    EquationRow row = reduced(equation);
    std::erase_if(row, [&](const auto& term) { return term.second.norm() <= no_factor * largest; });
    const Index node = choose(row, order);
    if (node < 0) {
        return held_.satisfy(row) ? Result::redundant : Result::nothing_to_lead;
    }
    const Vec3 factor = row.at(node);
    row.erase(node);
    model::LedNode led{node, factor.normalized()};
    for (const auto& [other, own] : row) led.by.emplace_back(other, -own / factor.norm());
    substitute(led);
    const std::size_t place = led_.size();
    at_[node].push_back(place);
    for (const auto& [other, by] : led.by) uses_[other].insert(place);
    led_.push_back(std::move(led));
    return Result::led;
}

EquationRow Elimination::reduced(const EquationRow& equation) const {
    EquationRow row;
    const auto add = [&](Index node, const Vec3& factor) {
        row.try_emplace(node, Vec3::Zero()).first->second += factor;
    };
    for (const auto& [node, all] : equation) {
        Vec3 factor = all;
        if (const auto at = at_.find(node); at != at_.end())
            for (const std::size_t e : at->second) {
                const double along = all.dot(led_[e].direction);
                factor -= along * led_[e].direction;
                for (const auto& [other, by] : led_[e].by) add(other, along * by);
            }
        add(node, factor);
    }
    return row;
}

Index Elimination::choose(const EquationRow& row, const std::vector<Index>& order) const {
    const auto may = [&](Index node, const Vec3& factor) {
        return held_.part(node, factor).norm() <= aligned * factor.norm();
    };
    double largest = 0;
    Index best = -1;
    for (const auto& [node, factor] : row)
        if (may(node, factor) && factor.norm() > largest) {
            largest = factor.norm();
            best = node;
        }
    for (const Index node : order)
        if (const auto at = row.find(node);
            at != row.end() && may(node, at->second) && at->second.norm() >= large_enough * largest)
            return node;
    return best;
}

void Elimination::substitute(const model::LedNode& one) {
    const auto users = uses_.find(one.node);
    if (users == uses_.end()) return;
    for (const std::size_t e : std::set<std::size_t>(users->second)) {
        auto& by = led_[e].by;
        const auto at = std::ranges::find(by, one.node, &std::pair<Index, Vec3>::first);
        const double along = at->second.dot(one.direction);
        if (along == 0) continue;
        at->second -= along * one.direction;
        if (at->second.norm() <= no_factor * std::abs(along)) {
            by.erase(at);
            uses_[one.node].erase(e);
        }
        for (const auto& [other, share] : one.by) {
            const auto there = std::ranges::find(by, other, &std::pair<Index, Vec3>::first);
            if (there != by.end())
                there->second += along * share;
            else
                by.emplace_back(other, along * share);
            uses_[other].insert(e);
        }
    }
}

} // namespace osculate::app
