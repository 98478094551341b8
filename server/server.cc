#include "server/server.h"

#include <spdlog/spdlog.h>

#include <sstream>
#include <thread>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "server/http/listener.h"
#include "server/http/session.h"

namespace milepost::server {

struct Server::Impl {
  explicit Impl(const ServerSettings& chosen)
      : settings(chosen), context(static_cast<int>(chosen.threads)) {}

  const ServerSettings settings;
  std::string address;
  std::uint16_t port = 0;

  Sessions sessions;  // outlives the context, whose handlers refer to it
  net::io_context context;
  std::shared_ptr<Listener> listener;
  std::vector<std::thread> threads;

  void run_threads() {
    for (unsigned i = 0; i < settings.threads; ++i) {
      threads.emplace_back([this] { context.run(); });
    }
  }

  // The threads end once the listener and all sessions are closed.
  void join_threads() {
    for (std::thread& thread : threads) thread.join();
    threads.clear();
  }
};

Result<std::unique_ptr<Server>> Server::start(std::shared_ptr<const CurrentCatalog> catalog,
                                              const ServerSettings& settings) {
  error_code error;
  const net::ip::address address = net::ip::make_address(settings.address, error);
  if (error) {
    return Error{ErrorCode::invalid_input, "address " + settings.address,
                 "is not an IPv4 or IPv6 address", "write it as numbers, such as 127.0.0.1 or ::1"};
  }
  auto impl = std::make_unique<Impl>(settings);
  impl->listener = std::make_shared<Listener>(impl->context, std::move(catalog), settings.limits,
                                              impl->sessions);
  const Status opened = impl->listener->open({address, settings.port});
  if (!opened) return opened.error();
  std::ostringstream text;
  text << impl->listener->endpoint();
  impl->address = text.str();
  impl->port = impl->listener->endpoint().port();
  impl->listener->start();
  impl->run_threads();
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Server::~Server() { stop(); }

const std::string& Server::address() const { return impl_->address; }

std::uint16_t Server::port() const { return impl_->port; }

void Server::stop() {
  if (impl_->threads.empty()) return;
  impl_->listener->close();
  const auto sessions = impl_->sessions.stop();
  for (const auto& session : sessions) session->finish();
  if (!impl_->sessions.wait_none(impl_->settings.limits.drain)) {
    spdlog::warn("{} connections are aborted", impl_->sessions.count());
    for (const auto& session : sessions) session->abort();
  }
  impl_->join_threads();
}

}  // namespace milepost::server
