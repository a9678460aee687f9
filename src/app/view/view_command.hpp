#pragma once
/// `osculate view`: the report of a run in a browser, while the run goes on.

#include <string>

namespace osculate::app {

struct ViewCommand {
    std::string folder;
    int port = 0; ///< 0: any that is free
};

/// Serves until the process is ended. @throws SceneError for a folder that is not that of a run, or a port that is taken
[[noreturn]] void view(const ViewCommand& command);

} // namespace osculate::app
