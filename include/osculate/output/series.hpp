#pragma once
/// The list of a run's frames that ParaView opens.

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::output {

/// series.pvd: which file holds which part at which time. The file is whole and valid at any moment of the run.
class Series {
public:
    /// Makes the folder when missing and writes a series without frames, so that none of an earlier run stays.
    /// @throws std::runtime_error with path and reason, as flush() does
    explicit Series(std::filesystem::path directory);

    /// Notes a file; it is listed from the next flush() on.
    /// @param time           s
    /// @param part_name      body or surface; parts are numbered in the order of their first appearance
    /// @param relative_file  relative to the series' folder
    void add(double time, const std::string& part_name, const std::string& relative_file);

    /// Replaces series.pvd by one with every file added so far. O(files)
    void flush();

private:
    struct Entry {
        double time;
        std::size_t part; ///< index into parts_
        std::string file;
    };
    std::filesystem::path path_;
    std::vector<std::string> parts_;
    std::vector<Entry> entries_;
};

} // namespace osculate::output
