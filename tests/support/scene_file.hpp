#pragma once
/// Files written by a test.

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

namespace osculate::support {

/// A text with words in the place of others, wherever these stand; one pair after the other.
inline std::string with(std::string text, const std::vector<std::pair<std::string, std::string>>& words) {
    for (const auto& [from, to] : words)
        for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
            text.replace(at, from.size(), to);
    return text;
}

/// Path of a temporary file of this process alone: tests run side by side.
inline std::string temporary(const std::string& name) {
    const std::filesystem::path folder = ::testing::TempDir() + "osculate_" + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    return (folder / name).string();
}

/// Writes a scene to a temporary file and returns its path.
inline std::string scene_file(const std::string& name, const std::string& text) {
    const std::string path = temporary(name);
    std::ofstream(path) << text;
    return path;
}

} // namespace osculate::support
