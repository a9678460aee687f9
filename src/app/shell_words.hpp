#pragma once
/// Words for a shell to read.

#include <string>
#include <vector>

namespace osculate::app {

/// A word as bash reads it; control characters do not break the line.
[[nodiscard]] std::string shell_word(const std::string& word);
[[nodiscard]] std::string shell_line(const std::vector<std::string>& words);
/// A name for SLURM, whose comments know neither quotes nor line breaks.
[[nodiscard]] std::string job_name(std::string name);
/// Path of the running program.
[[nodiscard]] std::string this_program();

} // namespace osculate::app
