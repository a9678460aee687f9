#include "app/report/gnuplot.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace osculate::app {

std::string gnuplot_text(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
    return result + "'";
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
