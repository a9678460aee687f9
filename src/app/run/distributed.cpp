#include "app/run/distributed.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/core/shared_pages.hpp"
#include "osculate/solve/join_ranks.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <unistd.h>

namespace osculate::app {

namespace fs = std::filesystem;

Distributed::Distributed() : ranks_(solve::join_ranks()) {
    Replicas::arrays_begin_at_pages = true;
    if (first()) return;
    try {
        hide_what_is_said();
    } catch (const std::exception& error) {
        fmt::print(stderr, "process {} of {}: {}\n", ranks_->rank(), ranks_->count(), error.what());
        ranks_->abort(3);
    }
}

void Distributed::hide_what_is_said() {
    const char* asked = std::getenv("TMPDIR");
    std::string name = (fs::path(asked != nullptr && *asked != 0 ? asked : "/tmp") / "osculate-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw RunFailure("no temporary folder can be made as " + name);
    scratch_ = name;
    std::fflush(nullptr);
    told_ = dup(STDERR_FILENO);
    if (std::freopen("/dev/null", "w", stdout) == nullptr ||
        std::freopen((scratch_ / "said").c_str(), "w", stderr) == nullptr)
        throw RunFailure("output cannot be kept in " + name);
}

Distributed::~Distributed() {
    std::error_code none;
    if (!scratch_.empty()) fs::remove_all(scratch_, none);
}

void Distributed::leave(int code, bool surprise) {
    // the first process comes last: it writes a report, or the last iterate
    constexpr double little = 20, much = 300, no_end = 1e9; // s, for others to come to the same end
    const double patience = code == 0 ? no_end : surprise || first() ? little : much;
    const auto heed = [](auto how) {
        for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, how);
    };
    if (code == 0)
        heed(SIG_IGN); // this process is done: a signal must not end the first, which may still write the report
    if (ranks_->agree_on_end(code, patience)) return heed(SIG_IGN);
    heed(SIG_DFL);
    std::fflush(nullptr);
    std::error_code none;
    const std::string said = first() ? std::string() : file_content(scratch_ / "said", none);
    const std::string message = fmt::format("process {} of {} ends alone, with exit code {}, and all with it{}\n",
                                            ranks_->rank(), ranks_->count(), code, said.empty() ? "" : ": " + said);
    (void)!write(first() ? STDERR_FILENO : told_, message.data(), message.size());
    if (!scratch_.empty()) fs::remove_all(scratch_, none);
    ranks_->abort(code == 0 ? 4 : code);
}

} // namespace osculate::app
