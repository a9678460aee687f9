#include "osculate/app/report.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace osculate::app {

Index degrees_of_freedom(const Plan& plan) {
    Index most = 0;
    for (const time::Stage& stage : plan.stages)
        most = std::max(most, model::Constraints(plan.model.nodes(), stage.constraints).equations());
    return most;
}

<<<<<<< HEAD
std::string report(const Plan& plan, int threads) {
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    for (const model::Body& body : plan.model.bodies)
        fmt::format_to(out, "body {}: {} nodes, {} elements\n", body.name, body.nodes(), body.mesh.element_count());
    for (const std::string& note : plan.mesh_notes) fmt::format_to(out, "{}\n", note);
    fmt::format_to(out, "degrees of freedom: {}\n", degrees_of_freedom(plan));
    Timings unused;
    for (const auto& pair : plan.model.pairs) {
        fmt::format_to(out, "pair {}: {} slave nodes, {} master facets\n", pair->name(), pair->size(),
                       pair->surface().facet_count());
        const PairGaps gaps = initial_gaps(*pair, plan.model.X, unused, threads);
        if (gaps.above > 0)
            fmt::format_to(out, "  {} slave nodes above the master, initial gap {:.4g} m to {:.4g} m\n", gaps.above,
                           gaps.least, gaps.largest);
        else
            fmt::format_to(out, "  no slave node above the master\n");
        if (gaps.least < 0)
            fmt::format_to(out, "  worst overlap {:.4g} m at {}, {:.3g} of the facet size\n", -gaps.least,
                           node_name(plan.model, gaps.worst_node), gaps.largest_overlap);
        else
            fmt::format_to(out, "  no overlap\n");
        for (const std::string& sentence : advice(pairing(*pair, plan.model.X)))
            fmt::format_to(out, "  advice: {}\n", sentence);
        if (const Index fallbacks = pair->master().fallbacks(); fallbacks > 0)
            fmt::format_to(out, "  {} patches had to be smaller or simpler than asked for\n", fallbacks);
    }
    for (const time::Stage& stage : plan.stages)
        fmt::format_to(out, "stage {}: {} step(s) in {:.6g} s\n", stage.name, stage.steps, stage.duration);
    return fmt::to_string(text);
}

=======
>>>>>>> main
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
