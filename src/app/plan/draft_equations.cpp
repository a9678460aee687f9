/// Linear equations between displacements of a plan.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"

#include <fmt/format.h>
#include <map>
#include <set>
#include <string>

namespace osculate::app {

namespace {

/// sum over the nodes of factor . displacement = 0
using EquationRow = std::map<Index, Vec3>;

/// A factor below this is round-off, of the largest of its equation, or of a unit vector.
constexpr double vanishing = 1e-12, aligned = 1e-9;
/// A node early in the equation leads if its factor is at least this of the largest.
constexpr double large_enough = 0.1;

/// Directions along which stages hold or drive nodes.
class HeldDirections {
public:
    explicit HeldDirections(const std::vector<time::Stage>& stages) {
        for (const time::Stage& stage : stages)
            for (const linear::NodeConstraint& c : stage.constraints) {
                add(all_, c);
                if (c.driven) add(driven_, c);
            }
        // what is released somewhere is held elsewhere alone
        for (const time::Stage& stage : stages) {
            std::map<Index, Mat3> now;
            for (const linear::NodeConstraint& c : stage.constraints) add(now, c);
            for (const auto& [node, P] : all_) {
                const auto at = now.find(node);
                const Mat3 here = at != now.end() ? at->second : Mat3(Mat3::Zero());
                if ((P - here).norm() > aligned) changing_.insert(node);
            }
        }
    }
    /// Part of a factor along held or driven directions.
    [[nodiscard]] Vec3 part(Index node, const Vec3& factor) const {
        const auto at = all_.find(node);
        return at != all_.end() ? Vec3(at->second * factor) : Vec3(Vec3::Zero());
    }
    /// Whether the displacement along a factor is zero in all stages.
    [[nodiscard]] bool at_rest(Index node, const Vec3& factor) const {
        const auto driven = driven_.find(node);
        return (factor - part(node, factor)).norm() <= aligned * factor.norm() && !changing_.contains(node) &&
               (driven == driven_.end() || (driven->second * factor).norm() <= aligned * factor.norm());
    }

private:
    static void add(std::map<Index, Mat3>& projectors, const linear::NodeConstraint& c) {
        Mat3& P = projectors.try_emplace(c.node, Mat3::Zero()).first->second;
        const Vec3 d = c.direction - P * c.direction;
        if (d.norm() > aligned) P += d * d.transpose() / d.squaredNorm();
    }
    std::map<Index, Mat3> all_, driven_;
    std::set<Index> changing_; ///< nodes that some stages hold otherwise than others
};

/// Gauss-Jordan elimination, one direction of one node an equation.
class Elimination {
public:
    explicit Elimination(const HeldDirections& held) : held_(held) {}

    enum class Result { led, redundant, nothing_to_lead };

    /// @param order  nodes, those first that are to be led where it makes no difference
    Result add(const EquationRow& equation, const std::vector<Index>& order) {
        double largest = 0;
        for (const auto& [node, factor] : equation) largest = std::max(largest, factor.norm());
        EquationRow row = reduced(equation);
        std::erase_if(row, [&](const auto& term) { return term.second.norm() <= vanishing * largest; });
        const Index node = choose(row, order);
        if (node < 0) {
            const bool at_rest =
                std::ranges::all_of(row, [&](const auto& term) { return held_.at_rest(term.first, term.second); });
            return at_rest ? Result::redundant : Result::nothing_to_lead;
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

    [[nodiscard]] std::vector<model::LedNode> take() { return std::move(led_); }

private:
    /// The same equation without directions that are led already.
    [[nodiscard]] EquationRow reduced(const EquationRow& equation) const {
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

    /// -1: none may be led.
    [[nodiscard]] Index choose(const EquationRow& row, const std::vector<Index>& order) const {
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

    /// Takes a direction that is led from now on out of what leads others.
    void substitute(const model::LedNode& one) {
        const auto users = uses_.find(one.node);
        if (users == uses_.end()) return;
        for (const std::size_t e : std::set<std::size_t>(users->second)) {
            auto& by = led_[e].by;
            const auto at = std::ranges::find(by, one.node, &std::pair<Index, Vec3>::first);
            const double along = at->second.dot(one.direction);
            if (along == 0) continue;
            at->second -= along * one.direction;
            if (at->second.norm() <= vanishing * std::abs(along)) {
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

    const HeldDirections& held_;
    std::vector<model::LedNode> led_;
    std::map<Index, std::vector<std::size_t>> at_; ///< node -> those of its directions
    std::map<Index, std::set<std::size_t>> uses_;  ///< node -> those in which it has a part
};

/// Rows of an equation of the scene, and the order of its nodes.
std::vector<std::pair<EquationRow, std::vector<Index>>> rows_of(const Draft& draft, const scene::Equation& equation) {
    std::vector<Index> each{-1};
    if (!equation.each.empty()) each = draft.set(equation.each).nodes;
    std::vector<std::pair<EquationRow, std::vector<Index>>> rows;
    for (const Index one : each) {
        auto& [row, order] = rows.emplace_back();
        if (one >= 0) order.push_back(one);
        for (const auto& [name, factors] : equation.terms) {
            const std::vector<Index> nodes = name == equation.each ? std::vector<Index>{one} : draft.set(name).nodes;
            for (const Index node : nodes) {
                row.try_emplace(node, Vec3::Zero()).first->second += factors / static_cast<double>(nodes.size());
                order.push_back(node);
            }
        }
    }
    return rows;
}

} // namespace

void add_equations(Draft& draft) {
    model::Model& m = draft.plan.model;
    if (draft.scene.equations.empty()) return;
    const auto place = [&](Index node) {
        const Vec3 X = m.X[static_cast<std::size_t>(node)] + m.origin;
        return fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m", X[0], X[1], X[2]);
    };
    std::set<Index> follow;
    for (const Index node : model::dependent_nodes(m)) follow.insert(node);
    const HeldDirections held(draft.plan.stages);
    Elimination elimination(held);
    for (const auto& [name, equation] : draft.scene.equations) {
        const std::string key = "equations." + name;
        bool fit = true;
        for (const auto& [set, factors] : equation.terms)
            for (const Index node : draft.set(set).nodes)
                if (fit && follow.contains(node)) {
                    draft.faults.push_back(fault(key + ".terms." + set,
                                                 "nodes that follow no tie, coupling, rigid body or end of a sector",
                                                 place(node) + ", that does"));
                    fit = false;
                }
        if (!fit) continue;
        for (const auto& [row, order] : rows_of(draft, equation))
            if (elimination.add(row, order) == Elimination::Result::nothing_to_lead) {
                draft.faults.push_back(
                    fault(key, "a node that is free along its factors, to follow the others",
                          "none" + (equation.each.empty() ? std::string() : ", for " + place(order.front())) +
                              ": supports and stages hold or drive all of them there, or in part, or another equation "
                              "leads them"));
                break;
            }
    }
    m.led = elimination.take();
    for (const time::Stage& stage : draft.plan.stages) try {
            (void)linear::Constraints(m.nodes(), stage.constraints, {}, model::led_directions(m));
        } catch (const std::invalid_argument& error) {
            draft.faults.push_back(
                fault("equations", "factors along the axes of supports, or across them", error.what()));
            break;
        }
}

} // namespace osculate::app
