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

/// The rows of a probe over time: a column time, then the probe's columns, units in brackets. A cell without value is
/// empty.
class ProbeFile {
public:
    /// @param probe  must outlive this object
    /// @param keep   see CsvTable
    /// @throws std::runtime_error with path and reason, like write()
    ProbeFile(const std::filesystem::path& folder, const std::string& name, const Probe& probe,
              std::optional<std::uintmax_t> keep = std::nullopt);

    void write(const Snapshot& snapshot);
    [[nodiscard]] const CsvTable& table() const { return table_; }

    /// Path of a probe's table in the folder of a run.
    [[nodiscard]] static std::string relative_path(const std::string& name);
    [[nodiscard]] static std::filesystem::path path(const std::filesystem::path& folder, const std::string& name) {
        return folder / relative_path(name);
    }

private:
    const Probe& probe_;
    CsvTable table_;
};

} // namespace osculate::output
