#pragma once
/// Large arrays that several processes of one machine hold with the same bytes, kept there once.

#include "osculate/core/ranks.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace osculate {

/// Arrays that all processes hold, in one order. What is theirs is read and written as before: a page that a process writes is its
/// own again from then on, and until all have done so the others share what it was.
class Replicas {
public:
    static constexpr std::size_t page = 4096;                 ///< bytes, or a part of the system's
    static constexpr std::size_t few = std::size_t{1} << 18U; ///< bytes that are not worth a mapping
    /// Whether arrays that are allocated from now on begin at a page if they are large: on all processes at the same place in one.
    static inline bool arrays_begin_at_pages = false;

    /// Adds an array; it must live until the next keep_once(). Small ones, and those of one process alone, are passed over.
    void add(std::span<const std::byte> array) { arrays_.push_back(array); }
    template <class T> void add(const std::vector<T>& array) { arrays_.push_back(std::as_bytes(std::span(array))); }
    void add(const Field& field) { add(field.values()); }
    void add(const Vector& vector) {
        arrays_.push_back(std::as_bytes(std::span(vector.data(), static_cast<std::size_t>(vector.size()))));
    }
    /// Lets the processes of each machine share the whole pages of these arrays that have the same bytes at the same places in
    /// pages; collective, while no other thread writes. Where the system does not allow it nothing changes.
    void keep_once(Ranks& ranks) const;

private:
    std::vector<std::span<const std::byte>> arrays_;
};

/// Gives back the memory of the whole pages of an array: zeros stand there, which take memory where somebody writes.
void forget(std::span<double> array);

} // namespace osculate
