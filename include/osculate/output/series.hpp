#pragma once
/// The list of a run's frames that ParaView opens.

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::output {

/// A file of a frame.
struct SeriesEntry {
    double time = 0;        ///< s
    std::string part, file; ///< body or surface; file relative to the series' folder
};

/// series.pvd: the file of each part at each time. The file is complete and valid at any moment of the run.
class Series {
public:
    /// Creates the folder if missing and writes a series of only these frames.
    /// @throws std::runtime_error with path and reason, like flush()
    explicit Series(std::filesystem::path directory, std::vector<SeriesEntry> earlier = {});

    /// Adds a file; the next flush() lists it.
    /// @param time           s
    /// @param part_name      body or surface; parts are numbered in the order of their first appearance
    /// @param relative_file  relative to the series' folder
    void add(double time, const std::string& part_name, const std::string& relative_file);
    /// Every file added so far.
    [[nodiscard]] const std::vector<SeriesEntry>& entries() const { return entries_; }

    /// Replaces series.pvd by one with all files added so far. O(files)
    void flush();

private:
    std::filesystem::path path_;
    std::vector<SeriesEntry> entries_;
};

} // namespace osculate::output
