#include "app/report/external_program.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace osculate::app {

namespace {
/// Variables of this process, with the locale in which texts are UTF-8 and numbers have points.
std::vector<std::string> environment() {
    std::vector<std::string> variables;
    for (char** one = environ; *one != nullptr; ++one)
        if (std::string variable = *one; !variable.starts_with("LC_ALL=")) variables.push_back(std::move(variable));
    variables.emplace_back("LC_ALL=C.UTF-8");
    return variables;
}
} // namespace

External run_external(const std::filesystem::path& folder, const std::vector<std::string>& words, bool quiet) {
    constexpr int not_found = 127, not_there = 126; // as shells have it
    std::vector<std::string> kept = words;
    std::vector<char*> argv; // before the fork: a child of a process with threads must not allocate
    for (std::string& word : kept) argv.push_back(word.data());
    argv.push_back(nullptr);
    std::vector<std::string> variables = environment();
    std::vector<char*> envp;
    for (std::string& variable : variables) envp.push_back(variable.data());
    envp.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) return External::failed;
    if (child == 0) {
        if (chdir(folder.c_str()) != 0) _exit(not_there);
        if (const int nowhere = quiet ? open("/dev/null", O_RDWR) : -1; nowhere >= 0)
            for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
        execvpe(argv[0], argv.data(), envp.data());
        _exit(errno == ENOENT ? not_found : not_there);
    }
    int status = 0;
    if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return External::failed;
    if (WEXITSTATUS(status) == not_found) return External::missing;
    return WEXITSTATUS(status) == 0 ? External::done : External::failed;
}

} // namespace osculate::app
