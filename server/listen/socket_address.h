// A socket address of the system, of any family.
#pragma once

#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <string>

namespace milepost::server {

struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t bytes = sizeof(sockaddr_storage);

  sockaddr* data() { return reinterpret_cast<sockaddr*>(&storage); }
  const sockaddr* data() const { return reinterpret_cast<const sockaddr*>(&storage); }
  bool is_unix() const { return storage.ss_family == AF_UNIX; }

  // "127.0.0.1", "::1", or "unix".
  std::string host() const;
  std::uint16_t port() const;  // 0 for a unix socket
  // "127.0.0.1:8080", "[::1]:8080", or "unix:/path".
  std::string text() const;
  void set_port(std::uint16_t port);  // REQUIRES: IPv4 or IPv6
};

}  // namespace milepost::server
