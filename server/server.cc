#include "server/server.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/http/listener.h"
#include "server/http/shared.h"
#include "server/http/worker.h"
#include "server/listen/descriptor_limit.h"
#include "server/listen/listening_socket.h"

namespace milepost::server {
namespace {

// Opens the sockets of `settings`.
Result<std::vector<ListeningSocket>> opened_sockets(const ServerSettings& settings) {
  std::vector<ListeningSocket> sockets;
  for (const int descriptor : settings.inherited) {
    Result<ListeningSocket> socket = ListeningSocket::inherited(descriptor);
    if (!socket) return socket.error();
    sockets.push_back(std::move(socket).value());
  }
  for (const ListenAddress& address : settings.listen) {
    Result<std::vector<ListeningSocket>> opened = ListeningSocket::open(address);
    if (!opened) return opened.error();
    std::ranges::move(*opened, std::back_inserter(sockets));
  }
  if (!sockets.empty()) return sockets;
  return Error{ErrorCode::invalid_input, "", "there is no address to listen on",
               "give one, such as 127.0.0.1:8080"};
}

double seconds_since_1970(std::chrono::sys_seconds time) {
  return static_cast<double>(time.time_since_epoch().count());
}

// The limits with numbers in place of 0.
ConnectionLimits completed(ConnectionLimits limits) {
  const std::size_t most = connections_within(raise_descriptor_limit());
  if (limits.connections > most) {
    spdlog::warn("the limit of {} connections is lowered to {}, as there are no more descriptors",
                 limits.connections, most);
  }
  limits.connections = limits.connections == 0 ? most : std::min(limits.connections, most);
  if (limits.per_address == 0) limits.per_address = (limits.connections + 1) / 2;
  return limits;
}

}  // namespace

struct Server::Impl {
  Impl(std::shared_ptr<const CurrentCatalog> catalog, const ServerSettings& settings,
       std::vector<ListeningSocket> sockets)
      : port(sockets.front().port()),
        shared(std::move(catalog), settings, completed(settings.limits)) {
    for (const ListeningSocket& socket : sockets) addresses.push_back(socket.address());
    for (unsigned i = 0; i < settings.threads; ++i) {
      workers.push_back(std::make_unique<Worker>(shared));
    }
    listener = std::make_unique<Listener>(std::move(sockets), shared, workers);
    shared.metrics.add("milepost_connections", "Connections that are open.", Metrics::Kind::gauge,
                       [this] { return static_cast<double>(shared.admission.count()); });
    shared.metrics.add("milepost_connections_max", "Connections that may be open.",
                       Metrics::Kind::gauge,
                       [this] { return static_cast<double>(shared.limits.connections); });
    if (shared.tls != nullptr) add_tls_metrics();
  }

  void add_tls_metrics() {
    shared.metrics.add("milepost_tls_handshakes_failed_total",
                       "Connections without agreement on TLS.", Metrics::Kind::counter,
                       [this] { return static_cast<double>(shared.failed_handshakes); });
    shared.metrics.add("milepost_tls_certificate_expiry_seconds",
                       "When the certificate expires, in seconds since 1970.", Metrics::Kind::gauge,
                       [this] { return seconds_since_1970(shared.tls->now()->expires()); });
  }

  void start() {
    listener->start();
    for (const auto& worker : workers) worker->start();
    running = true;
  }

  bool drained() const {
    const Clock::time_point end = Clock::now() + shared.limits.drain;
    return std::ranges::all_of(workers,
                               [end](const auto& worker) { return worker->ended_by(end); });
  }

  std::vector<std::string> addresses;
  const std::uint16_t port;
  Shared shared;
  std::vector<std::unique_ptr<Worker>> workers;
  std::unique_ptr<Listener> listener;
  bool running = false;
};

Result<std::unique_ptr<Server>> Server::start(std::shared_ptr<const CurrentCatalog> catalog,
                                              const ServerSettings& settings) {
  Result<std::vector<ListeningSocket>> sockets = opened_sockets(settings);
  if (!sockets) return sockets.error();
  auto impl = std::make_unique<Impl>(std::move(catalog), settings, std::move(sockets).value());
  impl->start();
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Server::~Server() { stop(); }

const std::vector<std::string>& Server::addresses() const { return impl_->addresses; }

const std::string& Server::address() const { return impl_->addresses.front(); }

Metrics& Server::metrics() { return impl_->shared.metrics; }

std::uint16_t Server::port() const { return impl_->port; }

void Server::stop() {
  if (!impl_->running) return;
  impl_->running = false;
  impl_->listener->close();
  for (const auto& worker : impl_->workers) worker->finish();
  if (!impl_->drained()) {
    spdlog::warn("{} connections are aborted", impl_->shared.admission.count());
    for (const auto& worker : impl_->workers) worker->abort();
  }
  for (const auto& worker : impl_->workers) worker->join();
  impl_->shared.disk.stop();
}

}  // namespace milepost::server
