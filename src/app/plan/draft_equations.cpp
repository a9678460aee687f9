/// Linear equations between displacements of a plan.

#include "app/fault.hpp"
#include "app/plan/draft.hpp"
#include "app/plan/draft_slices.hpp"
#include "app/plan/elimination.hpp"

#include <fmt/format.h>
#include <set>
#include <string>

namespace osculate::app {

namespace {

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
    const auto place = [&](Index node) {
        const Vec3 X = m.X[static_cast<std::size_t>(node)] + m.origin;
        return fmt::format("a node at [{:.6g}, {:.6g}, {:.6g}] m", X[0], X[1], X[2]);
    };
    const std::vector<SliceRow> slices = add_slices(draft);
    if (draft.scene.equations.empty() && slices.empty()) return;
    std::set<Index> follow;
    for (const Index node : model::dependent_nodes(m)) follow.insert(node);
    const HeldDirections held(draft.plan.stages);
    Elimination elimination(held);
    for (const SliceRow& row : slices)
        if (elimination.add({{row.node, row.direction}, {row.as, -row.own}}, {row.node, row.as}) ==
            Elimination::Result::nothing_to_lead) {
            draft.faults.push_back(fault(row.key, "supports and motions that are the same through the layer",
                                         "others at " + place(row.node) + " than at " + place(row.as)));
            break;
        }
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
