#include "server/http/listener.h"

#include <spdlog/spdlog.h>

#include <sstream>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>

#include "server/http/session.h"

namespace milepost::server {
namespace {

using Tcp = net::ip::tcp;

constexpr std::chrono::milliseconds kPauseAfterError{100};
// Connections beyond the limit that are answered with 503; further ones are closed silently.
constexpr std::size_t kRejected = 64;

}  // namespace

Listener::Listener(net::io_context& context, std::shared_ptr<const CurrentCatalog> catalog,
                   const ConnectionLimits& limits, Sessions& sessions)
    : context_(context),
      catalog_(std::move(catalog)),
      limits_(limits),
      sessions_(sessions),
      acceptor_(net::make_strand(context)),
      pause_(acceptor_.get_executor()) {}

Status Listener::open(const Tcp::endpoint& endpoint) {
  error_code error;
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(Tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(Tcp::acceptor::max_listen_connections, error);
  if (!error) return ok_status();
  std::ostringstream where;
  where << endpoint;
  return Error{ErrorCode::io, where.str(), "cannot be listened on (" + error.message() + ")",
               "choose another address or port, or end the program that uses it"};
}

void Listener::start() {
  const auto run_self = [self = shared_from_this()] { return self->run(); };
  net::co_spawn(acceptor_.get_executor(), run_self, net::detached);
}

void Listener::close() {
  net::post(acceptor_.get_executor(), [self = shared_from_this()] {
    error_code ignored;  // the socket is closed in any case
    self->acceptor_.close(ignored);
    self->pause_.cancel();
  });
}

net::awaitable<void> Listener::run() {
  while (acceptor_.is_open()) {
    error_code error;
    const net::any_io_executor strand = net::make_strand(context_);
    Tcp::socket socket = co_await acceptor_.async_accept(strand, awaited(error));
    if (!error) {
      welcome(std::move(socket));
    } else if (acceptor_.is_open()) {  // transient, such as no free file descriptors
      spdlog::warn("a connection cannot be accepted ({}); accepting continues", error.message());
      pause_.expires_after(kPauseAfterError);
      co_await pause_.async_wait(awaited(error));
    }
  }
}

void Listener::welcome(Tcp::socket socket) {
  const std::size_t open = sessions_.count();
  if (open >= limits_.connections + kRejected) {
    spdlog::warn("a connection is closed: {} are open", open);
    return;
  }
  const bool serve = open < limits_.connections;
  if (!serve) spdlog::warn("a connection is rejected: {} are open", open);
  const auto service = serve ? Session::Service::serve : Session::Service::reject;
  std::make_shared<Session>(std::move(socket), service, catalog_, limits_, sessions_)->start();
}

}  // namespace milepost::server
