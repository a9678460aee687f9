#include "osculate/app/run.hpp"

#include "app/run_recorder.hpp"
#include "osculate/app/load.hpp"
#include "osculate/app/report.hpp"
#include "osculate/core/error.hpp"

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

/// The resolved scene must not take the place of the one a user wrote.
void check_folder(const fs::path& folder, const std::string& scene_path) {
    std::error_code none;
    if (!fs::equivalent(folder / "scene.yaml", scene_path, none)) return;
    Fault fault;
    fault.file = scene_path;
    fault.expected = "another output folder";
    fault.found = "'" + folder.string() + "', where the resolved scene would replace this file";
    throw SceneError({fault});
}

} // namespace

output::Summary run(const std::string& scene_path, const std::vector<scene::Override>& overrides,
                    const RunOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    Timings timings;
    LoadedScene loaded = load(scene_path, overrides, options.threads, timings);
    const fs::path folder = options.directory.empty() ? fs::path("out") / loaded.scene.name : options.directory;
    check_folder(folder, scene_path);

    time::Stepper stepper(loaded.plan.model, loaded.plan.stages, loaded.plan.stepper, timings);
    RunRecorder recorder(loaded.scene, loaded.plan, stepper, timings, {folder, options.threads, options.quiet, begin});
    try {
        stepper.run(recorder);
        recorder.wait_for_frames();
    } catch (const RunFailure& failure) {
        try {
            recorder.wait_for_frames();
            recorder.finish("gave_up", failure.what());
        } catch (const RunFailure&) { // a full disk: the first failure is the one to tell
        }
        if (recorder.post_mortem().empty()) throw;
        throw GaveUp(failure.what(), recorder.post_mortem());
    }
    recorder.finish("done");
    return recorder.summary();
}

} // namespace osculate::app
