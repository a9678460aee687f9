#pragma once
/// The program `osculate`.

namespace osculate::app {

/// Runs one command and never throws. Results go to stdout, faults and progress to stderr.
/// @returns exit code: 0 done, 2 bad scene or command, 3 the run failed, 4 a bug, 5 an import that would lose loads,
///          contact, materials, supports or steps of its deck, 130 or 143 ended by SIGINT or SIGTERM
[[nodiscard]] int command_line(int argc, char** argv);

} // namespace osculate::app
