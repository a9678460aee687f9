#pragma once
/// probes/NAME.csv.

#include "osculate/output/csv_table.hpp"
#include "osculate/output/probe.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace osculate::output {

constexpr const char* probe_folder = "probes"; ///< of a run's folder

/// The rows of a probe over time: a column time, then the probe's, units in brackets. What has no value is an empty cell.
class ProbeFile {
public:
    /// @param probe  must outlive it
    /// @param keep   see CsvTable
    /// @throws std::runtime_error with path and reason, as write() does
    ProbeFile(const std::filesystem::path& folder, const std::string& name, const Probe& probe,
              std::optional<std::uintmax_t> keep = std::nullopt);

    void write(const Snapshot& snapshot);
    [[nodiscard]] const CsvTable& table() const { return table_; }

    /// Where a probe's table lies in the folder of a run.
    [[nodiscard]] static std::string relative_path(const std::string& name);
    [[nodiscard]] static std::filesystem::path path(const std::filesystem::path& folder, const std::string& name) {
        return folder / relative_path(name);
    }

private:
    const Probe& probe_;
    CsvTable table_;
};

} // namespace osculate::output
