// Accepts connections until it is closed.
#pragma once

#include <memory>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include "schema/base/result.h"
#include "server/catalog/current_catalog.h"
#include "server/http/asio.h"
#include "server/http/sessions.h"
#include "server/http/settings.h"

namespace milepost::server {

// Runs on a strand of its own.
class Listener : public std::enable_shared_from_this<Listener> {
 public:
  // `context` and `sessions` must outlive the listener.
  Listener(net::io_context& context, std::shared_ptr<const CurrentCatalog> catalog,
           const ConnectionLimits& limits, Sessions& sessions);

  // Binds and listens. Errors: io (the address is not ours, or in use, or not permitted).
  Status open(const net::ip::tcp::endpoint& endpoint);
  // REQUIRES: open.
  net::ip::tcp::endpoint endpoint() const { return acceptor_.local_endpoint(); }

  void start();
  // May be called from any thread.
  void close();

 private:
  net::awaitable<void> run();
  void welcome(net::ip::tcp::socket socket);

  net::io_context& context_;
  const std::shared_ptr<const CurrentCatalog> catalog_;
  const ConnectionLimits limits_;
  Sessions& sessions_;
  net::ip::tcp::acceptor acceptor_;
  net::steady_timer pause_;
};

}  // namespace milepost::server
