#include "osculate/core/shared_pages.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace osculate {

namespace {

constexpr std::size_t most_words = 128; // of 8 bytes, which name a machine

class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() {
        if (number_ >= 0) close(number_);
    }
    [[nodiscard]] int number() const { return number_; }

private:
    int number_;
};

/// The whole pages inside an array.
std::span<const std::byte> whole_pages(std::span<const std::byte> array) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(array.data()) % page) % page;
    if (array.size() < Replicas::few + before) return {};
    return array.subspan(before, (array.size() - before) / page * page);
}

/// What processes have in common that see each other's files in /proc and may open them.
std::string machine() {
    std::string name;
    char text[128];
    const auto take = [&](ssize_t length) { name.append(text, length > 0 ? static_cast<std::size_t>(length) : 0); };
    const Descriptor boot(open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC));
    take(read(boot.number(), text, sizeof text));
    for (const char* space : {"/proc/self/ns/pid", "/proc/self/ns/user"}) take(readlink(space, text, sizeof text));
    return name + std::to_string(geteuid());
}

/// The lowest of the ranks on this machine; -1: this one is alone there.
int first_here(Ranks& ranks) {
    const std::string name = machine();
    std::vector<double> own;
    for (const char letter : name.substr(0, most_words)) own.push_back(letter);
    own.resize(most_words, 0);
    const auto count = static_cast<std::size_t>(ranks.count());
    std::vector<double> all(count * most_words);
    ranks.gather(own, std::vector<int>(count, most_words), all.data());
    int first = -1, here = 0;
    for (std::size_t r = 0; r < count; ++r) {
        if (!std::equal(own.begin(), own.end(), all.begin() + static_cast<std::ptrdiff_t>(r * most_words))) continue;
        if (here++ == 0) first = static_cast<int>(r);
    }
    return here > 1 ? first : -1;
}

/// A file without a name that holds these bytes; none where the system has no room for it.
Descriptor file_of(std::span<const std::byte> bytes) {
    rlimit largest{}; // a larger file would end the process
    if (getrlimit(RLIMIT_FSIZE, &largest) != 0 || largest.rlim_cur < bytes.size()) return Descriptor();
    Descriptor file(memfd_create("osculate", MFD_CLOEXEC));
    for (std::size_t done = 0; file.number() >= 0 && done < bytes.size();) {
        const ssize_t now = write(file.number(), bytes.data() + done, bytes.size() - done);
        if (now <= 0) return Descriptor();
        done += static_cast<std::size_t>(now);
    }
    return file;
}

/// Puts other pages in the place of those of an array: of a file from a place on, or empty ones.
void replace(std::span<const std::byte> bytes, int file, std::size_t from) {
    void* const first = const_cast<std::byte*>(bytes.data());
    const int kind = MAP_PRIVATE | MAP_FIXED | (file < 0 ? MAP_ANONYMOUS : 0);
    const int access = PROT_READ | PROT_WRITE;
    if (mmap(first, bytes.size(), access, kind, file, static_cast<off_t>(from)) != MAP_FAILED) return;
    std::vector<unsigned char> there(bytes.size() / Replicas::page);
    if (mincore(first, bytes.size(), there.data()) != 0) std::abort(); // the old ones are gone
    if (file < 0) std::memset(first, 0, bytes.size());
}

/// Puts the pages of a file in the place of those of an array where both have the same bytes.
void take_pages(int file, std::span<const std::byte> bytes) {
    struct stat status {};
    if (fstat(file, &status) != 0 || static_cast<std::size_t>(status.st_size) != bytes.size()) return;
    void* const mapped = mmap(nullptr, bytes.size(), PROT_READ, MAP_SHARED, file, 0);
    if (mapped == MAP_FAILED) return;
    const auto* const theirs = static_cast<const std::byte*>(mapped);
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const auto same = [&](std::size_t at) { return std::memcmp(theirs + at, bytes.data() + at, page) == 0; };
    for (std::size_t begin = 0, end = 0; begin < bytes.size(); begin = end) {
        const bool equal = same(begin);
        for (end = begin + page; end < bytes.size() && same(end) == equal;) end += page;
        if (!equal || end - begin < Replicas::few / 2) continue;
        // in place: who looks at the array finds the same bytes at the same address all the time
        replace(bytes.subspan(begin, end - begin), file, begin);
    }
    munmap(mapped, bytes.size());
}

} // namespace

void forget(std::span<const double> array) {
    const std::span<const std::byte> pages = whole_pages(std::as_bytes(array));
    if (!pages.empty()) replace(pages, -1, 0);
}

void Replicas::keep_once(Ranks& ranks) const {
    const int first = first_here(ranks);
    const auto count = static_cast<std::size_t>(ranks.count());
    constexpr int described = 3; // process, file and bytes
    std::vector<double> all(count * described);
    Descriptor last; // until all have opened it
    for (const std::span<const std::byte> array : arrays_) {
        const std::span<const std::byte> pages = whole_pages(array);
        const std::span<const std::byte> bytes = pages.data() == array.data() ? pages : pages.first(0);
        const double own_bytes = static_cast<double>(bytes.size());
        Descriptor file;
        if (ranks.rank() == first && !bytes.empty()) file = file_of(bytes);
        const double own[described] = {static_cast<double>(getpid()), static_cast<double>(file.number()), own_bytes};
        ranks.gather(own, std::vector<int>(count, described), all.data());
        last = Descriptor();
        if (first < 0) continue;
        const double* const theirs = all.data() + static_cast<std::ptrdiff_t>(first) * described;
        if (theirs[1] < 0 || theirs[2] != own_bytes) continue;
        if (ranks.rank() != first) {
            const std::string path = "/proc/" + std::to_string(static_cast<long>(theirs[0])) + "/fd/" +
                                     std::to_string(static_cast<int>(theirs[1]));
            file = Descriptor(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
        }
        if (file.number() >= 0) take_pages(file.number(), bytes);
        last = std::move(file);
    }
    (void)ranks.largest(0); // all have opened the last one
}

} // namespace osculate
