#include "output/files.hpp"

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
