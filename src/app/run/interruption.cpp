#include "app/run/interruption.hpp"

#include <unistd.h>

namespace osculate::app {

namespace {

constexpr int watched[] = {SIGINT, SIGTERM};
volatile std::sig_atomic_t noted = 0;

void note(int signal) {
    noted = signal;
    constexpr char words[] = "\nfinishing the step; interrupt again to stop at once\n";
    (void)!write(STDERR_FILENO, words, sizeof words - 1);
}

} // namespace

Interruption::Interruption() {
    noted = 0;
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    sigemptyset(&action.sa_mask);
    for (int i = 0; i < 2; ++i) sigaction(watched[i], &action, &before_[i]);
}

Interruption::~Interruption() {
    for (int i = 0; i < 2; ++i) sigaction(watched[i], &before_[i], nullptr);
}

int Interruption::signal() const {
    return noted;
}

} // namespace osculate::app
