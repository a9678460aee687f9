#include "app/view/view_command.hpp"

#include "app/view/live_run.hpp"

#include <csignal>
#include <cstdio>
#include <fmt/format.h>

namespace osculate::app {

void view(const ViewCommand& command) {
    LiveRun run(command.folder);
    LoopbackServer server(command.port);
    std::signal(SIGPIPE, SIG_IGN); // a browser that goes away is no reason to end
    fmt::print("http://127.0.0.1:{}/ shows {}; end with Ctrl-C\n", server.port(), command.folder);
    std::fflush(stdout);
    server.serve([&](const WebRequest& request) { return run.answer(request); });
}

} // namespace osculate::app
