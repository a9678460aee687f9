#include "app/report/gnuplot.hpp"

#include "osculate/core/printable.hpp"

#include <cerrno>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace osculate::app {

/// Between double quotes, with octal codes for all that means anything to any of gnuplot's readers, which look at lines one
/// after another: quotes, escapes, commands of the shell in backticks, macros, comments, braces of blocks. Single quotes would not
/// do: gnuplot ends such a string at a doubled quote that it begins with.
std::string gnuplot_text(std::string_view text) {
    constexpr std::string_view meaningful = "\"'\\`@#{}";
    std::string result = "\"";
    bool after_code = false;
    for (const char c : text) {
        // gnuplot takes a fourth digit for part of a code that begins with 0
        const bool code = meaningful.find(c) != std::string_view::npos || (after_code && c >= '0' && c <= '9');
        result += is_control(c) ? std::string(" ")
                  : code        ? fmt::format("\\{:03o}", static_cast<unsigned char>(c))
                                : std::string(1, c);
        after_code = code;
    }
    return result + "\"";
}

Gnuplot run_gnuplot(const std::filesystem::path& folder, const std::string& script, bool quiet) {
    constexpr int not_found = 127, not_there = 126; // as shells have it
    const pid_t child = fork();
    if (child < 0) return Gnuplot::failed;
    if (child == 0) {
        if (chdir(folder.c_str()) != 0) _exit(not_there);
        if (const int nowhere = quiet ? open("/dev/null", O_WRONLY) : -1; nowhere >= 0) dup2(nowhere, STDERR_FILENO);
        execlp("gnuplot", "gnuplot", script.c_str(), static_cast<char*>(nullptr));
        _exit(errno == ENOENT ? not_found : not_there);
    }
    int status = 0;
    if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return Gnuplot::failed;
    if (WEXITSTATUS(status) == not_found) return Gnuplot::missing;
    return WEXITSTATUS(status) == 0 ? Gnuplot::drawn : Gnuplot::failed;
}

} // namespace osculate::app
