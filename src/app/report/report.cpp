#include "osculate/app/report.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace osculate::app {

Index degrees_of_freedom(const Plan& plan) {
    Index most = 0;
    const std::vector<Index> dependent = model::dependent_nodes(plan.model);
    const std::vector<linear::LedDirection> led = model::led_directions(plan.model);
    for (const time::Stage& stage : plan.stages)
        most = std::max(most, linear::Constraints(plan.model.nodes(), stage.constraints, dependent, led).equations());
    return most;
}

namespace {

/// 12.3 k elements an iteration; bytes take the prefix themselves: 12.3 kB.
std::string amount(double count, const std::string& unit) {
    static constexpr const char* prefixes[] = {"", "k", "M", "G", "T"};
    std::size_t p = 0;
    for (; count >= 1000 && p + 1 < std::size(prefixes); ++p) count /= 1000;
    const bool bytes = unit.starts_with("B");
    return fmt::format("{:.3g} {}{}{}", count, prefixes[p], bytes || p == 0 ? "" : " ", unit);
}

std::string in_words(const PlanCost& cost) {
    std::string text = cost.bytes > 0 ? amount(cost.bytes, "B") : "";
    if (cost.count > 0) text += (text.empty() ? "" : ", ") + amount(cost.count, cost.unit);
    return text;
}

} // namespace

std::string explain(const Plan& plan) {
    std::size_t part = 0, cost = 0;
    for (const PlanItem& item : plan.items) {
        part = std::max(part, item.part.size());
        cost = std::max(cost, in_words(item.cost).size());
    }
    std::string text;
    for (const bool present : {true, false}) {
        text += present ? "in the plan: part, estimated cost, why\n" : "left out: part, why\n";
        for (const PlanItem& item : plan.items) {
            if (item.present != present) continue;
            text += fmt::format("  {:{}}  ", item.part, part);
            if (present) text += fmt::format("{:{}}  ", in_words(item.cost), cost);
            text += item.reason + "\n";
        }
    }
    return text;
}

} // namespace osculate::app
