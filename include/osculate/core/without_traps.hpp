#pragma once
/// Code sections that may divide by zero.

#include <cfenv>

namespace osculate {

/// Suspends floating-point traps, if any are set, during its lifetime. Meant for libraries and user formulas that raise
/// floating-point exceptions on the way to results that are checked afterwards. Threads that they start have no traps
/// either.
class WithoutTraps {
public:
    WithoutTraps() { std::feholdexcept(&before_); }
    ~WithoutTraps() { std::fesetenv(&before_); }
    WithoutTraps(const WithoutTraps&) = delete;
    WithoutTraps& operator=(const WithoutTraps&) = delete;

private:
    std::fenv_t before_{};
};

} // namespace osculate
