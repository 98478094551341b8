#include "server/listen/peer.h"

#include <netinet/in.h>

#include <algorithm>
#include <cstring>

namespace milepost::server {
namespace {

constexpr std::size_t kPrefixBytes = 8;  // of an IPv6 network

Peer::Key key_of(const in_addr& address) {
  Peer::Key key{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};
  std::memcpy(key.data() + 12, &address, 4);
  return key;
}

Peer::Key key_of(const in6_addr& address) {
  Peer::Key key{};
  const bool mapped = IN6_IS_ADDR_V4MAPPED(&address);
  std::memcpy(key.data(), &address, mapped ? key.size() : kPrefixBytes);
  return key;
}

}  // namespace

Peer Peer::of(const SocketAddress& address) {
  Peer peer{address.host(), {}, !address.is_unix()};
  if (address.storage.ss_family == AF_INET) {
    peer.key = key_of(reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr);
  } else if (address.storage.ss_family == AF_INET6) {
    peer.key = key_of(reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_addr);
  }
  return peer;
}

}  // namespace milepost::server
