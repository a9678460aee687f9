#include "osculate/app/command_line.hpp"
#include "osculate/core/shared_pages.hpp"

#include <cstdlib>
#include <new>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {
void* allocated(std::size_t bytes) {
    using osculate::Replicas;
    if (!Replicas::arrays_begin_at_pages || bytes < Replicas::few) return std::malloc(bytes == 0 ? 1 : bytes);
    return std::aligned_alloc(Replicas::page, (bytes + Replicas::page - 1) / Replicas::page * Replicas::page);
}
} // namespace

void* operator new(std::size_t bytes) {
    for (;;) {
        if (void* const found = allocated(bytes)) return found;
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) throw std::bad_alloc();
        handler();
    }
}

void operator delete(void* array) noexcept {
    std::free(array);
}

void operator delete(void* array, std::size_t) noexcept {
    std::free(array);
}

int main(int argc, char** argv) {
#ifdef __GLIBC__
    // a solve asks for the same few megabytes again and again: given back each time, they cost half of a run in page faults
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
    return osculate::app::command_line(argc, argv);
}
