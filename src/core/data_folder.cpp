#include "osculate/core/data_folder.hpp"

#include <climits>
#include <cstdlib>
#include <dlfcn.h>
#include <link.h>
#include <system_error>

namespace osculate {

namespace fs = std::filesystem;

namespace {

/// Folder of the program or shared library that holds this function; empty where the system does not say.
fs::path own_folder() {
    Dl_info info{};
    link_map* map = nullptr;
    std::error_code none;
    const int found =
        dladdr1(reinterpret_cast<void*>(&own_folder), &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP);
    if (found == 0 || map == nullptr || map->l_name == nullptr || *map->l_name == 0) // the program itself has no name
        return fs::read_symlink("/proc/self/exe", none).parent_path();
    char origin[PATH_MAX]; // noted when it was loaded: the current folder may be another one by now
    return dlinfo(map, RTLD_DI_ORIGIN, origin) == 0 ? fs::path(origin) : fs::path();
}

} // namespace

fs::path data_folder(const std::string& name) {
    std::error_code none;
    const auto exists = [&](const fs::path& folder) { return fs::is_directory(folder, none); };
    if (const char* given = std::getenv("OSCULATE_DATA"); given != nullptr && *given != 0)
        if (fs::path folder = fs::path(given) / name; exists(folder)) return folder;
    if (const fs::path own = own_folder(); !own.empty())
        for (const char* from : {OSCULATE_DATA_FROM_PROGRAM, OSCULATE_DATA_FROM_LIBRARY, OSCULATE_DATA_FROM_PYTHON})
            if (fs::path folder = (own / from / name).lexically_normal(); exists(folder)) return folder;
    if (fs::path folder = fs::path(OSCULATE_SOURCE_TREE) / name; exists(folder)) return folder;
    return fs::path(OSCULATE_INSTALLED_DATA) / name;
}

} // namespace osculate
