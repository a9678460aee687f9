#pragma once
/// Scenes written by a test.

#include <fstream>
#include <gtest/gtest.h>
#include <string>

namespace osculate::support {

/// Writes a scene to a temporary file and returns its path. Tests run side by side: names are their own.
inline std::string scene_file(const std::string& name, const std::string& text) {
    const std::string path = testing::TempDir() + name;
    std::ofstream(path) << text;
    return path;
}

} // namespace osculate::support
