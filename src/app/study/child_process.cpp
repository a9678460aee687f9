#include "app/study/child_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <unistd.h>

namespace osculate::app {

namespace {

sigset_t watched_signals() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&set, signal);
    return set;
}

/// In the child: no signal is held back, and the parent's end is its own.
void begin_child(pid_t parent) {
    const sigset_t set = watched_signals();
    sigprocmask(SIG_UNBLOCK, &set, nullptr);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1); // it ended before it could be watched
}

} // namespace

pid_t start_program(const std::vector<std::string>& arguments, const std::filesystem::path& messages) {
    std::vector<std::string> words{"osculate"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t parent = getpid(), child = fork();
    if (child < 0) throw std::runtime_error("cannot start a process");
    if (child == 0) {
        begin_child(parent);
        const int file = open(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
        if (file >= 0) {
            dup2(file, STDOUT_FILENO);
            dup2(file, STDERR_FILENO);
            close(file);
        }
        execv("/proc/self/exe", argv.data());
        _exit(127);
    }
    return child;
}

pid_t start_copy(const std::function<int()>& body) {
    std::fflush(nullptr);
    const pid_t parent = getpid(), child = fork();
    if (child < 0) throw std::runtime_error("cannot start a process");
    if (child == 0) {
        begin_child(parent);
        _exit(body());
    }
    return child;
}

SignalWatch::SignalWatch() {
    const sigset_t set = watched_signals();
    sigprocmask(SIG_BLOCK, &set, nullptr);
}

SignalWatch::~SignalWatch() {
    const sigset_t set = watched_signals();
    sigprocmask(SIG_UNBLOCK, &set, nullptr);
}

int SignalWatch::wait() const {
    const sigset_t set = watched_signals();
    const timespec a_while{1, 0};
    const int signal = sigtimedwait(&set, nullptr, &a_while);
    return signal == SIGINT || signal == SIGTERM ? signal : 0;
}

void SignalWatch::end_by(int signal) const {
    std::signal(signal, SIG_DFL);
    const sigset_t set = watched_signals();
    sigprocmask(SIG_UNBLOCK, &set, nullptr);
    raise(signal);
    std::exit(128 + signal);
}

} // namespace osculate::app
