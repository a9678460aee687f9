#pragma once
/// Words of a command line that are no commands or options.

#include <CLI/CLI.hpp>
#include <string>

namespace osculate::app {

/// What is wrong with them, and what was probably meant, a line each; empty where the fault is another.
/// @param program  after it has failed to parse the words
[[nodiscard]] std::string mistyped(const CLI::App& program);

} // namespace osculate::app
