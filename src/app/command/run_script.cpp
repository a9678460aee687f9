#include "app/command/run_script.hpp"

#include "app/shell_words.hpp"
#include "osculate/app/estimate.hpp"
#include "osculate/app/load.hpp"
#include "osculate/app/processes.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/core/printable.hpp"

#include <cmath>
#include <fmt/format.h>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* default_interval = "30 min";

constexpr const char* sbatch = R"sh(#!/bin/bash
# Runs the scene '{scene}': sbatch {file}
# Two minutes before the job's time is over, the run writes a checkpoint and ends; the job then queues again and goes on from it.
# Time, partition and account are given on the command line of sbatch, or here. OSCULATE names another program, MPIRUN another
# launcher with its options.
#SBATCH --job-name={job}
#SBATCH --ntasks={processes}
#SBATCH --cpus-per-task={threads}
#SBATCH --mem-per-cpu={megabytes}M
#SBATCH --signal=B:TERM@120
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={output}
set -u
cd {directory} || exit 1
osculate=${{OSCULATE:-{program}}}
name=${{osculate##*/}}
if [ -f {folder}/checkpoint/state ]; then
    arguments=(resume {folder}{every})
else
    arguments=(run {line})
fi
{launch} &
child=$!
trap '{stop}' TERM
wait $child
code=$?
while kill -0 $child 2>/dev/null; do # a signal ended the wait, not the run
    wait $child
    code=$?
done
[ $code -eq 143 ] && scontrol requeue "$SLURM_JOB_ID"
exit $code
)sh";

} // namespace

std::string write_run_script(const RunScript& script, const std::vector<scene::Override>& overrides) {
    Timings unused;
    const LoadedScene loaded = load(script.scene, overrides, script.threads, unused);
    const bool shared = script.processes > 1;
    if (shared)
        if (std::vector<Fault> faults = cannot_be_shared(loaded.plan.model); !faults.empty())
            throw SceneError(std::move(faults));
    const double bytes =
        shared ? process_memory(loaded.plan).of_first(script.processes) : estimate(loaded.scene, loaded.plan).bytes;
    const auto absolute = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
    const fs::path folder = absolute(script.folder.empty() ? fs::path("out") / loaded.scene.name : script.folder);
    const fs::path file = folder.parent_path() / (folder.filename().string() + ".sbatch");

    std::vector<std::string> words{absolute(script.scene).string(), "-o", folder.string(), "--quiet"};
    const std::vector<std::string> every{"--checkpoint-every",
                                         script.checkpoint_every.empty() ? default_interval : script.checkpoint_every,
                                         "--threads", std::to_string(script.threads)};
    for (const std::string& change : script.changes) words.insert(words.end(), {"--set", change});
    words.insert(words.end(), every.begin(), every.end());
    // any one process that is told to stop ends all; mpirun itself would kill them, but srun tells them
    const std::string program = "\"$osculate\" \"${arguments[@]}\"",
                      launch =
                          shared ? fmt::format("${{MPIRUN:-mpirun -n {}}} {} --distributed", script.processes, program)
                                 : program,
                      stop =
                          shared ? "pkill -TERM -P $child \"${name:0:15}\" || kill -TERM $child" : "kill -TERM $child";
    constexpr double margin = Estimate::factor, mega = 1e6;
    fs::create_directories(file.parent_path());
    write_text(file,
               fmt::format(sbatch, fmt::arg("scene", printable(loaded.scene.name)),
                           fmt::arg("file", shell_word(file.string())), fmt::arg("job", job_name(loaded.scene.name)),
                           fmt::arg("processes", script.processes), fmt::arg("threads", script.threads),
                           fmt::arg("megabytes", std::ceil(margin * bytes / mega / script.threads)),
                           fmt::arg("output", shell_word(folder.string() + ".txt")),
                           fmt::arg("directory", shell_word(absolute(fs::current_path()).string())),
                           fmt::arg("program", shell_word(this_program())),
                           fmt::arg("folder", shell_word(folder.string())),
                           fmt::arg("every", " --quiet " + shell_line(every)), fmt::arg("line", shell_line(words)),
                           fmt::arg("launch", launch), fmt::arg("stop", stop)));
    return fmt::format("{}: `sbatch {}` runs it by {} process{}; {:.0f} MB of memory each are estimated, {:.0f} times "
                       "that is asked for\n",
                       loaded.scene.name, shell_word(file.string()), script.processes,
                       script.processes == 1 ? "" : "es", bytes / mega, margin);
}

} // namespace osculate::app
