#include "app/report/external_program.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace osculate::app {

External run_external(const std::filesystem::path& folder, const std::vector<std::string>& words, bool quiet) {
    constexpr int not_found = 127, not_there = 126; // as shells have it
    std::vector<std::string> kept = words;
    std::vector<char*> argv; // before the fork: a child of a process with threads must not allocate
    for (std::string& word : kept) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) return External::failed;
    if (child == 0) {
        if (chdir(folder.c_str()) != 0) _exit(not_there);
        if (const int nowhere = quiet ? open("/dev/null", O_RDWR) : -1; nowhere >= 0)
            for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
        execvp(argv[0], argv.data());
        _exit(errno == ENOENT ? not_found : not_there);
    }
    int status = 0;
    if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return External::failed;
    if (WEXITSTATUS(status) == not_found) return External::missing;
    return WEXITSTATUS(status) == 0 ? External::done : External::failed;
}

} // namespace osculate::app
