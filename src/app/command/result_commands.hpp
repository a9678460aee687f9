#pragma once
/// Commands that look at what a run has left: diary, report, view, film.

#include <CLI/App.hpp>
#include <functional>
#include <string>
#include <vector>

namespace osculate::app {

struct Command {
    CLI::App* app;
    std::function<void()> act; ///< once the command line has been read
};

[[nodiscard]] std::vector<Command> add_result_commands(CLI::App& program);

/// To stdout; command_line() looks whether that went well.
void print(const std::string& text);

} // namespace osculate::app
