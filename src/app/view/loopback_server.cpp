#include "app/view/loopback_server.hpp"

#include "osculate/core/error.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <fmt/format.h>
#include <mutex>
#include <sys/socket.h>
#include <sys/time.h>
#include <thread>

namespace osculate::app {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using Request = http::request<http::string_body>;
using Reply = http::response<http::string_body>;

struct LoopbackServer::Sockets {
    asio::io_context context;
    tcp::acceptor acceptor{context};
};

namespace {

/// Scripts and styles of the page itself; data of this server; nothing from elsewhere.
constexpr const char* policy = "default-src 'none'; script-src 'unsafe-inline' data:; style-src 'unsafe-inline'; "
                               "img-src data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'";

bool own_host(const Request& request, int port) {
    const auto host = std::string(request[http::field::host]);
    return host == fmt::format("127.0.0.1:{}", port) || host == fmt::format("localhost:{}", port);
}

Reply reply_to(const Request& request, const WebReply& answer) {
    Reply reply{static_cast<http::status>(answer.status), request.version()};
    reply.set(http::field::content_type, answer.type);
    reply.set(http::field::cache_control, "no-store");
    reply.set("Content-Security-Policy", policy);
    reply.set("X-Content-Type-Options", "nosniff");
    reply.set("Cross-Origin-Resource-Policy", "same-origin");
    reply.keep_alive(request.keep_alive());
    reply.body() = answer.body;
    reply.prepare_payload();
    return reply;
}

/// A browser opens connections that it never uses: none may wait for ever.
void limit_waiting(tcp::socket& socket) {
    const timeval patience{30, 0};
    for (const int option : {SO_RCVTIMEO, SO_SNDTIMEO})
        setsockopt(socket.native_handle(), SOL_SOCKET, option, &patience, sizeof patience);
}

void converse(tcp::socket socket, int port, std::mutex& one_at_a_time,
              const std::function<WebReply(const WebRequest&)>& answer) {
    limit_waiting(socket);
    boost::beast::flat_buffer buffer;
    boost::system::error_code failed;
    for (bool more = true; more && !failed;) {
        http::request_parser<http::string_body> parser;
        constexpr std::uint64_t longest = 4096; // no request has a body
        parser.body_limit(longest);
        http::read(socket, buffer, parser, failed);
        if (failed) break;
        const Request request = parser.release();
        WebReply said{403, "text/plain; charset=utf-8", "this server answers to 127.0.0.1 alone\n"};
        if (own_host(request, port)) {
            const std::string target(request.target());
            const std::lock_guard lock(one_at_a_time);
            said = answer({std::string(request.method_string()), target.substr(0, target.find('?')),
                           std::string(request["Osculate-Token"])});
        }
        const Reply reply = reply_to(request, said);
        more = reply.keep_alive();
        http::write(socket, reply, failed);
    }
    socket.shutdown(tcp::socket::shutdown_both, failed);
}

} // namespace

LoopbackServer::LoopbackServer(int port) : sockets_(std::make_unique<Sockets>()) {
    const tcp::endpoint here(asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port));
    boost::system::error_code failed;
    tcp::acceptor& acceptor = sockets_->acceptor;
    acceptor.open(here.protocol(), failed);
    if (!failed) acceptor.set_option(tcp::acceptor::reuse_address(true), failed);
    if (!failed) acceptor.bind(here, failed);
    if (!failed) acceptor.listen(asio::socket_base::max_listen_connections, failed);
    if (!failed) return;
    Fault fault;
    fault.file = "--port";
    fault.expected = "a port that this user may open and that is free";
    fault.found = fmt::format("{}: {}", port, failed.message());
    throw SceneError({fault});
}

LoopbackServer::~LoopbackServer() = default;

int LoopbackServer::port() const {
    return sockets_->acceptor.local_endpoint().port();
}

void LoopbackServer::serve(const std::function<WebReply(const WebRequest&)>& answer) {
    static std::mutex one_at_a_time; // as long as the threads, which nobody waits for
    const int own = port();
    for (;;) {
        tcp::socket socket(sockets_->context);
        boost::system::error_code failed;
        sockets_->acceptor.accept(socket, failed);
        if (failed) { // no file descriptor left, say
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            continue;
        }
        std::thread(
            [own, &answer](tcp::socket connection) {
                try {
                    converse(std::move(connection), own, one_at_a_time, answer);
                } catch (const std::exception&) { // out of memory: this connection ends, the browser asks again
                }
            },
            std::move(socket))
            .detach();
    }
}

} // namespace osculate::app
