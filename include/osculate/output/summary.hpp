#pragma once
/// Content and cost of a run: summary.json.

#include "osculate/core/timing.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace osculate::output {

/// Members have the same names as in the file; see write_summary for the two that differ.
struct Summary {
    std::filesystem::path folder; ///< of the run's files, including summary.json; not in the file

    struct Body {
        std::string name;
        long nodes = 0, elements = 0;
    };
    struct Pair {
        std::string name;
        long slave_nodes = 0, master_facets = 0;
        std::string surface; ///< kind of the master surface, "facets" or "rpim"
    };
    /// What one of several processes has.
    struct Process {
        long nodes = 0, elements = 0;
        long slave_nodes = 0;         ///< whose derivatives it had in the last accepted step
        long peak_memory_bytes = 0;   ///< up to the last accepted step
        long shared_memory_bytes = 0; ///< at its end, pages that may be those of others of its machine
    };
    struct Steps {
        long accepted = 0, rejected = 0;
        long stabilised = 0; ///< accepted steps solved with supporting springs, see time::StabilisationOptions
        long at_round_off =
            0; ///< accepted steps whose tolerance was below the round-off of rows, see equilibrium::Equilibrium
        long held_geometry = 0; ///< accepted steps solved with the geometry of contact held, see time::LadderResult
    };

    /// Worst values over the accepted steps, see app::RunChecks.
    struct Checks {
        double force_balance = 0;                            ///< fraction of the acting forces
        double penetration = 0, penetration_m = 0;           ///< in facet sizes; m
        std::optional<double> energy_balance, energy_growth; ///< of the largest energy; none without dynamic step
        std::optional<double> closing_loss;                  ///< likewise: lost in closing gaps
        std::optional<double> settling_loss;   ///< likewise: by what a rule chose to let bodies come to rest
        std::optional<double> rotation_strain; ///< that rotations add; none without small strain
    };
    /// The deepest place at which a body was inside another in an accepted step, see contact::SurfaceAudit.
    struct Audit {
        bool on = true;                             ///< false: not audited
        double depth = 0, excess = 0, relative = 0; ///< m; m; of the facet size
        std::string body, other;                    ///< empty: no penetration
        long node = -1;                             ///< of `body`
        double time = 0;
        std::array<double, 3> place{};
    };
    /// Whether the run met the expectation of its scene.
    struct Expectation {
        std::vector<std::string> misses; ///< in words; empty: met
        [[nodiscard]] bool met() const { return misses.empty(); }
    };

    std::string version, scene;
    std::string status;  ///< current or final state of the run
    std::string failure; ///< why it failed; left out of the file if empty
    long dofs = 0;
    std::vector<Body> bodies;
    std::vector<Pair> pairs;
    std::vector<Process> processes; ///< of a distributed run; left out of the file of others
    Steps steps;
    long iterations = 0, factorisations = 0;
    long gmres_iterations = 0;                 ///< on the whole tangent
    double total_seconds = 0, cpu_seconds = 0; ///< wall and processor time of the whole run
    Timings timings;                           ///< wall time by part
    long peak_memory_bytes = 0;
    int threads = 1;
    std::vector<std::string> plan;
    std::optional<Checks> checks;
    std::optional<Audit> audit;             ///< none: one body without contact
    std::vector<std::string> warnings;      ///< sentences; left out of the file if there are none
    std::optional<Expectation> expectation; ///< if the scene has one, after the end of the run
};

/// Writes summary.json, completely or not at all; total_seconds, cpu_seconds and timings together are its `seconds`.
/// @throws std::runtime_error with path and reason
void write_summary(const std::filesystem::path& path, const Summary& summary);

} // namespace osculate::output
