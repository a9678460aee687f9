#include "app/study/study_curves.hpp"
#include "app/study/study_files.hpp"
#include "app/study/study_series.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace osculate::app {

namespace {

using Words = std::vector<std::string>;

std::string number(double value) {
    return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

std::string measure(double value) {
    return std::isnan(value) ? "-" : fmt::format("{:.6g}", value);
}

/// Counts in full, all else to three digits.
std::string figure(double value) {
    constexpr double most = 1e9;
    return std::rint(value) == value && std::abs(value) < most ? fmt::format("{:.0f}", value) : number(value);
}

std::string outcome(const StudyRecord& record) {
    return record.status.empty() ? "waiting" : record.status == "gave_up" ? "gave up" : record.status;
}

std::string count(double value) {
    return std::isnan(value) ? "-" : fmt::format("{:.0f}", value);
}

std::string seconds(double value) {
    return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, value < 10 ? 2 : 1);
}

std::string row(const Words& cells) {
    std::string text = "|";
    for (const std::string& cell : cells) text += " " + cell + " |";
    return text + "\n";
}

std::string header(const Words& cells) {
    std::string rule = "|";
    for (std::size_t i = 0; i < cells.size(); ++i) rule += "---|";
    return row(cells) + rule + "\n";
}

Words axis_names(const scene::Study& study) {
    Words names;
    for (const scene::StudyAxis& axis : study.axes) {
        names.push_back(axis.name);
        for (const scene::SampledVariable& v : axis.variables)
            names.push_back(v.unit.empty() ? v.name : v.name + ", " + v.unit);
    }
    return names;
}

Words axis_values(const scene::Study& study, const StudyCase& c) {
    Words names;
    for (std::size_t a = 0; a < study.axes.size(); ++a) {
        const scene::AxisValue& value = study.axes[a].values[c.combination[a]];
        names.push_back(value.name);
        for (const scene::SampledVariable& v : study.axes[a].variables)
            names.push_back(number(*scene::find(value.parameters, v.name)));
    }
    return names;
}

std::string run_table(const scene::Study& study, const std::vector<StudyCase>& cases) {
    Words columns = axis_names(study);
    for (const char* name :
         {"dofs", "steps", "rejected", "Newton iterations", "CPU s", "wall s", "memory, MB", "status"})
        columns.emplace_back(name);
    std::string text = header(columns);
    constexpr double megabyte = 1e6;
    for (const StudyCase& c : cases) {
        const StudyRecord& r = c.record;
        Words cells = axis_values(study, c);
        for (const double value : {r.dofs, r.accepted, r.rejected, r.iterations})
            cells.push_back(r.finished() ? count(value) : "-");
        cells.push_back(seconds(r.median(&StudyRepeat::cpu)));
        cells.push_back(seconds(r.median(&StudyRepeat::wall)));
        cells.push_back(count(r.median(&StudyRepeat::memory) / megabyte));
        std::string status = outcome(r);
        if (!r.reason.empty()) status += ": " + r.reason;
        std::ranges::replace(status, '|', '/');
        cells.push_back(status);
        text += row(cells);
    }
    return text;
}

/// How many runs ended how.
std::string tally(const std::vector<StudyCase>& cases) {
    const auto count_of = [&](const auto& which) { return std::ranges::count_if(cases, which); };
    const auto finished = [](const StudyCase& c) { return c.record.finished(); };
    std::string text = fmt::format("{} runs: {} completed, {} gave up", cases.size(),
                                   count_of([](const StudyCase& c) { return c.record.status == "done"; }),
                                   count_of([](const StudyCase& c) { return c.record.status == "gave_up"; }));
    if (const auto rest = std::ssize(cases) - count_of(finished); rest > 0)
        text += fmt::format(", {} not finished", rest);
    const auto met = count_of([&](const StudyCase& c) { return finished(c) && c.record.expectation == "met"; });
    const auto judged = count_of([&](const StudyCase& c) { return finished(c) && c.record.expectation != "none"; });
    if (judged > 0) text += fmt::format("; {} of {} as expected", met, judged);
    if (std::ranges::any_of(cases, [](const StudyCase& c) { return c.record.repeats.size() > 1; }))
        text += fmt::format("; {} not the same, bit for bit, when repeated",
                            count_of([](const StudyCase& c) { return !c.record.same; }));
    return text + ".\n";
}

/// A row per run with all its values: for studies that measure no error.
std::string value_matrix(const scene::Study& study, const std::vector<StudyCase>& cases) {
    const bool expected = std::ranges::any_of(
        cases, [](const StudyCase& c) { return c.record.finished() && c.record.expectation != "none"; });
    Words columns = axis_names(study);
    columns.emplace_back("outcome");
    if (expected) columns.emplace_back("expectation");
    for (const scene::StudyQuantity& q : study.quantities)
        columns.push_back(q.unit.empty() ? q.label : q.label + ", " + q.unit);
    for (const char* name : {"CPU s", "remark"}) columns.emplace_back(name);
    std::string text = header(columns);
    for (const StudyCase& c : cases) {
        const StudyRecord& r = c.record;
        Words cells = axis_values(study, c);
        cells.push_back(r.status == "done" ? "completed" : outcome(r));
        if (expected) cells.push_back(r.finished() ? r.expectation : "-");
        for (std::size_t k = 0; k < study.quantities.size(); ++k)
            cells.push_back(c.results.empty() ? "-" : figure(c.results[k].value));
        cells.push_back(seconds(r.median(&StudyRepeat::cpu)));
        cells.push_back(r.reason + (r.same ? "" : std::string(r.reason.empty() ? "" : "; ") + "repeats differ"));
        for (std::string& cell : cells) std::ranges::replace(cell, '|', '/');
        text += row(cells);
    }
    return text;
}

std::string error_head(const scene::StudyQuantity& q, bool relative) {
    if (!q.exact.empty()) return q.scale.empty() ? "error" : "error / (" + q.scale.text + ")";
    return relative ? "relative error" : "error";
}

std::string quantity_table(const scene::Study& study, const std::vector<StudyCase>& cases, std::size_t k,
                           const std::vector<const StudyCase*>& front) {
    const scene::StudyQuantity& q = study.quantities[k];
    const bool value = q.exact.empty(), error = q.has_error();
    Words columns = axis_names(study);
    if (value) columns.push_back(q.unit.empty() ? "value" : "value, " + q.unit);
    if (value && error) columns.emplace_back("reference");
    if (error) columns.push_back(error_head(q, is_relative(q, cases, k)));
    columns.emplace_back("CPU s");
    if (error) columns.emplace_back("front");
    std::string text = header(columns);
    for (const StudyCase& c : cases) {
        const QuantityResult result = c.results.empty() ? QuantityResult{} : c.results[k];
        Words cells = axis_values(study, c);
        if (value) cells.push_back(measure(result.value));
        if (value && error) cells.push_back(measure(result.reference));
        if (error) cells.push_back(number(result.error));
        cells.push_back(seconds(c.record.median(&StudyRepeat::cpu)));
        if (error) cells.emplace_back(std::ranges::count(front, &c) > 0 ? "\\*" : "");
        text += row(cells);
    }
    return text;
}

std::string slope(const std::optional<study::PowerLaw>& law) {
    return law ? fmt::format("{:.2f}", law->slope) : "-";
}

std::string slope_table(const scene::Study& study, const std::vector<StudySeries>& series, std::size_t k) {
    Words columns{"series", "slope over CPU seconds"};
    if (study.refine >= 0) columns.push_back("slope over " + abscissa_label(study));
    std::string text;
    for (const StudySeries& s : series) {
        const auto work = study::fit_power_law(work_points(s, k));
        const auto order = study.refine >= 0 ? study::fit_power_law(convergence_points(study, s, k)) : std::nullopt;
        if (!work && !order) continue;
        Words cells{s.name, slope(work)};
        if (study.refine >= 0) cells.push_back(slope(order));
        text += row(cells);
    }
    return text.empty() ? text : header(columns) + text;
}

/// What to say of two series of one problem that share no error: whose errors are all the smaller.
std::string apart(const std::vector<study::CostPoint>& first, const std::vector<study::CostPoint>& second) {
    const auto errors = [](const std::vector<study::CostPoint>& points) {
        std::vector<double> list;
        for (const study::CostPoint& p : points)
            if (p.error > 0) list.push_back(p.error);
        return list;
    };
    const std::vector<double> a = errors(first), b = errors(second);
    if (a.empty() || b.empty()) return "-";
    if (std::ranges::max(a) < std::ranges::min(b)) return "always below";
    return std::ranges::max(b) < std::ranges::min(a) ? "always above" : "-";
}

/// How many times the CPU seconds of the column's series the row's takes.
std::string ratio_table(const std::vector<StudySeries>& series, std::size_t k) {
    constexpr std::size_t most = 8; // columns of a table that can still be read
    if (series.size() < 2) return {};
    const std::size_t shown = series.size() <= most ? series.size() : 1;
    Words columns{"CPU seconds of ... over those of"};
    for (std::size_t j = 0; j < shown; ++j) columns.push_back(series[j].name);
    std::string text = header(columns);
    bool any = false;
    for (std::size_t i = 0; i < series.size(); ++i) {
        Words cells{series[i].name};
        for (std::size_t j = 0; j < shown; ++j) {
            const auto first = work_points(series[i], k), second = work_points(series[j], k);
            const bool comparable = i != j && series[i].problem == series[j].problem;
            const auto ratio = comparable ? study::cost_ratio(first, second) : std::nullopt;
            const std::string none = i == j ? "1" : comparable ? apart(first, second) : "-";
            any = any || (none != "1" && none != "-") || ratio;
            cells.push_back(ratio ? fmt::format("{:.3g} (at {:.2g})", ratio->ratio, ratio->error) : none);
        }
        text += row(cells);
    }
    return any ? text : "";
}

std::string paragraph(const std::string& text) {
    std::string trimmed = text;
    while (!trimmed.empty() && std::isspace(static_cast<unsigned char>(trimmed.back()))) trimmed.pop_back();
    return trimmed.empty() ? "" : trimmed + "\n\n";
}

std::string quantity_section(const scene::Study& study, const std::vector<StudyCase>& cases,
                             const std::vector<StudySeries>& series, std::size_t k) {
    const scene::StudyQuantity& q = study.quantities[k];
    std::string text = "## " + q.label + "\n\n";
    const auto front = q.has_error() ? pareto_cases(study, cases, k) : std::vector<const StudyCase*>{};
    text += quantity_table(study, cases, k, front) + "\n";
    if (!q.has_error()) return text;
    if (!front.empty()) {
        text += "On the Pareto front of error and CPU seconds: ";
        for (const StudyCase* c : front)
            text +=
                fmt::format("{}{} ({}, {} s)", c == front.front() ? "" : "; ", fmt::join(axis_values(study, *c), " "),
                            number(c->results[k].error), seconds(c->record.median(&StudyRepeat::cpu)));
        text += ".\n\n";
    }
    if (const std::string table = slope_table(study, series, k); !table.empty()) text += table + "\n";
    if (const std::string table = ratio_table(series, k); !table.empty())
        text += "Times at equal error, that error in brackets; *always below*: all its errors are smaller than the "
                "other's:\n\n" +
                table + "\n";
    if (!q.plot) return text;
    text += fmt::format("![{0}: error over CPU seconds]({1}_work.png)\n\n", q.label, q.name);
    if (study.refine >= 0) text += fmt::format("![{0}: convergence]({1}_convergence.png)\n\n", q.label, q.name);
    return text;
}

} // namespace

void write_study_report(const scene::Study& study, const std::vector<StudyCase>& cases,
                        const std::filesystem::path& folder, const std::string& command) {
    const std::vector<StudySeries> series = make_series(study, cases);
    std::string text = "# " + study.title + "\n\n" + paragraph(study.problem);
    if (!study.source.empty()) text += "Reference: " + paragraph(study.source);
    text += "Regenerate with `" + command + "`.\n\n";
    if (std::ranges::any_of(study.quantities, &scene::StudyQuantity::has_error)) {
        for (std::size_t k = 0; k < study.quantities.size(); ++k) text += quantity_section(study, cases, series, k);
        text += curve_sections(study, cases);
        text += "## Runs\n\n" + run_table(study, cases) + "\n";
    } else {
        text += tally(cases) + "\n" + value_matrix(study, cases) + "\n" + curve_sections(study, cases);
    }
    std::size_t repeats = 0;
    for (const StudyCase& c : cases) repeats = std::max(repeats, c.record.repeats.size());
    if (repeats > 1) text += fmt::format("Times are medians of up to {} runs.\n\n", repeats);
    for (const StudyCase& c : cases)
        if (!c.record.same) text += fmt::format("Repeats of {} did not give the same bits.\n\n", c.id);
    if (!study.defects.empty()) text += "## Known defects\n\n" + paragraph(study.defects);
    while (text.ends_with("\n\n")) text.pop_back();
    std::ofstream file(folder / "study.md", std::ios::binary);
    file << text;
    if (!file.flush()) throw std::runtime_error("cannot write " + (folder / "study.md").string());
}

} // namespace osculate::app
