#pragma once
/// A small HTTP server that only this machine reaches.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace osculate::app {

struct WebRequest {
    std::string method, path; ///< path without what follows '?'
    std::string token;        ///< of the header Osculate-Token, which no page of another origin can set
};

struct WebReply {
    int status = 200;
    std::string type = "text/plain; charset=utf-8", body{};
};

/// Listens on 127.0.0.1 alone. Refuses requests whose Host is another name, behind which the page of a stranger could hide
/// (DNS rebinding).
class LoopbackServer {
public:
    /// @param port  0: any that is free
    /// @throws SceneError where the port is taken
    explicit LoopbackServer(int port);
    ~LoopbackServer();
    LoopbackServer(const LoopbackServer&) = delete;
    LoopbackServer& operator=(const LoopbackServer&) = delete;

    [[nodiscard]] int port() const;
    /// Answers until the process ends. Connections have threads of their own; `answer` is called by one at a time.
    [[noreturn]] void serve(const std::function<WebReply(const WebRequest&)>& answer);

private:
    struct Sockets;
    std::unique_ptr<Sockets> sockets_;
};

} // namespace osculate::app
