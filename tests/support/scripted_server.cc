#include "tests/support/scripted_server.h"

#include <stdlib.h>

#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>

namespace milepost::testing {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;

// What the server saw, read by the test's thread.
struct Record {
  mutable std::mutex mutex;
  std::vector<std::string> targets;
  std::string user_agent;
  std::string cache_control;
  std::size_t connections = 0;
};

std::string head_of(const ScriptedAnswer& answer) {
  std::ostringstream head;
  head << "HTTP/1.1 " << answer.status << " "
       << http::obsolete_reason(static_cast<http::status>(answer.status)) << "\r\n"
       << "Content-Length: " << answer.body.size() << "\r\n";
  for (const auto& [name, value] : answer.headers) head << name << ": " << value << "\r\n";
  head << "\r\n";
  return head.str();
}

// One connection: reads a request, writes the answer, and so on until either side closes.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(tcp::socket socket, const ScriptedServer::Handler& handler, Record& record)
      : socket_(std::move(socket)), handler_(handler), record_(record) {}

  void read() {
    request_ = {};
    http::async_read(socket_, buffer_, request_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (!error) self->answer();
                     });
  }

 private:
  void answer() {
    const std::string target(request_.target());
    {
      const std::lock_guard lock(record_.mutex);
      record_.targets.push_back(target);
      record_.user_agent = std::string(request_[http::field::user_agent]);
      record_.cache_control = std::string(request_[http::field::cache_control]);
    }
    const ScriptedAnswer answer = handler_(target);
    if (answer.silent) return wait_for_close();
    const std::size_t sent = answer.break_off_after.value_or(answer.body.size());
    message_ = head_of(answer) + answer.body.substr(0, sent);
    const bool closing = answer.break_off_after.has_value();
    asio::async_write(socket_, asio::buffer(message_),
                      [self = shared_from_this(), closing](error_code error, std::size_t) {
                        if (!error && !closing) self->read();
                      });
  }

  void wait_for_close() {
    socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](error_code) {});
  }

  tcp::socket socket_;
  const ScriptedServer::Handler& handler_;
  Record& record_;
  boost::beast::flat_buffer buffer_;
  http::request<http::string_body> request_;
  std::string message_;
};

}  // namespace

struct ScriptedServer::Impl {
  explicit Impl(Handler given) : handler(std::move(given)) {
    port = acceptor->local_endpoint().port();
    accept();
    thread = std::thread([this] { context->run(); });
  }

  void accept() {
    acceptor->async_accept([this](error_code error, tcp::socket socket) {
      if (error) return;
      {
        const std::lock_guard lock(record.mutex);
        ++record.connections;
      }
      std::make_shared<Session>(std::move(socket), handler, record)->read();
      accept();
    });
  }

  void stop() {
    if (!thread.joinable()) return;
    context->stop();
    thread.join();
    acceptor.reset();
    context.reset();  // closes the sessions, which live in its handlers
  }

  Handler handler;
  Record record;
  std::optional<asio::io_context> context{std::in_place, 1};
  std::optional<tcp::acceptor> acceptor{
      std::in_place, *context, tcp::endpoint(asio::ip::address_v4::loopback(), std::uint16_t{0})};
  std::uint16_t port = 0;
  std::thread thread;
};

ScriptedServer::ScriptedServer(Handler handler)
    : impl_(std::make_unique<Impl>(std::move(handler))) {
  // A proxy of the machine that the tests run on plays no part in them.
  setenv("no_proxy", "127.0.0.1", /*overwrite=*/1);
}

ScriptedServer::~ScriptedServer() { stop(); }

std::string ScriptedServer::url() const {
  return "http://127.0.0.1:" + std::to_string(impl_->port);
}

std::vector<std::string> ScriptedServer::requests() const {
  const std::lock_guard lock(impl_->record.mutex);
  return impl_->record.targets;
}

std::string ScriptedServer::user_agent() const {
  const std::lock_guard lock(impl_->record.mutex);
  return impl_->record.user_agent;
}

std::string ScriptedServer::cache_control() const {
  const std::lock_guard lock(impl_->record.mutex);
  return impl_->record.cache_control;
}

std::size_t ScriptedServer::connections() const {
  const std::lock_guard lock(impl_->record.mutex);
  return impl_->record.connections;
}

void ScriptedServer::stop() { impl_->stop(); }

}  // namespace milepost::testing
