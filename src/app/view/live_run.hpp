#pragma once
/// A run that a browser looks at while it goes on.

#include "app/view/loopback_server.hpp"

#include <filesystem>
#include <string>

namespace osculate::app {

class LiveRun {
public:
    /// @throws SceneError where the folder is not that of a run
    explicit LiveRun(std::filesystem::path folder);

    /// GET /: the page; GET /state: what changes; POST /end: ends the run between two steps.
    [[nodiscard]] WebReply answer(const WebRequest& request);

private:
    [[nodiscard]] WebReply page();
    [[nodiscard]] WebReply state() const;
    [[nodiscard]] WebReply end(const std::string& token) const;
    /// Different after every change of the run's files.
    [[nodiscard]] std::string stamp() const;

    std::filesystem::path folder_;
    std::string token_;               ///< that only the page knows
    std::string shown_, shown_stamp_; ///< the page that was made last, and of which files
};

} // namespace osculate::app
