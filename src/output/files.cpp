#include "output/files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <stdexcept>

namespace osculate::output {

void throw_unwritable(const std::filesystem::path& path, const std::error_code& reason) {
    throw std::runtime_error("cannot write " + path.string() + ": " + reason.message());
}

void make_folder_of(const std::filesystem::path& path) {
    std::error_code error;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
    if (error) throw_unwritable(path, error);
}

void remove_files(const std::filesystem::path& folder, const std::vector<std::string>& extensions) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error)) return;
    std::vector<std::filesystem::path> old;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (std::ranges::count(extensions, entry.path().extension().string()) > 0) old.push_back(entry.path());
    for (const std::filesystem::path& path : old) {
        std::filesystem::remove(path, error);
        if (error) throw_unwritable(path, error);
    }
    if (std::filesystem::is_empty(folder, error)) std::filesystem::remove(folder, error);
}

void write_atomic(const std::filesystem::path& path, std::string_view content) {
    make_folder_of(path);
    std::filesystem::path part = path;
    part += ".part";
    std::FILE* file = std::fopen(part.c_str(), "wb");
    if (file == nullptr) throw_unwritable(path, {errno, std::generic_category()});
    int reason = 0;
    if (std::fwrite(content.data(), 1, content.size(), file) != content.size()) reason = errno;
    if (std::fclose(file) != 0 && reason == 0) reason = errno; // a full disk may show only here
    std::error_code error(reason, std::generic_category());
    if (!error) std::filesystem::rename(part, path, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw_unwritable(path, error);
    }
}

} // namespace osculate::output
