#include "osculate/app/run.hpp"

#include "app/run/interruption.hpp"
#include "app/run/run_recorder.hpp"
#include "osculate/app/load.hpp"
#include "osculate/app/report.hpp"
#include "osculate/app/version.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/scene/locate.hpp"
#include "osculate/scene/units.hpp"
#include "osculate/scene/writer.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& file, const std::string& expected, const std::string& found) {
    Fault fault;
    fault.file = file.string();
    fault.expected = expected;
    fault.found = found;
    throw SceneError({fault});
}

using output::OutputFolder;

/// Whether the run of a folder has come to its end, its report included.
bool is_complete(const fs::path& folder) {
    std::error_code none;
    const auto summary = nlohmann::json::parse(file_content(folder / "summary.json", none), nullptr, false);
    if (!summary.is_object() || summary.value("status", nlohmann::json()) != "done") return false;
    return fs::exists(folder / "report.html") || !scene::read_scene((folder / "scene.yaml").string()).output.report;
}

/// Folder of a run's files, where the resolved scene must not take the place of the one a user wrote.
fs::path folder_of(const LoadedScene& loaded, const RunOptions& options) {
    fs::path folder = chosen_folder(options.directory.empty() ? fs::path("out") / loaded.scene.name : options.directory,
                                    options.folder);
    std::error_code none;
    if (!loaded.path.empty() && fs::equivalent(folder / "scene.yaml", loaded.path, none))
        refuse(loaded.path, "another output folder",
               "'" + folder.string() + "', where the resolved scene would replace this file");
    return folder;
}

/// Tells two observers, one after the other.
class Both final : public time::StepObserver {
public:
    Both(time::StepObserver& first, time::StepObserver& second) : first_(first), second_(second) {}

    void attempted(const time::Attempt& attempt, const std::vector<equilibrium::IterationRecord>& iterations) override {
        first_.attempted(attempt, iterations);
        second_.attempted(attempt, iterations);
    }
    void accepted(const time::AcceptedStep& step) override {
        first_.accepted(step);
        second_.accepted(step);
    }
    void between_steps(const std::function<time::Checkpoint()>& checkpoint) override {
        first_.between_steps(checkpoint);
        second_.between_steps(checkpoint);
    }
    void gave_up(const time::PostMortem& found, const time::FailedIterate* iterate) override {
        first_.gave_up(found, iterate);
        second_.gave_up(found, iterate);
    }

private:
    time::StepObserver &first_, &second_;
};

/// A full disk is told beside: how to go on is what matters.
void finish_interrupted(RunRecorder& recorder, const char* reason) {
    const auto tell = [](auto&& act) {
        try {
            act();
        } catch (const RunFailure& failure) {
            fmt::print(stderr, "{}\n", failure.what());
        }
    };
    tell([&] { recorder.wait_for_frames(); });
    tell([&] { recorder.finish("interrupted", reason); });
}

output::Summary run(const LoadedScene& loaded, time::Stepper& stepper, Timings& timings,
                    const RunRecorder::Settings& settings, time::StepObserver* beside, bool heed_signals) {
    std::optional<Interruption> interruption;
    if (heed_signals) interruption.emplace();
    RunRecorder::Settings heeding = settings;
    heeding.interruption = interruption ? &*interruption : nullptr;
    if (settings.from != nullptr) stepper.resume(settings.from->run);
    if (settings.derivatives != nullptr) stepper.lead(settings.derivatives->runs());
    RunRecorder recorder(loaded.scene, loaded.plan, stepper, timings, heeding);
    try {
        if (beside != nullptr) {
            Both both(recorder, *beside);
            stepper.run(both);
        } else {
            stepper.run(recorder);
        }
        recorder.wait_for_frames();
    } catch (const Interrupted& ended) {
        finish_interrupted(recorder, ended.what());
        throw;
    } catch (const Stopped& ended) {
        finish_interrupted(recorder, ended.what());
        throw;
    } catch (const RunFailure& failure) {
        try {
            recorder.wait_for_frames();
            recorder.finish("gave_up", failure.what());
        } catch (const RunFailure&) { // a full disk: the first failure is the one to tell
        }
        if (recorder.post_mortem().empty()) throw;
        throw GaveUp(failure.what(), recorder.post_mortem());
    }
    if (settings.derivatives != nullptr) settings.derivatives->finish(settings.folder->path());
    recorder.finish("done");
    return recorder.summary();
}

output::Summary run(LoadedScene& loaded, const RunRecorder::Settings& settings, Timings& timings) {
    time::Stepper stepper(loaded.plan.model, loaded.plan.stages, loaded.plan.stepper, timings);
    return run(loaded, stepper, timings, settings, nullptr, true);
}

/// Of several processes, or the only one: it writes all but the others' parts of the frames.
bool is_first(const RunOptions& options) {
    return !options.ranks || options.ranks->rank() == 0;
}

/// Empty: there is none.
std::string first_derivative(const scene::Output& output) {
    if (!output.derivatives.empty()) return output.derivatives.front().first;
    return output.gradients.empty() ? std::string() : output.gradients.front().first;
}

/// Null where the scene asks for none.
std::unique_ptr<Derivatives> derivatives_of(const LoadedScene& loaded, const RunOptions& options, Timings& timings) {
    const scene::Output& asked = loaded.scene.output;
    if (asked.derivatives.empty() && asked.gradients.empty()) return nullptr;
    if (options.checkpoint_every.steps > 0 || options.checkpoint_every.seconds > 0)
        refuse("--checkpoint-every",
               "a run without output.derivatives and output.gradients, which are in no checkpoint",
               "'" + first_derivative(asked) + "'");
    try {
        return std::make_unique<Derivatives>(loaded, options.threads, timings);
    } catch (const SceneError& error) {
        if (loaded.path.empty()) throw;
        throw SceneError(scene::locate(error.faults(), loaded.path));
    }
}

/// What the first process writes alone.
void leave_to_the_first(scene::Output& output) {
    output.report = output.paraview = output.failed_iterate = false;
    output.plots.clear();
}

/// Enters the run's folder, or another one of a process that is not the first; all fail where one does, as the first one says.
/// @param frames_folder  the run's folder, in a process that is not the first
template <class Enter>
std::unique_ptr<OutputFolder> entered(const RunOptions& options, fs::path& frames_folder, Enter&& enter) {
    if (!options.ranks) return enter();
    const std::string bad_scene = "2", failure = "3"; // in place of a path, which begins with a slash
    const bool first = is_first(options);
    std::unique_ptr<OutputFolder> folder;
    const auto tell = [&](const std::string& what) { return options.ranks->said_by(0, what); };
    try {
        folder = enter();
    } catch (const SceneError&) {
        if (first) (void)tell(bad_scene);
        throw;
    } catch (const RunFailure&) {
        if (first) (void)tell(failure);
        throw;
    }
    const std::string told = tell(first ? fs::absolute(folder->path()).string() : std::string());
    if (told == bad_scene) refuse("the run's folder", "one that the first process can enter", "none");
    if (told == failure) throw RunFailure("the first process cannot enter the run's folder");
    std::error_code none;
    const bool seen = fs::exists(fs::path(told) / OutputFolder::manifest, none);
    if (const double blind = options.ranks->largest(seen ? -1 : options.ranks->rank()); blind >= 0)
        refuse(told, "a folder that all processes see, as each writes its part of the frames",
               fmt::format("process {} does not", blind));
    if (!first) frames_folder = told;
    return folder;
}

/// For a process whose tables nobody reads, but which goes on with them like the first.
void copy_tables(const output::CheckpointFile& file, const fs::path& from, const fs::path& to) {
    for (const auto& [name, bytes] : file.tables) {
        fs::create_directories((to / name).parent_path());
        fs::copy_file(from / name, to / name, fs::copy_options::overwrite_existing);
    }
}

} // namespace

CheckpointEvery parse_checkpoint_every(const std::string& text) {
    const scene::Quantity quantity = scene::parse_quantity(text);
    const bool time = quantity.has_unit && quantity.dimension == scene::dimension::time;
    const bool steps = !quantity.has_unit && quantity.value == std::floor(quantity.value) && quantity.value < 1e9;
    if (!quantity.problem.empty() || !(quantity.value > 0) || !std::isfinite(quantity.value) || (!time && !steps))
        refuse("--checkpoint-every", "a number of steps or a time such as '5 min'", "'" + text + "'");
    CheckpointEvery every;
    if (time)
        every.seconds = quantity.value;
    else
        every.steps = static_cast<long>(quantity.value);
    return every;
}

Interrupted::Interrupted(int signal, double time, fs::path directory)
    : std::runtime_error(fmt::format("interrupted at {} s; `osculate resume {}` goes on", scene::number_text(time),
                                     directory.string())),
      signal_(signal) {}

Interrupted::Interrupted(int signal, double time)
    : std::runtime_error(
          fmt::format("interrupted at {} s; a run with derivatives or gradients cannot go on later: run it again",
                      scene::number_text(time))),
      signal_(signal) {}

output::Summary run(const std::string& scene_path, const std::vector<scene::Override>& overrides,
                    const RunOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    Timings timings;
    LoadedScene loaded = load(scene_path, overrides, options.threads, timings, options.ranks);
    if (!is_first(options)) leave_to_the_first(loaded.scene.output);
    const auto derivatives = derivatives_of(loaded, options, timings);
    fs::path frames_folder;
    const auto folder = entered(options, frames_folder, [&] {
        return std::make_unique<OutputFolder>(folder_of(loaded, options), entry_of(options.folder),
                                              RunRecorder::files(loaded.scene, loaded.plan));
    });
    if (options.entered) options.entered(folder->path());
    RunRecorder::Settings settings{folder.get(), options.threads, options.quiet, begin, options.checkpoint_every};
    settings.derivatives = derivatives.get();
    settings.frames_folder = frames_folder;
    return run(loaded, settings, timings);
}

output::Summary run(const LoadedScene& loaded, time::Stepper& stepper, Timings& timings, const RunOptions& options,
                    time::StepObserver* beside) {
    const auto derivatives = derivatives_of(loaded, options, timings);
    OutputFolder folder(folder_of(loaded, options), entry_of(options.folder),
                        RunRecorder::files(loaded.scene, loaded.plan));
    if (options.entered) options.entered(folder.path());
    RunRecorder::Settings settings{&folder, options.threads, options.quiet, std::chrono::steady_clock::now(),
                                   options.checkpoint_every};
    settings.derivatives = derivatives.get();
    return run(loaded, stepper, timings, settings, beside, options.heed_signals);
}

OutputFolder::Entry entry_of(const FolderOptions& options) {
    return options.force ? OutputFolder::Entry::force : OutputFolder::Entry::careful;
}

fs::path chosen_folder(const fs::path& directory, const FolderOptions& options) {
    return options.numbered ? OutputFolder::numbered(directory) : directory;
}

std::optional<output::Summary> resume(const fs::path& directory, const fs::path& from, const RunOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    const fs::path scene_path = directory / "scene.yaml", state = from.empty() ? directory / checkpoint_path : from;
    std::error_code none;
    if (!fs::is_regular_file(scene_path, none))
        refuse(directory, "the folder of a run", fs::exists(directory, none) ? "no scene.yaml in it" : "nothing there");
    if (from.empty() && is_complete(directory)) return {};
    if (!fs::is_regular_file(state, none))
        refuse(state, "a checkpoint", "nothing there; `osculate run --checkpoint-every 20` writes one every 20 steps");
    output::CheckpointFile file;
    try {
        file = output::read_checkpoint(state);
    } catch (const std::runtime_error& error) {
        fs::path previous = state;
        previous += ".previous";
        refuse(state, "a checkpoint",
               std::string(error.what()) +
                   (fs::exists(previous, none) ? "; the one before it: --from " + previous.string() : ""));
    }
    if (file.version != version)
        refuse(state, std::string("a checkpoint of osculate ") + version, "one of " + file.version);
    Timings timings;
    LoadedScene loaded = load(scene_path.string(), {}, options.threads, timings, options.ranks);
    if (scene::write_scene(loaded.scene) != file.scene)
        refuse(scene_path, "the scene the checkpoint was written for", "another one");
    if (output::fingerprint(loaded.plan.model) != file.meshes)
        refuse(scene_path, "the meshes the checkpoint was written for", "others");
    if (const std::string asked = first_derivative(loaded.scene.output); !asked.empty())
        refuse(scene_path, "a scene without output.derivatives and output.gradients, which are in no checkpoint",
               "'" + asked + "'");
    if (!is_first(options)) {
        copy_tables(file, directory, options.directory);
        leave_to_the_first(loaded.scene.output);
        file.frames.clear();
    }
    fs::path frames_folder;
    const auto folder = entered(options, frames_folder, [&] {
        return std::make_unique<OutputFolder>(is_first(options) ? directory : options.directory,
                                              OutputFolder::Entry::adopt,
                                              RunRecorder::files(loaded.scene, loaded.plan));
    });
    RunRecorder::Settings settings{folder.get(), options.threads,          options.quiet,
                                   begin,        options.checkpoint_every, &file};
    settings.frames_folder = frames_folder;
    return run(loaded, settings, timings);
}

} // namespace osculate::app
