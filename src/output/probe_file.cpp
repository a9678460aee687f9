#include "osculate/output/probe_file.hpp"

namespace osculate::output {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> headers(const Probe& probe) {
    std::vector<std::string> names{ProbeColumn{"time", "s"}.header()};
    for (const ProbeColumn& column : probe.columns()) names.push_back(column.header());
    return names;
}

} // namespace

std::string ProbeFile::relative_path(const std::string& name) {
    return std::string(probe_folder) + "/" + name + ".csv";
}

ProbeFile::ProbeFile(const fs::path& folder, const std::string& name, const Probe& probe,
                     std::optional<std::uintmax_t> keep)
    : probe_(probe), table_(path(folder, name), headers(probe), keep) {}

void ProbeFile::write(const Snapshot& snapshot) {
    for (const std::vector<double>& row : probe_.rows(snapshot)) {
        std::vector<Cell> cells{snapshot.state().time};
        for (const double value : row) cells.push_back(cell(value));
        table_.row(cells);
    }
}

} // namespace osculate::output
