#include "app/study/study_files.hpp"
#include "osculate/output/csv_table.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

output::Cell count(double value, bool known) {
    if (!known) return std::string();
    return std::lround(value);
}

} // namespace

void write_study_table(const scene::Study& study, const std::vector<StudyCase>& cases, const fs::path& folder) {
    std::vector<std::string> columns{"run"};
    for (const scene::StudyAxis& axis : study.axes) columns.push_back(axis.name);
    for (const auto& [name, value] : study.parameters_of(scene::Combination(study.axes.size(), 0)))
        if (!name.ends_with("_index")) columns.push_back("parameter." + name);
    for (const char* name : {"status", "expectation", "dofs", "steps_accepted", "steps_rejected", "iterations"})
        columns.emplace_back(name);
    for (const scene::StudyQuantity& q : study.quantities)
        for (const char* what : {".value", ".reference", ".error"}) columns.push_back(q.name + what);
    for (const char* name : {"cpu_seconds", "wall_seconds", "repeats", "same_bits", "peak_memory_bytes"})
        columns.emplace_back(name);
    for (const char* part : study_parts) columns.push_back(std::string("seconds.") + part);
    columns.emplace_back("reason");

    const fs::path path = folder / "study.csv", part = folder / "study.csv.part";
    {
        output::CsvTable table(part, columns);
        for (const StudyCase& c : cases) {
            const StudyRecord& r = c.record;
            const bool known = r.finished();
            std::vector<output::Cell> cells{c.id};
            for (std::size_t a = 0; a < study.axes.size(); ++a)
                cells.emplace_back(study.axes[a].values[c.combination[a]].name);
            for (const auto& [name, value] : study.parameters_of(c.combination))
                if (!name.ends_with("_index")) cells.push_back(output::cell(value));
            cells.emplace_back(r.status.empty() ? std::string("waiting") : r.status);
            cells.emplace_back(known ? r.expectation : std::string());
            for (const double value : {r.dofs, r.accepted, r.rejected, r.iterations})
                cells.push_back(count(value, known));
            for (std::size_t k = 0; k < study.quantities.size(); ++k) {
                const QuantityResult result = c.results.empty() ? QuantityResult{} : c.results[k];
                for (const double value : {result.value, result.reference, result.error})
                    cells.push_back(output::cell(value));
            }
            cells.push_back(output::cell(r.median(&StudyRepeat::cpu)));
            cells.push_back(output::cell(r.median(&StudyRepeat::wall)));
            cells.emplace_back(static_cast<long>(r.repeats.size()));
            cells.emplace_back(std::string(r.repeats.size() < 2 ? "" : r.same ? "yes" : "no"));
            cells.push_back(count(r.median(&StudyRepeat::memory), known && !r.repeats.empty()));
            for (std::size_t p = 0; p < study_parts.size(); ++p) cells.push_back(output::cell(r.median_part(p)));
            cells.emplace_back(r.reason);
            table.row(cells);
        }
    }
    fs::rename(part, path);
}

} // namespace osculate::app
