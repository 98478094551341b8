// The tile server: serves a catalog on an address.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "schema/base/result.h"
#include "server/catalog/current_catalog.h"
#include "server/http/settings.h"

namespace milepost::server {

struct ServerSettings {
  std::string address = "127.0.0.1";  // IPv4 or IPv6, as numbers
  std::uint16_t port = 0;             // 0: any free port
  unsigned threads = 1;               // >= 1; the catalog has at least as many readers
  ConnectionLimits limits;
};

// Handles requests on its own threads from start() to stop().
class Server {
 public:
  // Errors: invalid_input (address), io (it cannot be listened on).
  static Result<std::unique_ptr<Server>> start(std::shared_ptr<const CurrentCatalog> catalog,
                                               const ServerSettings& settings);
  ~Server();  // stop()
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // The address it listens on, with the actual port: "127.0.0.1:8080".
  const std::string& address() const;
  std::uint16_t port() const;

  // Stops accepting, gives responses in progress the drain time to finish, closes every connection
  // and returns when all threads have ended. A second call does nothing.
  // Not safe to call from several threads at once.
  void stop();

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost::server
