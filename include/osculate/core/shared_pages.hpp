#pragma once
/// Large arrays that several processes of one machine hold with the same bytes, kept there once.

#include "osculate/core/ranks.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace osculate {

/// Arrays that all processes hold, in one order. They are read and written as before: a page that a process writes is its own again
/// from then on. What was shared stays in memory once more until the array is kept once again, or freed.
class Replicas {
public:
    static constexpr std::size_t page = 4096; ///< bytes, or a part of the system's
    /// Bytes that are not worth a mapping: new pages take time.
    static constexpr std::size_t few = std::size_t{1} << 21U;
    /// Whether the program's vectors (not Eigen's) that are allocated from now on begin at a page if they are large. Memory of others
    /// may go to somebody else with what was shared still in place.
    static inline bool arrays_begin_at_pages = false;

    /// Adds an array; it must live until the next keep_once(). Those that are small, or do not begin at a page, are passed over.
    void add(std::span<const std::byte> array) { arrays_.push_back(array); }
    template <class T> void add(const std::vector<T>& array) { arrays_.push_back(std::as_bytes(std::span(array))); }
    void add(const Field& field) { add(field.values()); }
    /// Lets the processes of each machine share the whole pages of these arrays that have the same bytes; collective, while no other
    /// thread writes. Where the system does not allow it nothing changes.
    void keep_once(Ranks& ranks) const;

private:
    std::vector<std::span<const std::byte>> arrays_;
};

/// Gives back the memory of the whole pages of an array: zeros stand there, which take memory where somebody writes.
void forget(std::span<const double> array);
inline void forget(const Field& field) {
    if (!field.empty()) forget({field.values().front().data(), 3 * field.size()});
}

} // namespace osculate
