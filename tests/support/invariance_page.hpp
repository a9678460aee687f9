#pragma once
/// docs/invariance.md.

#include "support/invariance_cases.hpp"
#include "support/trace.hpp"

#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace osculate::support {

struct InvarianceRow {
    std::string scene;
    std::size_t steps = 0;
    std::vector<std::pair<std::string, Difference>> differences; ///< by transformation
};

namespace detail {

inline std::string brief(double x) {
    if (x == 0) return "0";
    char text[16];
    std::snprintf(text, sizeof text, "%.0e", x);
    std::string s = text; // 3e-09 -> 3e-9
    if (const auto zero = s.find("e-0"); zero != std::string::npos) s.erase(zero + 2, 1);
    if (const auto zero = s.find("e+0"); zero != std::string::npos) s.replace(zero + 1, 2, "");
    return s;
}

inline double forces(const Difference& d) {
    return std::max(d.force, d.nodal_force);
}

} // namespace detail

inline std::string describe_difference(const std::string& name, const Difference& d) {
    char text[200];
    std::snprintf(text, sizeof text, "%-14s pairs %8.1e  nodes %8.1e  displacements %8.1e  %s %+d iterations  ",
                  name.c_str(), d.force, d.nodal_force, d.displacement, d.same_steps ? "same steps" : "OTHER STEPS",
                  d.iterations);
    return text + d.failure.substr(0, 160);
}

inline void write_invariance_page(const std::string& file, const std::vector<InvarianceRow>& rows, double same) {
    if (rows.empty()) return;
    std::ofstream page(file);
    std::vector<std::string> names;
    for (const auto& [name, d] : rows.front().differences)
        if (name != "sides swapped") names.push_back(name);
    std::size_t pairs = 0, fine = 0;
    for (const InvarianceRow& row : rows)
        for (const auto& [name, d] : row.differences)
            if (name != "sides swapped") {
                ++pairs;
                fine += d.failure.empty() && d.same_steps && detail::forces(d) < same && d.displacement < same;
            }
    page << "# Invariance\n\n"
            "`scripts/pages/invariance` writes this page; do not edit it. It runs every scene as it is, and again in "
            "other units, turned,\n"
            "mirrored, moved by 1e6 sizes, with nodes and elements numbered at random, and with its bodies in reverse "
            "order. A cell shows\n"
            "the largest difference of contact forces (of pairs and of nodes) / of displacements from the run of the "
            "scene as it is,\n"
            "transformed back and divided by the largest value of the run. `!` means that the accepted steps differ. "
            "The number behind a\n"
            "unit is the factor on the metre, the kilogram or the second. For the moved scene, both runs use "
            "coordinates rounded as doubles\n"
            "far away hold them. Runs end after the given number of steps; tubes and foundations have coarser meshes "
            "than in their scenes.\n\n"
         << fine << " of " << pairs << " cells are below " << detail::brief(same) << " with the same steps. "
         << rows.size() << " of the " << invariance_scenes().size() << " scenes are listed.\n\n| scene | steps |";
    for (const std::string& name : names) page << ' ' << name << " |";
    page << "\n|---|---|";
    for (std::size_t i = 0; i < names.size(); ++i) page << "---|";
    page << '\n';
    for (const InvarianceRow& row : rows) {
        page << "| " << row.scene << " | " << row.steps << " |";
        for (const auto& [name, d] : row.differences) {
            if (name == "sides swapped") continue;
            page << ' ' << detail::brief(detail::forces(d)) << " / " << detail::brief(d.displacement)
                 << (d.same_steps && d.failure.empty() ? " |" : " ! |");
        }
        page << '\n';
    }
    page << "\n## Known differences\n";
    for (const InvarianceRow& row : rows)
        if (const auto known = known_differences().find(row.scene); known != known_differences().end())
            page << "- " << row.scene << ": " << known->second.reason << ".\n";
    page << "\n## Slave and master swapped\nAnother approximation of the same scene: the bias of the choice, in forces "
            "of pairs over the "
            "sum of nodal forces and in\ndisplacements, as above.\n\n| scene | forces | displacements | steps | "
            "outcome |\n|---|---|---|---|---|\n";
    for (const InvarianceRow& row : rows)
        for (const auto& [name, d] : row.differences)
            if (name == "sides swapped")
                page << "| " << row.scene << " | " << detail::brief(d.force) << " | " << detail::brief(d.displacement)
                     << " | " << (d.same_steps ? "same" : "other") << " | " << (d.failure.empty() ? "runs" : d.failure)
                     << " |\n";
    page << "\n## Left out\n";
    for (const auto& [scene, why] : left_out()) page << "- " << scene << ": " << why << ".\n";
}

} // namespace osculate::support
