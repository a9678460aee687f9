/// `osculate view` as a browser meets it: over sockets.

#include "scenes/program.hpp"

#include <arpa/inet.h>
#include <chrono>
#include <csignal>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <regex>
#include <sys/socket.h>
#include <thread>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Reply {
    int status = 0; ///< 0: no connection
    std::string head, body;
};

/// A child that is killed with its owner.
class Child {
public:
    Child(const fs::path& folder, std::vector<std::string> words, const std::string& out) : pid_(fork()) {
        if (pid_ != 0) return;
        words.insert(words.begin(), "osculate");
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        fs::current_path(folder);
        dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        dup2(open((out + ".err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        execv(OSCULATE_PROGRAM, argv.data());
        _exit(127);
    }
    ~Child() {
        if (ended_) return;
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Its exit code, as shells have it.
    int wait() {
        int status = 0;
        waitpid(pid_, &status, 0);
        ended_ = true;
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

private:
    pid_t pid_;
    bool ended_ = false;
};

class View : public Program {
protected:
    /// Waits for what a child says first.
    static std::string first_line(const fs::path& file) {
        for (int i = 0; i < 400; ++i) {
            const std::string text = content(file);
            if (const std::size_t end = text.find('\n'); end != std::string::npos) return text.substr(0, end);
            std::this_thread::sleep_for(std::chrono::milliseconds(25));
        }
        return {};
    }
    int port_of_view() {
        std::smatch found;
        const std::string line = first_line(folder / "view.txt");
        if (!std::regex_search(line, found, std::regex("http://127\\.0\\.0\\.1:(\\d+)/ shows run; end with Ctrl-C")))
            throw std::runtime_error("view says '" + line + "' " + content(folder / "view.txt.err"));
        return std::stoi(found[1]);
    }
    static Reply ask(int port, const std::string& request, const std::string& host = "", const std::string& more = "",
                     const char* address = "127.0.0.1") {
        const int connection = socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(static_cast<std::uint16_t>(port));
        inet_pton(AF_INET, address, &to.sin_addr);
        Reply reply;
        if (connect(connection, reinterpret_cast<sockaddr*>(&to), sizeof to) != 0) {
            close(connection);
            return reply;
        }
        const std::string text = request +
                                 " HTTP/1.1\r\nHost: " + (host.empty() ? "127.0.0.1:" + std::to_string(port) : host) +
                                 "\r\nConnection: close\r\n" + more + "\r\n";
        (void)!write(connection, text.data(), text.size());
        std::string all(1 << 16, '\0'), got;
        for (ssize_t n = 0; (n = read(connection, all.data(), all.size())) > 0;)
            got.append(all.data(), static_cast<std::size_t>(n));
        close(connection);
        const std::size_t end = got.find("\r\n\r\n");
        reply = {std::stoi(got.substr(9, 3)), got.substr(0, end), got.substr(end + 4)};
        return reply;
    }
    static json state(int port) { return json::parse(ask(port, "GET /state").body); }
    static std::string token(const std::string& page) {
        std::smatch found;
        std::regex_search(page, found, std::regex("name=\"osculate-live\" content=\"([0-9a-f]{32})\""));
        return found[1];
    }
};

const std::string press = scene_file("tests/scenes/press.yaml");

TEST_F(View, ShowsARunThatHasEndedAndSaysSo) {
    ASSERT_EQ(osculate({"run", press, "-o", "run", "--quiet"}).code, 0);
    const Child view(folder, {"view", "run"}, "view.txt");
    const int port = port_of_view();
    const Reply page = ask(port, "GET /");
    EXPECT_EQ(page.status, 200);
    EXPECT_THAT(page.head, AllOf(HasSubstr("text/html"), HasSubstr("no-store"), HasSubstr("default-src 'none'")));
    EXPECT_THAT(page.body,
                AllOf(HasSubstr("id=\"report-data\""), HasSubstr("osculate-live"), HasSubstr("\"live\":\"data:text")));
    const json now = state(port);
    EXPECT_EQ(now["status"], "done");
    EXPECT_EQ(now["running"], false);
    EXPECT_EQ(now["can_end"], false);
    EXPECT_THAT(page.body, HasSubstr("data-stamp=\"" + now["stamp"].get<std::string>() + "\""));
    EXPECT_FALSE(fs::exists(folder / "run/report.html")) << "it writes nothing";
    const Reply end = ask(port, "POST /end", "", "Osculate-Token: " + token(page.body) + "\r\nContent-Length: 0\r\n");
    EXPECT_EQ(end.status, 409);
    EXPECT_EQ(ask(port, "GET /state?x=1").status, 200);
    EXPECT_EQ(ask(port, "GET /../../etc/passwd").status, 404);
}

/// The report as a file holds none of it.
TEST_F(View, LeavesReportsAsTheyAre) {
    ASSERT_EQ(osculate({"run", press, "-o", "run", "--quiet"}).code, 0);
    ASSERT_EQ(osculate({"report", "run"}).code, 0);
    EXPECT_THAT(content(folder / "run/report.html"),
                AllOf(Not(HasSubstr("\"osculate-live\"")), Not(HasSubstr("\"live\":\"data:"))));
}

TEST_F(View, FollowsARunAndEndsItBetweenTwoSteps) {
    Child run(folder, {"run", press, "-o", "run", "--threads", "1", "--set", "stages.pull.steps=3000"}, "run.txt");
    for (int i = 0; i < 400 && !fs::exists(folder / "run/history.csv"); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(25));
    const Child view(folder, {"view", "run"}, "view.txt");
    const int port = port_of_view();
    const Reply page = ask(port, "GET /");
    ASSERT_EQ(page.status, 200) << page.body;
    const json before = state(port);
    EXPECT_EQ(before["status"], "running");
    if (content("/proc/locks").find("FLOCK") == std::string::npos)
        GTEST_SKIP() << "this kernel does not say who holds which lock: a run cannot be ended from here";
    EXPECT_EQ(before["can_end"], true);
    json after = before;
    for (int i = 0; i < 200 && after["stamp"] == before["stamp"]; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(25));
        after = state(port);
    }
    EXPECT_NE(after["stamp"], before["stamp"]) << "steps were made meanwhile";
    const auto rows = [](const std::string& text) {
        std::smatch found;
        std::regex_search(text, found, std::regex("\"history\":\\{\"names\":\\[[^\\]]*\\],\"rows\":(\\d+)"));
        return found.empty() ? 0 : std::stoi(found[1]);
    };
    EXPECT_GT(rows(ask(port, "GET /").body), rows(page.body));

    const std::string no_body = "Content-Length: 0\r\n";
    EXPECT_EQ(ask(port, "POST /end", "", no_body).status, 403) << "without the token that only the page has";
    EXPECT_EQ(ask(port, "GET /end").status, 404) << "no link or picture of another page can ask for it";
    EXPECT_EQ(state(port)["running"], true);
    EXPECT_EQ(ask(port, "POST /end", "", no_body + "Osculate-Token: " + token(page.body) + "\r\n").status, 202);
    EXPECT_EQ(run.wait(), 128 + SIGTERM);
    EXPECT_EQ(state(port)["status"], "interrupted");
    EXPECT_EQ(state(port)["running"], false);
    EXPECT_TRUE(fs::exists(folder / "run/checkpoint/state")) << "resume goes on from there";
}

/// A name that leads to 127.0.0.1 would let the page of a stranger read the run: DNS rebinding.
TEST_F(View, AnswersToItsOwnNameAlone) {
    ASSERT_EQ(osculate({"run", press, "-o", "run", "--quiet"}).code, 0);
    const Child view(folder, {"view", "run"}, "view.txt");
    const int port = port_of_view();
    EXPECT_EQ(ask(port, "GET /", "evil.example:" + std::to_string(port)).status, 403);
    EXPECT_EQ(ask(port, "GET /state", "127.0.0.1").status, 403) << "no port";
    EXPECT_EQ(ask(port, "GET /state", "localhost:" + std::to_string(port)).status, 200);
    EXPECT_EQ(ask(port, "GET /state", "", "", "127.0.0.2").status, 0)
        << "the loopback has other addresses: not listened on";
    // what the kernel lists as listening on the port
    std::ifstream sockets("/proc/net/tcp");
    if (!sockets) GTEST_SKIP() << "this kernel does not list sockets";
    char hex[8];
    std::snprintf(hex, sizeof hex, ":%04X", static_cast<unsigned>(port));
    int listening = 0;
    for (std::string line; std::getline(sockets, line);) {
        std::istringstream words(line);
        std::string number, local, remote, kind;
        words >> number >> local >> remote >> kind;
        if (!local.ends_with(hex) || kind != "0A") continue;
        ++listening;
        EXPECT_EQ(local, std::string("0100007F") + hex);
    }
    EXPECT_EQ(listening, 1);
}

TEST_F(View, RefusesWhatIsNoRunAndAPortThatIsTaken) {
    const Outcome nothing = osculate({"view", "nowhere"});
    EXPECT_EQ(nothing.code, 2);
    EXPECT_THAT(nothing.err, HasSubstr("nowhere: expected the folder of a run, found nothing of that name"));
    ASSERT_EQ(osculate({"run", press, "-o", "run", "--quiet"}).code, 0);
    const Child view(folder, {"view", "run"}, "view.txt");
    const Outcome taken = osculate({"view", "run", "--port", std::to_string(port_of_view())});
    EXPECT_EQ(taken.code, 2);
    EXPECT_THAT(taken.err, AllOf(HasSubstr("--port: expected a port"), HasSubstr("Address already in use")));
}

/// A run that was killed has not ended by itself, and there is nothing to end.
TEST_F(View, KnowsARunThatWasKilled) {
    {
        const Child run(folder, {"run", press, "-o", "run", "--set", "stages.pull.steps=3000"}, "run.txt");
        for (int i = 0; i < 400 && !fs::exists(folder / "run/history.csv"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(25));
    }
    const Child view(folder, {"view", "run"}, "view.txt");
    const json now = state(port_of_view());
    EXPECT_EQ(now["status"], "running") << "as it left it";
    EXPECT_EQ(now["running"], false);
    EXPECT_EQ(now["can_end"], false);
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
