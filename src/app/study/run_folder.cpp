#include "app/study/run_folder.hpp"

#include "osculate/output/output_folder.hpp"

#include <fmt/format.h>
#include <vector>

namespace osculate::app {

namespace fs = std::filesystem;
using output::OutputFolder;

std::string repeat_folder(std::size_t repeat) {
    return fmt::format("repeat_{}", repeat);
}

void make_run_folder(const fs::path& folder, bool force) {
    OutputFolder run(folder, force ? OutputFolder::Entry::force : OutputFolder::Entry::careful);
    run.remove_all_but({});
    std::error_code none;
    for (const char* file : {messages_file, exit_code_file})
        fs::remove(folder / file, none); // the study's list has them
    for (std::size_t repeat = 2; OutputFolder::has_manifest(folder / repeat_folder(repeat)); ++repeat)
        remove_run_folder(folder / repeat_folder(repeat)); // of a study that was killed
}

void remove_run_folder(const fs::path& folder) {
    std::error_code none;
    fs::remove(folder / messages_file, none);
    OutputFolder(folder, OutputFolder::Entry::careful).remove_everything();
}

} // namespace osculate::app
