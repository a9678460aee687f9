/// Large arrays of the program where several processes share a run: each begins at a page and is given back to the system when it is
/// freed. Only so can processes keep equal ones once, see Replicas: at the same places in pages, and without a trace afterwards. New
/// pages cost some two hundredths of a run's time.
#include "osculate/core/shared_pages.hpp"

#include <cstdint>
#include <cstdlib>
#include <map>
#include <mutex>
#include <new>
#include <sys/mman.h>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define OSCULATE_SANITIZED
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define OSCULATE_SANITIZED
#endif

#ifndef OSCULATE_SANITIZED // sanitizers have their own operators

namespace {

using osculate::Replicas;

class LargeArrays {
public:
    /// Null where the system has no room.
    void* allocate(std::size_t bytes) {
        void* const first = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (first == MAP_FAILED) return nullptr;
        const std::lock_guard lock(mutex_);
        bytes_.emplace(first, bytes);
        return first;
    }
    /// Whether it was one of them.
    bool free(void* array) {
        std::map<void*, std::size_t>::node_type found; // freed without the lock, as it may come here, too
        {
            const std::lock_guard lock(mutex_);
            found = bytes_.extract(array);
        }
        if (found.empty()) return false;
        munmap(array, found.mapped());
        return true;
    }

private:
    std::mutex mutex_;
    std::map<void*, std::size_t> bytes_; ///< its own nodes are small
};

LargeArrays& large_arrays() {
    static LargeArrays& all = *new LargeArrays; // others are freed after any static object
    return all;
}

void* allocated(std::size_t bytes) {
    const bool large = bytes >= Replicas::few && Replicas::arrays_begin_at_pages;
    return large ? large_arrays().allocate(bytes) : std::malloc(bytes == 0 ? 1 : bytes);
}

void release(void* array) {
    const bool at_page = reinterpret_cast<std::uintptr_t>(array) % Replicas::page == 0;
    if (Replicas::arrays_begin_at_pages && at_page && array != nullptr && large_arrays().free(array)) return;
    std::free(array);
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
    release(array);
}

void operator delete(void* array, std::size_t) noexcept {
    release(array);
}

#endif
