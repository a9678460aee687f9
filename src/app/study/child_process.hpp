#pragma once
/// Processes of this very program.

#include <filesystem>
#include <functional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace osculate::app {

/// Starts this program with other arguments; what it says goes to a file. It is killed when this process ends.
/// @throws std::runtime_error
[[nodiscard]] pid_t start_program(const std::vector<std::string>& arguments, const std::filesystem::path& messages);

/// Runs a function in a copy of this process, whose exit code it returns. The copy is killed when this process ends.
[[nodiscard]] pid_t start_copy(const std::function<int()>& body);

/// Holds back SIGINT, SIGTERM and SIGCHLD while it lives, so that wait() sees them.
class SignalWatch {
public:
    SignalWatch();
    ~SignalWatch();
    SignalWatch(const SignalWatch&) = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;

    /// Waits a while, or until a child ends or this process is asked to; the signal that asks, or 0.
    [[nodiscard]] int wait() const;
    /// Ends this process the way the signal does.
    [[noreturn]] void end_by(int signal) const;
};

} // namespace osculate::app
