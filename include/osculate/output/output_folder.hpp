#pragma once
/// The folder that a run or a study writes into, and the manifest of what it wrote there.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace osculate::output {

/// Keeps a list of every file that Osculate writes into a folder, as a file of the folder: osculate_manifest.txt, a path a line
/// below a line that says what it is. A path is in the list before its file is there, so that whatever ends the process, no file is
/// unlisted. Nothing but what is listed is ever removed, and nothing outside of the folder. As long as this object lives, no other
/// one of a process on this machine enters the folder: the manifest is locked, and the system ends the lock with the process.
class OutputFolder {
public:
    enum class Entry {
        careful, ///< a folder that is absent, or empty, or holds a manifest; files that it does not list are not overwritten
        adopt, ///< of a run, as a checkpoint in it shows. Where its first wanted file is unlisted, no list was kept: all are listed
        force, ///< any folder; files that are written take the place of those of their names
        beside, ///< a folder that is there, without a lock: another process may be at work. Without a manifest as `force`
    };

    static constexpr const char* manifest = "osculate_manifest.txt";

    /// Enters a folder, which is made when absent. Files are still as they were.
    /// @param wanted  files that will be written, `*` standing for a number: with `careful` none of them may be there unlisted
    /// @throws SceneError where the folder holds what Osculate did not write, another process is in it, or its manifest names
    ///         places outside; RunFailure where it cannot be written
    OutputFolder(std::filesystem::path directory, Entry entry, const std::vector<std::string>& wanted = {});
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return directory_; }
    /// Relative to the folder, with '/' between names.
    [[nodiscard]] const std::set<std::string>& files() const { return files_; }
    /// Whether files that are not in the list may be overwritten.
    [[nodiscard]] bool forced() const { return forced_; }

    /// Puts files into the list, which has to be done before they are written.
    /// @throws RunFailure where one is there that Osculate did not write
    void claim(const std::vector<std::string>& files);
    /// The same for one. @returns its path
    std::filesystem::path path_of(const std::string& file);

    /// Removes the files that are in the list and not in `kept`, parts of files that were being written, and folders that are
    /// empty then.
    /// @throws SceneError where one lies behind a symbolic link, before anything is removed; RunFailure where it cannot be
    void remove_all_but(const std::set<std::string>& kept);
    /// Removes all that is in the list and the manifest, and the folder where nothing else is in it. The last thing to be done.
    void remove_everything();

    /// Whether a folder holds a manifest.
    [[nodiscard]] static bool has_manifest(const std::filesystem::path& directory);
    /// `directory`, or where something is in it the first of `directory`-2, `directory`-3, ... that is not there; made.
    /// @throws RunFailure where none can be made
    [[nodiscard]] static std::filesystem::path numbered(std::filesystem::path directory);

private:
    void lock();
    [[nodiscard]] bool make_manifest();
    void write_manifest();
    void read_manifest();
    void refuse_strangers() const;
    void adopt(const std::vector<std::string>& wanted);
    void refuse_overwriting(const std::vector<std::string>& wanted) const;
    [[nodiscard]] std::vector<std::string> unlisted(const std::vector<std::string>& patterns) const;
    void append(const std::vector<std::string>& files);

    std::filesystem::path directory_;
    bool forced_ = false, locks_ = true;
    std::set<std::string> files_;
    int file_ = -1; ///< the manifest, locked
};

} // namespace osculate::output
