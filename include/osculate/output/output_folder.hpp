#pragma once
/// The output folder of a run or a study, and the manifest of the files written there.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace osculate::output {

/// Keeps a list of every file that Osculate writes into a folder, in a file of this folder: osculate_manifest.txt, with
/// a line that describes it and then one path per line. A path enters the list before its file is created, so that
/// every file is listed even if the process is killed. Only listed files inside the folder are ever removed. While this
/// object exists, no other object of any process on this machine can enter the folder: the manifest is locked, and the
/// system releases the lock when the process ends.
class OutputFolder {
public:
    enum class Entry {
        careful, ///< a folder that is absent, empty, or has a manifest; never overwrites unlisted files
        adopt, ///< a run's folder with a checkpoint. If its first wanted file is unlisted, lists all wanted files found
        force, ///< any folder; overwrites files with the same names
        beside, ///< an existing folder, without a lock: another process may work there. Without a manifest like `force`
    };

    static constexpr const char* manifest = "osculate_manifest.txt";

    /// Enters a folder, and creates it if absent. Does not change its files.
    /// @param wanted  files to be written, `*` stands for a number: with `careful` none of them may exist unlisted
    /// @throws SceneError if the folder contains files not written by Osculate, another process is in it, or its
    ///         manifest names places outside; RunFailure if it cannot be written
    OutputFolder(std::filesystem::path directory, Entry entry, const std::vector<std::string>& wanted = {});
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return directory_; }
    /// Listed files, relative to the folder, with '/' between names.
    [[nodiscard]] const std::set<std::string>& files() const { return files_; }
    /// Whether unlisted files may be overwritten.
    [[nodiscard]] bool forced() const { return forced_; }

    /// Adds files to the list; call this before writing them.
    /// @throws RunFailure if one exists that Osculate did not write
    void claim(const std::vector<std::string>& files);
    /// The same for one file. @returns its path
    std::filesystem::path path_of(const std::string& file);

    /// Removes the listed files that are not in `kept`, unfinished temporary files, and folders that are empty then.
    /// @throws SceneError if one is behind a symbolic link, before anything is removed; RunFailure if it cannot be
    ///         removed
    void remove_all_but(const std::set<std::string>& kept);
    /// Removes all listed files, the manifest, and the folder if it is empty then. Must be the last call.
    void remove_everything();

    /// Whether a folder contains a manifest.
    [[nodiscard]] static bool has_manifest(const std::filesystem::path& directory);
    /// Creates `directory` or, if that is not empty, the first of `directory`-2, `directory`-3, ... that is absent or
    /// empty.
    /// @throws RunFailure if none can be created
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
