#pragma once
/// Signals that ask a run to end.

#include <csignal>

namespace osculate::app {

/// While it lives, a first SIGINT or SIGTERM is noted and nothing else; the second ends the program as it would without.
class Interruption {
public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    /// The signal noted, 0: none.
    [[nodiscard]] int signal() const;

private:
    struct sigaction before_[2]{};
};

} // namespace osculate::app
