#include "app/study/study_emit.hpp"

#include "app/shell_words.hpp"
#include "app/study/run_folder.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/core/printable.hpp"

#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

std::string line_of(const StudyCase& c, const StudyRunOptions& options) {
    return shell_line(
        run_words(c, fs::absolute(c.scene_path).lexically_normal().string(), fs::path("runs") / c.id, options));
}

/// A text as Python reads it.
std::string literal(const std::string& text) {
    return nlohmann::json(text).dump();
}

std::vector<const StudyCase*> announced(const std::vector<StudyCase>& cases, const StudyRunOptions& options,
                                        bool finished) {
    std::vector<const StudyCase*> list;
    for (const StudyCase& c : cases) {
        if (!is_chosen(c, options) || (c.record.finished() && !finished)) continue;
        announce(c, options.force);
        list.push_back(&c);
    }
    return list;
}

constexpr const char* snakefile = R"(# Runs the study '{name}': snakemake -s {file} --cores all
# Each rule is a run, as `osculate study` would start it; a run that gives up is a result. The last one gathers.
workdir: {directory}

OSCULATE = config.get("osculate", {program})


rule study:
    input: "study.csv"


rule gather:
    input:
{inputs}
    output: "study.csv", "study.md"
    threads: 1
    shell: "{{OSCULATE:q}} " + {gather}
)";

constexpr const char* snake_rule = R"(

rule case_{number}:  # {id}
    output: {output}
    threads: {threads}
    shell:
        "rm -f " + {code} + "; code=0; {{OSCULATE:q}} " + {line} + " || code=$?; "
        "echo $code > " + {code} + "; [ $code -eq 0 ] || [ $code -eq 3 ]"
)";

constexpr const char* sbatch = R"sh(#!/bin/bash
# Runs the study '{name}', one task per line of cases.txt: a name, a tab and the arguments of `osculate`.
#   job=$(sbatch --parsable {file})
#   sbatch --dependency=afterany:$job --wrap {wrap}
# Time, memory and partition are given on the command line of sbatch, or here.
#SBATCH --job-name={job}
#SBATCH --array=1-{count}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={threads}
#SBATCH --output={directory}/runs/slurm-%a.txt
set -u
cd {quoted_directory} || exit 1
osculate=${{OSCULATE:-{program}}}
line=$(sed -n "${{SLURM_ARRAY_TASK_ID}}p" cases.txt)
[ -n "$line" ] || {{ echo "cases.txt has no line ${{SLURM_ARRAY_TASK_ID}}" >&2; exit 1; }}
folder=runs/${{line%%$'\t'*}}
eval "arguments=(${{line#*$'\t'}})"
rm -f "$folder/{code}"
code=0
srun "$osculate" "${{arguments[@]}}" > "$folder/messages.txt" 2>&1 || code=$?
echo $code > "$folder/{code}"
[ $code -eq 0 ] || [ $code -eq 3 ] # a run that gives up is a result
)sh";

/// A text within a string that Snakemake formats.
std::string unformatted(const std::string& text) {
    std::string doubled;
    for (const char c : text) doubled += c == '{' || c == '}' ? std::string(2, c) : std::string(1, c);
    return doubled;
}

} // namespace

std::string emit_snakemake(const scene::Study& study, const std::vector<StudyCase>& cases,
                           const StudyRunOptions& options, const fs::path& folder,
                           const std::vector<std::string>& gather) {
    const fs::path path = folder / "Snakefile";
    std::string inputs, rules;
    int number = 0;
    for (const StudyCase* c : announced(cases, options, true)) {
        const std::string run = "runs/" + c->id, summary = literal(run + "/summary.json");
        inputs += fmt::format("        {},\n", summary);
        const std::string line = line_of(*c, options) + " > " + shell_word(run + "/messages.txt") + " 2>&1";
        rules +=
            fmt::format(snake_rule, fmt::arg("number", ++number), fmt::arg("id", c->id), fmt::arg("output", summary),
                        fmt::arg("threads", options.threads), fmt::arg("line", literal(unformatted(line))),
                        fmt::arg("code", literal(unformatted(shell_word(run + "/" + exit_code_file)))));
    }
    if (!inputs.empty()) inputs.pop_back();
    write_text(path, fmt::format(snakefile, fmt::arg("name", printable(study.name)),
                                 fmt::arg("file", shell_word(path.string())),
                                 fmt::arg("directory", literal(fs::absolute(folder).lexically_normal().string())),
                                 fmt::arg("program", literal(this_program())), fmt::arg("inputs", inputs),
                                 fmt::arg("gather", literal(unformatted(shell_line(gather))))) +
                         rules);
    return fmt::format("{}: {} runs; `snakemake -s {} --cores all` runs what is not finished and gathers the results\n",
                       study.name, number, shell_word(path.string()));
}

std::string emit_slurm(const scene::Study& study, const std::vector<StudyCase>& cases, const StudyRunOptions& options,
                       const fs::path& folder, const std::vector<std::string>& gather) {
    const fs::path path = folder / "study.sbatch";
    const std::string directory = fs::absolute(folder).lexically_normal().string();
    const std::string gathering = "osculate " + shell_line(gather);
    std::string table;
    int count = 0;
    for (const StudyCase* c : announced(cases, options, false)) {
        table += c->id + "\t" + line_of(*c, options) + "\n";
        ++count;
    }
    if (count == 0) return fmt::format("{}: every run is finished; `{}` gathers the results\n", study.name, gathering);
    write_text(folder / "cases.txt", table);
    write_text(path, fmt::format(sbatch, fmt::arg("name", printable(study.name)),
                                 fmt::arg("file", shell_word(path.string())), fmt::arg("wrap", shell_word(gathering)),
                                 fmt::arg("job", job_name(study.name)), fmt::arg("count", count),
                                 fmt::arg("threads", options.threads), fmt::arg("directory", printable(directory)),
                                 fmt::arg("quoted_directory", shell_word(directory)),
                                 fmt::arg("program", shell_word(this_program())), fmt::arg("code", exit_code_file)));
    return fmt::format("{}: {} runs; `sbatch {}` runs them, then `{}` gathers the results\n", study.name, count,
                       shell_word(path.string()), gathering);
}

} // namespace osculate::app
