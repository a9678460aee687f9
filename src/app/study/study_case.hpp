#pragma once
/// One combination of a study: what is run, what came of it, and what was measured.

#include "osculate/scene/study.hpp"
#include "osculate/study/quantity.hpp"

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace osculate::app {

/// Parts of `seconds` in summary.json.
inline constexpr std::array study_parts{"search", "patches", "contact", "assembly", "factor", "solve", "output"};

/// Of `checks` in summary.json.
inline constexpr std::array study_checks{"force_balance", "energy_balance", "energy_growth", "closing_loss",
                                         "penetration"};

/// NaN, for checks that a run does not have.
constexpr std::array<double, study_checks.size()> no_checks() {
    std::array<double, study_checks.size()> values{};
    values.fill(std::numeric_limits<double>::quiet_NaN());
    return values;
}

struct StudyRepeat {
    double cpu = 0, wall = 0; ///< s
    double memory = 0;        ///< largest, bytes
    std::array<double, study_parts.size()> parts{};
};

/// What study_run.json of a run's folder holds.
struct StudyRecord {
    std::string hash;   ///< of everything the results follow from
    std::string status; ///< done, gave_up, refused, bug; empty: not finished
    std::string reason;
    double dofs = 0, accepted = 0, rejected = 0, iterations = 0;
    std::array<double, study_checks.size()> checks = no_checks();
    std::string expectation = "none"; ///< met; missed: what; none
    std::vector<StudyRepeat> repeats;
    bool same = true; ///< all repeats gave the same bits

    [[nodiscard]] bool finished() const { return status == "done" || status == "gave_up"; }
    [[nodiscard]] double median(double StudyRepeat::*value) const; ///< NaN without repeats
    [[nodiscard]] double median_part(std::size_t part) const;
    /// Values of scene::run_numbers().
    [[nodiscard]] std::vector<double> numbers() const;
};

struct QuantityResult {
    double value = std::numeric_limits<double>::quiet_NaN(), reference = value, error = value;
    bool is_error = false;
};

struct StudyCase {
    scene::Combination combination;
    std::string id, scene_path;
    std::filesystem::path folder;
    std::vector<scene::Override> overrides;
    scene::Scene scene; ///< resolved
    StudyRecord record;
    scene::Numbers numbers;
    std::vector<QuantityResult>
        results; ///< by quantity; empty until measured. Of a run that gave up those of its summary

    [[nodiscard]] bool completed() const { return record.status == "done" && !results.empty(); }
};

/// Every combination, with the record of an earlier run where nothing it follows from has changed.
[[nodiscard]] std::vector<StudyCase> make_cases(const scene::Study& study, const std::filesystem::path& folder,
                                                const std::vector<scene::Override>& command_line);

/// Writes the record, whole or not at all. @throws std::runtime_error
void write_record(const StudyCase& study_case);

/// Reads what the run in a folder says of itself and adds it to the record as a repeat; false when it did not come to an
/// end.
bool add_repeat(StudyRecord& record, const std::filesystem::path& folder);

/// What its exit code says of a run that could not say so itself, with the last of messages.txt as the reason.
/// @param signal  that ended it; 0: none did
void add_failure(StudyRecord& record, const std::filesystem::path& folder, int exit_code, int signal = 0);

/// Makes the folder of a run that something else will start; takes an earlier run out of it unless that is one of the same hash.
/// @param force  whatever else is in it
void announce(const StudyCase& study_case, bool force);

/// What formulas of a study may call.
[[nodiscard]] const scene::NamedFunctions& study_functions();

/// Measures the finished cases that are not yet measured, then references and errors of all.
void measure(const scene::Study& study, std::vector<StudyCase>& cases);

} // namespace osculate::app
