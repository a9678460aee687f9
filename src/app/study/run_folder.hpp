#pragma once
/// Folders of a study's runs: each has the manifest of its run, and files that the study writes beside.

#include <cstddef>
#include <filesystem>
#include <string>

namespace osculate::app {

/// What the study knows of a run.
inline constexpr const char* record_file = "study_run.json";
/// What a run said.
inline constexpr const char* messages_file = "messages.txt";
/// The exit code, where something else than `osculate study` started the run.
inline constexpr const char* exit_code_file = "exit_code";

/// In the folder of a run: that of its second repeat, its third, ...
[[nodiscard]] std::string repeat_folder(std::size_t repeat);

/// Makes a folder that a run can go into, without what an earlier run left there.
/// @param force  whatever else is in it, see FolderOptions
/// @throws SceneError where something else is in it, or a run is under way; RunFailure where it cannot be written
void make_run_folder(const std::filesystem::path& folder, bool force);

/// Removes what a run has left, and the folder where nothing else is in it.
/// @throws as above
void remove_run_folder(const std::filesystem::path& folder);

} // namespace osculate::app
