#include "app/command/study_command.hpp"

#include "app/study/run_folder.hpp"
#include "app/study/study_curves.hpp"
#include "app/study/study_emit.hpp"
#include "app/study/study_files.hpp"
#include "app/study/study_runner.hpp"
#include "osculate/core/error.hpp"
#include "osculate/scene/nearest.hpp"
#include "osculate/study/formulas.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <sstream>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

/// What regenerates the study.
std::string command_of(const std::string& path, const StudyOptions& options) {
    std::string text = "osculate study " + path;
    if (!options.directory.empty()) text += " -o " + options.directory.string();
    for (const scene::Override& change : options.overrides)
        text += fmt::format(" --set '{}={}'", change.key, change.value);
    if (options.repeats > 0) text += fmt::format(" --repeats {}", options.repeats);
    if (options.threads > 1) text += fmt::format(" --threads {}", options.threads);
    return text;
}

/// Words of the program that gather the study from wherever they are given.
std::vector<std::string> gather_words(const std::string& path, const fs::path& folder, const StudyOptions& options) {
    std::vector<std::string> words{"study", fs::absolute(path).lexically_normal().string(), "-o",
                                   fs::absolute(folder).lexically_normal().string(), "--gather"};
    for (const scene::Override& change : options.overrides)
        words.insert(words.end(), {"--set", change.key + "=" + change.value});
    if (options.repeats > 0) words.insert(words.end(), {"--repeats", std::to_string(options.repeats)});
    return words;
}

/// Values of every axis that --only names.
std::vector<std::vector<std::size_t>> chosen(const scene::Study& study, const std::vector<std::string>& only) {
    std::vector<std::vector<std::size_t>> values(study.axes.size());
    std::vector<Fault> faults;
    const auto index = [&](const std::string& name, const std::vector<std::string>& known, const char* what) {
        const auto at = std::ranges::find(known, name);
        if (at == known.end())
            faults.push_back({"--only", 0, 0, "", fmt::format("{}: {}", what, fmt::join(known, ", ")), "'" + name + "'",
                              scene::nearest(name, known)});
        return static_cast<std::size_t>(at - known.begin());
    };
    std::vector<std::string> axes;
    for (const scene::StudyAxis& axis : study.axes) axes.push_back(axis.name);
    for (const std::string& text : only) {
        const std::size_t equals = text.find('=');
        const std::size_t a = index(text.substr(0, equals), axes, "an axis");
        if (a == axes.size()) continue;
        std::vector<std::string> names;
        for (const scene::AxisValue& value : study.axes[a].values) names.push_back(value.name);
        std::istringstream list(text.substr(equals + 1));
        for (std::string name; std::getline(list, name, ',');) values[a].push_back(index(name, names, "a value"));
    }
    if (!faults.empty()) throw SceneError(std::move(faults));
    return values;
}

/// Every file that the study itself may write, its runs' own apart, relative to its folder.
std::vector<std::string> files_of(const scene::Study& study, const std::vector<StudyCase>& cases, int repeats) {
    std::vector<std::string> names{"study.csv", "study.md", "study.gp", "Snakefile", "cases.txt", "study.sbatch"};
    for (const scene::StudyQuantity& q : study.quantities)
        for (const char* plot : {"_work", "_convergence"})
            for (const char* ending : {".svg", ".png"}) names.push_back(q.name + plot + ending);
    for (std::string& file : curve_files(study)) names.push_back(std::move(file));
    for (const StudyCase& c : cases) {
        const std::string run = "runs/" + c.id + "/";
        for (const char* file : {record_file, messages_file, exit_code_file}) names.push_back(run + file);
        for (int repeat = 2; repeat <= repeats; ++repeat)
            names.push_back(run + repeat_folder(static_cast<std::size_t>(repeat)) + "/" + messages_file);
    }
    return names;
}

long count(const std::vector<StudyCase>& cases, const char* status) {
    return std::ranges::count_if(cases, [&](const StudyCase& c) { return c.record.status == status; });
}

} // namespace

std::string run_study(const std::string& path, const StudyOptions& options) {
    const scene::Study study = scene::read_study(path, study_functions(), options.overrides);
    const std::vector<std::vector<std::size_t>> only = chosen(study, options.only);
    const fs::path folder =
        chosen_folder(options.directory.empty() ? fs::path("out") / study.name : options.directory, options.folder);
    std::vector<StudyCase> cases = make_cases(study, folder, options.overrides);
    const StudyRunOptions run{
        options.jobs,  std::max(1, options.threads), options.repeats > 0 ? options.repeats : study.repeats, only,
        options.quiet, options.folder.force};
    const std::vector<std::string> names = files_of(study, cases, run.repeats);
    output::OutputFolder files(folder, entry_of(options.folder), names);
    files.claim(names);
    if (options.folder.numbered) std::fputs((folder.string() + "\n").c_str(), stdout);
    if (!options.emit.empty()) {
        check_cases(study, cases, run);
        return options.emit == "slurm" ? emit_slurm(study, cases, run, folder, gather_words(path, folder, options))
                                       : emit_snakemake(study, cases, run, folder, gather_words(path, folder, options));
    }
    const auto update = [&] {
        measure(study, cases);
        write_study_table(study, cases, folder);
    };
    update();
    if (!options.report_only) {
        check_cases(study, cases, run);
        run_cases(cases, run, update);
    }
    write_study_report(study, cases, folder, command_of(path, options));
    write_curve_tables(study, cases, folder);
    const std::string plots = write_study_plots(study, cases, folder);

    std::string text = fmt::format("{}: {} of {} runs done", study.name, count(cases, "done"), cases.size());
    for (const auto& [status, words] : {std::pair{"gave_up", "gave up"}, std::pair{"refused", "refused"}})
        if (const long n = count(cases, status); n > 0) text += fmt::format(", {} {}", n, words);
    text += fmt::format("; see {}/study.md and study.csv; {}\n", folder.string(), plots);
    std::string bugs;
    for (const StudyCase& c : cases)
        if (c.record.status == "bug") bugs += fmt::format("{}{}: {}", bugs.empty() ? "" : "; ", c.id, c.record.reason);
    require(bugs.empty(), bugs.c_str());
    return text;
}

std::string formula_table() {
    std::string text = "| formula | value | source |\n|---|---|---|\n";
    for (const study::NamedSolution& f : study::formulas())
        text += fmt::format("| `{}({})` | {} | {} |\n", f.name, f.parameters, f.meaning, f.source);
    return text;
}

} // namespace osculate::app
