#include "output/files.hpp"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <stdexcept>
#include <unistd.h>

namespace osculate::output {

void throw_unwritable(const std::filesystem::path& path, const std::error_code& reason) {
    throw std::runtime_error("cannot write " + path.string() + ": " + reason.message());
}

void make_folder_of(const std::filesystem::path& path) {
    std::error_code error;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
    if (error) throw_unwritable(path, error);
}

void sync(const std::filesystem::path& path) {
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    int reason = 0;
    // some file systems cannot, and say so
    if (file < 0 || (fsync(file) != 0 && errno != EINVAL && errno != EROFS)) reason = errno;
    if (file >= 0) close(file);
    if (reason != 0) throw_unwritable(path, {reason, std::generic_category()});
}

void write_atomic(const std::filesystem::path& path, std::string_view content, bool durable) {
    make_folder_of(path);
    std::filesystem::path part = path;
    part += ".part";
    std::FILE* file = std::fopen(part.c_str(), "wb");
    if (file == nullptr) throw_unwritable(path, {errno, std::generic_category()});
    int reason = 0;
    if (std::fwrite(content.data(), 1, content.size(), file) != content.size()) reason = errno;
    if (durable && reason == 0 && (std::fflush(file) != 0 || fsync(fileno(file)) != 0)) reason = errno;
    if (std::fclose(file) != 0 && reason == 0) reason = errno; // a full disk may show only here
    std::error_code error(reason, std::generic_category());
    if (!error) std::filesystem::rename(part, path, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(part, ignored);
        throw_unwritable(path, error);
    }
    if (durable) sync(path.has_parent_path() ? path.parent_path() : std::filesystem::path("."));
}

} // namespace osculate::output
