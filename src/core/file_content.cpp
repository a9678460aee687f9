#include "osculate/core/file_content.hpp"

#include "osculate/core/error.hpp"

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <memory>

namespace osculate {

namespace {
struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
} // namespace

std::string file_content(const std::filesystem::path& path, std::error_code& error) {
    error.clear();
    std::string content;
    const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
    if (!file) {
        error.assign(errno, std::generic_category());
        return content;
    }
    std::error_code unknown; // a pipe has no size
    if (const std::uintmax_t size = std::filesystem::file_size(path, unknown); !unknown) content.reserve(size);
    char part[1 << 16];
    while (const std::size_t count = std::fread(part, 1, sizeof part, file.get())) content.append(part, count);
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
