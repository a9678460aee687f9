#pragma once
/// Operations that make a NaN or an infinity end the program where they happen.

#include <cfenv>

namespace osculate::support {

/// Traps invalid operations, divisions by zero and overflows of this thread, and of the threads it starts, while it lives.
/// @param on  false suspends the traps instead: around what is known to raise them, with the reason
class FloatingPointTraps {
public:
    explicit FloatingPointTraps(bool on = true) {
        std::fegetenv(&before_);
        std::feclearexcept(FE_ALL_EXCEPT);
        if (on)
            feenableexcept(trapped);
        else
            fedisableexcept(trapped);
    }
    ~FloatingPointTraps() { std::fesetenv(&before_); }
    FloatingPointTraps(const FloatingPointTraps&) = delete;
    FloatingPointTraps& operator=(const FloatingPointTraps&) = delete;

    static constexpr int trapped = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

private:
    std::fenv_t before_{};
};

} // namespace osculate::support
