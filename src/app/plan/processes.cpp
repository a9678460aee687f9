#include "osculate/app/processes.hpp"

#include "app/fault.hpp"
#include "osculate/equilibrium/tangent_choice.hpp"
#include "osculate/solve/direct_on_first.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <string_view>

namespace osculate::app {

ProcessMemory process_memory(const Plan& plan) {
    constexpr double program = 2.8e7, mpi_and_petsc = 5e7, element = 1130, unknown = 1920, sharing_out = 30,
                     libraries_once = 6e7, unknown_once = 150;
    constexpr std::array<std::string_view, 2> in_rows{"nonlinear elements", "inertia"};
    constexpr std::array<std::string_view, 4> in_unknowns{"stiffness", "multigrid", "condensation",
                                                          "Cholesky factorisation"};
    ProcessMemory memory;
    memory.everywhere = program + mpi_and_petsc;
    for (const PlanItem& item : plan.items)
        if (item.present && std::ranges::count(in_unknowns, item.part) == 0)
            (std::ranges::count(in_rows, item.part) > 0 ? memory.shared : memory.everywhere) += item.cost.bytes;
    for (const model::Body& body : plan.model.bodies) memory.everywhere += element * body.mesh.element_count();
    const double unknowns = 3.0 * plan.model.nodes();
    memory.shared += unknown * unknowns;
    memory.once = std::min(libraries_once + unknown_once * unknowns, memory.everywhere);
    memory.first = sharing_out * unknowns;
    return memory;
}

std::vector<Fault> cannot_be_shared(const model::Model& model) {
    const char* what = equilibrium::needs_factors(model);
    if (what == nullptr || model.nodes() <= solve::most_nodes_on_first) return {};
    return {
        fault("scene",
              fmt::format(
                  "at most {} nodes, or a run without --distributed: the first process factorises such scenes for all",
                  solve::most_nodes_on_first),
              fmt::format("{}, and {} nodes", what, model.nodes()))};
}

std::string processes_in_words(const Plan& plan, int processes) {
    if (const std::vector<Fault> faults = cannot_be_shared(plan.model); !faults.empty()) throw SceneError(faults);
    const ProcessMemory memory = process_memory(plan);
    const auto mega = [](double bytes) { return fmt::format("{:.0f} MB", 1e-6 * bytes); };
    return fmt::format(
        "{} processes, estimates of memory: {} of each, {} of the first, {} of all on one machine\n"
        "  shared by nodes, {} of each: rows of stiffness and mass, nonlinear elements, grids of multigrid, "
        "vectors of KINSOL and GMRES\n"
        "  in every process, {}, of which those on one machine keep {} once: program, MPI, mesh, surfaces, "
        "contact, audit, values at nodes\n"
        "  in the first, {}: sharing out the nodes, files\n",
        processes, mega(memory.of_one(processes)), mega(memory.of_first(processes)), mega(memory.of_all(processes)),
        mega(memory.shared / processes), mega(memory.everywhere), mega(memory.once), mega(memory.first));
}

} // namespace osculate::app
