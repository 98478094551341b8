// The tile server: serves a catalog on one or several addresses.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "schema/base/result.h"
#include "server/catalog/current_catalog.h"
#include "server/http/settings.h"
#include "server/metrics/metrics.h"

namespace milepost::server {

// Handles requests on its own threads from start() to stop(). Raises the process's limit of open
// descriptors as far as it may.
class Server {
 public:
  // Errors: invalid_input (an address, an inherited socket; none at all), io (an address cannot be
  // listened on).
  static Result<std::unique_ptr<Server>> start(std::shared_ptr<const CurrentCatalog> catalog,
                                               const ServerSettings& settings);
  ~Server();  // stop()
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  // To which the program may add what it knows itself, before the first scrape.
  Metrics& metrics();

  // The addresses it listens on, with the actual ports: "127.0.0.1:8080", "unix:/path".
  const std::vector<std::string>& addresses() const;
  // The first of them, and its port.
  const std::string& address() const;
  std::uint16_t port() const;

  // Accepts what has connected and no more; answers what has been requested, as far as the drain
  // time goes; closes every connection and returns when all threads have ended. A second call does
  // nothing. Not safe to call from several threads at once.
  void stop();

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace milepost::server
