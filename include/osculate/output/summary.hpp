#pragma once
/// What a run was and what it cost: summary.json.

#include "osculate/core/timing.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace osculate::output {

/// Members carry the names they have in the file; see write_summary for the two that differ.
struct Summary {
    std::filesystem::path folder; ///< of the run's files, of which summary.json is one; not in the file

    struct Body {
        std::string name;
        long nodes = 0, elements = 0;
    };
    struct Pair {
        std::string name;
        long slave_nodes = 0, master_facets = 0;
        std::string surface; ///< kind of the master surface, "facets" or "rpim"
    };
    struct Steps {
        long accepted = 0, rejected = 0;
        long stabilised = 0; ///< of those accepted: bodies leant on springs on the way, see time::StabilisationOptions
        long at_round_off =
            0; ///< of those accepted: the tolerance was below what can be told, see equilibrium::Equilibrium
    };

    /// Worst over the accepted steps, see app::RunChecks.
    struct Checks {
        double force_balance = 0;                            ///< of the forces that act
        double penetration = 0, penetration_m = 0;           ///< in facet sizes; m
        std::optional<double> energy_balance, energy_growth; ///< of the largest energy; without a dynamic step none
        std::optional<double> closing_loss;                  ///< alike: taken by gaps that closed
    };
    /// The deepest place at which a body lay inside another in an accepted step, see contact::SurfaceAudit.
    struct Audit {
        bool on = true;                             ///< false: nobody looked
        double depth = 0, excess = 0, relative = 0; ///< m; m; of the facet size
        std::string body, other;                    ///< empty: none lay inside another
        long node = -1;                             ///< of `body`
        double time = 0;
        std::array<double, 3> place{};
    };
    /// Whether the run came to what its scene expects.
    struct Expectation {
        std::vector<std::string> misses; ///< in words; none: met
        [[nodiscard]] bool met() const { return misses.empty(); }
    };

    std::string version, scene;
    std::string status;  ///< how the run stands or ended
    std::string failure; ///< why it gave up; left out of the file when empty
    long dofs = 0;
    std::vector<Body> bodies;
    std::vector<Pair> pairs;
    Steps steps;
    long iterations = 0, factorisations = 0;
    long gmres_iterations = 0;                 ///< on the whole tangent
    double total_seconds = 0, cpu_seconds = 0; ///< wall and processor time of the whole run
    Timings timings;                           ///< wall time by part
    long peak_memory_bytes = 0;
    int threads = 1;
    std::vector<std::string> plan;
    std::optional<Checks> checks;
    std::optional<Audit> audit;             ///< none: one body that meets nothing
    std::vector<std::string> warnings;      ///< sentences; left out of the file when there are none
    std::optional<Expectation> expectation; ///< where the scene has one, when the run has ended
};

/// Writes summary.json, whole or not at all; total_seconds, cpu_seconds and timings together are its `seconds`.
/// @throws std::runtime_error with path and reason
void write_summary(const std::filesystem::path& path, const Summary& summary);

} // namespace osculate::output
