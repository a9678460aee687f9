#pragma once
/// history.csv: resultants of every contact pair and constrained set, one row per accepted step.

#include "osculate/linear/constraints.hpp"
#include "osculate/output/csv_table.hpp"
#include "osculate/output/snapshot.hpp"
#include "osculate/time/ledger.hpp"

#include <filesystem>
#include <vector>

namespace osculate::output {

/// Forces of supports and driven motions on each node, N: the unbalanced force along its held directions.
[[nodiscard]] std::vector<Vec3> nodal_reactions(const linear::Constraints& constraints,
                                                const std::vector<Vec3>& unbalanced);

class History {
public:
    /// @param pairs   whether pairs have columns
    /// @param ledger  whether energies and momenta have columns, for runs with a dynamic stage
    /// @param sets    those of model.sets that have reaction columns
    /// @param keep    see CsvTable
    /// @throws std::runtime_error with path and reason, like row()
    History(const std::filesystem::path& path, const model::Model& model, bool pairs, std::vector<Index> sets,
            bool ledger, std::optional<std::uintmax_t> keep = std::nullopt);

    /// Names of the columns of such a history, in their order.
    [[nodiscard]] static std::vector<std::string> columns(const model::Model& model, bool pairs,
                                                          const std::vector<Index>& sets, bool ledger);

    /// The row of such a history, one cell per column; an empty text if there is no value.
    /// @param energies_now  null in a static step
    [[nodiscard]] static std::vector<Cell> cells(const Snapshot& snapshot, const linear::Constraints& constraints,
                                                 double dt, int iterations, bool pairs, const std::vector<Index>& sets,
                                                 bool ledger, const time::Ledger* energies_now);

    /// Writes a row. If several sets hold one direction at a node, its reaction counts only for the set that
    /// Constraints names, so that the reactions of all sets sum to the total.
    /// @param ledger  null in a static step: its cells stay empty
    void row(const Snapshot& snapshot, const linear::Constraints& constraints, double dt, int iterations,
             const time::Ledger* ledger);
    [[nodiscard]] const CsvTable& table() const { return table_; }

private:
    bool pairs_;
    std::vector<Index> sets_;
    bool ledger_;
    CsvTable table_;
};

} // namespace osculate::output
