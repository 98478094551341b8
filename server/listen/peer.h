// Who is at the other end of a connection.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "server/listen/socket_address.h"

namespace milepost::server {

struct Peer {
  // What one client has to itself: an IPv4 address (mapped), or the first 64 bits of IPv6.
  using Key = std::array<std::uint8_t, 16>;

  std::string host;      // for the log: an address, or "unix"
  Key key{};             // all 0 for a unix socket
  bool counted = false;  // has a limit of its own; a proxy on a unix socket has not

  static Peer of(const SocketAddress& address);
};

}  // namespace milepost::server
