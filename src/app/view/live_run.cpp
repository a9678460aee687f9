#include "app/view/live_run.hpp"

#include "app/report/run_page.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/output/folder_writer.hpp"
#include "osculate/output/post_mortem_file.hpp"

#include <cerrno>
#include <csignal>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <random>
#include <sys/stat.h>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

std::string random_token() {
    std::random_device any;
    std::string token;
    for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", any());
    return token;
}

/// The process that writes, if it is `osculate run` or `resume`, which a signal ends between two steps. A Python program it
/// would kill.
std::optional<long> run_that_ends(const fs::path& folder) {
    const auto process = output::writer_of(folder);
    if (!process) return std::nullopt;
    std::error_code failed;
    const fs::path program = fs::read_symlink(fmt::format("/proc/{}/exe", *process), failed);
    return !failed && program.filename().string().starts_with("osculate") ? process : std::nullopt;
}

std::string status_in(const fs::path& folder) {
    const nlohmann::json summary =
        nlohmann::json::parse(file_content(folder / "summary.json"), nullptr, false); // discarded while there is none
    return summary.is_object() ? summary.value("status", "running") : "running";
}

} // namespace

LiveRun::LiveRun(fs::path folder) : folder_(std::move(folder)), token_(random_token()) {
    check_run_folder(folder_);
}

std::string LiveRun::stamp() const {
    std::string text;
    for (const char* name : {"summary.json", "history.csv", "steps.csv", "series.pvd", output::post_mortem_file}) {
        struct stat file {};
        if (stat((folder_ / name).c_str(), &file) != 0) continue;
        text += fmt::format("{}{}-{}-{}.{}", text.empty() ? "" : "/", name[0], file.st_size, file.st_mtim.tv_sec,
                            file.st_mtim.tv_nsec);
    }
    return text;
}

WebReply LiveRun::page() {
    const std::string now = stamp(); // before anything is read: what changes meanwhile is shown the next time
    if (shown_.empty() || now != shown_stamp_) {
        try {
            shown_ = live_page(folder_, {token_, now}).html;
            shown_stamp_ = now;
        } catch (const std::runtime_error& error) { // SceneError, of a folder that is gone, among them
            return {503, "text/plain; charset=utf-8", fmt::format("the page cannot be made: {}\n", error.what())};
        }
    }
    return {200, "text/html; charset=utf-8", shown_};
}

WebReply LiveRun::state() const {
    const bool running = output::writer_of(folder_).has_value();
    const nlohmann::json state{{"stamp", stamp()},
                               {"status", status_in(folder_)},
                               {"running", running},
                               {"can_end", running && run_that_ends(folder_).has_value()}};
    return {200, "application/json", state.dump()};
}

WebReply LiveRun::end(const std::string& token) const {
    if (token != token_) return {403, "text/plain; charset=utf-8", "only the page itself ends a run\n"};
    const auto process = run_that_ends(folder_);
    if (!process) return {409, "text/plain; charset=utf-8", "no run that could be ended writes into this folder\n"};
    if (kill(static_cast<pid_t>(*process), SIGTERM) != 0)
        return {409, "text/plain; charset=utf-8",
                fmt::format("process {}: {}\n", *process, std::generic_category().message(errno))};
    return {202, "text/plain; charset=utf-8", "the run ends after its step\n"};
}

WebReply LiveRun::answer(const WebRequest& request) {
    const bool get = request.method == "GET";
    if (get && request.path == "/") return page();
    if (get && request.path == "/state") return state();
    if (request.method == "POST" && request.path == "/end") return end(request.token);
    return {404, "text/plain; charset=utf-8", "there is /, /state and, to post to, /end\n"};
}

} // namespace osculate::app
