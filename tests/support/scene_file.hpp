#pragma once
/// Files written by a test.

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <unistd.h>

namespace osculate::support {

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
