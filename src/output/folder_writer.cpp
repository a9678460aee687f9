#include "osculate/output/folder_writer.hpp"

#include "osculate/core/error.hpp"
#include "osculate/output/output_folder.hpp"
#include "output/manifest.hpp"

#include <fstream>
#include <sstream>
#include <string>
#include <sys/stat.h>

namespace osculate::output {

std::optional<long> writer_of(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / OutputFolder::manifest;
    std::optional<Manifest> manifest;
    try {
        manifest = read_manifest(path);
    } catch (const SceneError&) { // leads out of its folder: not one that a run writes
        return std::nullopt;
    }
    struct stat file {};
    if (!manifest || stat(path.c_str(), &file) != 0) return std::nullopt;
    // "3: FLOCK  ADVISORY  WRITE 1234 08:01:5678 0 EOF"
    std::ifstream locks("/proc/locks");
    for (std::string line; std::getline(locks, line);) {
        std::istringstream words(line);
        std::string number, kind, advisory, access, device;
        long process = 0;
        words >> number >> kind >> advisory >> access >> process >> device;
        if (!words || kind != "FLOCK" || process != manifest->process) continue;
        if (device.substr(device.rfind(':') + 1) == std::to_string(file.st_ino)) return process;
    }
    return std::nullopt;
}

} // namespace osculate::output
