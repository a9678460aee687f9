#pragma once
/// Stretches of code that may divide by zero.

#include <cfenv>

namespace osculate {

/// Suspends floating-point traps, where any are set, while it lives: for libraries and for formulas of users that raise
/// exceptions on their way to values that are looked at afterwards. Threads they start have none either.
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
