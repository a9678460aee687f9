#pragma once
/// Wall time of each part of a run, for summary.json.

#include <array>
#include <chrono>
#include <cstddef>

namespace osculate {

enum class Part : std::size_t { search, patches, contact, assembly, factor, solve, output, audit, count };

/// Seconds accumulated per part. One object per run, owned by the plan; not shared between threads.
class Timings {
public:
    void add(Part part, double seconds) { seconds_[static_cast<std::size_t>(part)] += seconds; }
    [[nodiscard]] double operator[](Part part) const { return seconds_[static_cast<std::size_t>(part)]; }

private:
    std::array<double, static_cast<std::size_t>(Part::count)> seconds_{};
};

/// Adds its own lifetime to the time of one part.
class ScopedTimer {
public:
    ScopedTimer(Timings& timings, Part part) : timings_(timings), part_(part), start_(clock::now()) {}
    ~ScopedTimer() { timings_.add(part_, std::chrono::duration<double>(clock::now() - start_).count()); }
    ScopedTimer(const ScopedTimer&) = delete;
    ScopedTimer& operator=(const ScopedTimer&) = delete;

private:
    using clock = std::chrono::steady_clock;
    Timings& timings_;
    Part part_;
    clock::time_point start_;
};

} // namespace osculate
