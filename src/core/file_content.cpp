#include "osculate/core/file_content.hpp"

#include "osculate/core/error.hpp"

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <fcntl.h>
#include <fstream>
#include <memory>
#include <thread>
#include <unistd.h>

namespace osculate {

namespace {
struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Opens a named pipe once a program has it open for writing, which may never happen: to open it for reading waits for that
/// without end.
/// @returns  null: none has for too long
std::FILE* open_pipe(const std::filesystem::path& path, std::string& first) {
    constexpr std::chrono::seconds patience(10);
    constexpr std::chrono::milliseconds pause(20);
    const int descriptor = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return nullptr;
    const auto until = std::chrono::steady_clock::now() + patience;
    char byte = 0;
    ssize_t count = 0;
    while ((count = read(descriptor, &byte, 1)) == 0 && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(pause);
    if (count > 0) first = byte;
    if (count == 0 || (count < 0 && errno != EAGAIN)) {
        if (count == 0) errno = ETIMEDOUT;
        close(descriptor);
        return nullptr;
    }
    (void)fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
    return fdopen(descriptor, "rb");
}
} // namespace

std::string file_content(const std::filesystem::path& path, std::error_code& error) {
    constexpr std::size_t most_of_a_stream = std::size_t{1} << 28U;
    error.clear();
    std::string content;
    std::error_code unknown;
    const std::filesystem::file_type type = std::filesystem::status(path, unknown).type();
    const bool endless = type == std::filesystem::file_type::character || type == std::filesystem::file_type::fifo;
    const std::unique_ptr<std::FILE, Close> file(
        type == std::filesystem::file_type::fifo ? open_pipe(path, content) : std::fopen(path.c_str(), "rb"));
    if (!file) {
        error.assign(errno, std::generic_category());
        return content;
    }
    if (const std::uintmax_t size = std::filesystem::file_size(path, unknown); !unknown) content.reserve(size);
    char part[1 << 16];
    while (const std::size_t count = std::fread(part, 1, sizeof part, file.get())) {
        content.append(part, count);
        if (!endless || content.size() <= most_of_a_stream) continue;
        error = std::make_error_code(std::errc::file_too_large);
        return content;
    }
    if (std::ferror(file.get()) != 0) error.assign(errno, std::generic_category());
    return content;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw RunFailure("cannot write " + path.string());
}

std::string file_content(const std::filesystem::path& path) {
    std::error_code ignored;
    return file_content(path, ignored);
}

} // namespace osculate
