#include "server/listen/socket_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/un.h>

namespace milepost::server {
namespace {

const sockaddr_in& as_ipv4(const SocketAddress& address) {
  return reinterpret_cast<const sockaddr_in&>(address.storage);
}

const sockaddr_in6& as_ipv6(const SocketAddress& address) {
  return reinterpret_cast<const sockaddr_in6&>(address.storage);
}

}  // namespace

std::string SocketAddress::host() const {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (storage.ss_family == AF_INET) {
    inet_ntop(AF_INET, &as_ipv4(*this).sin_addr, text.data(), text.size());
  } else if (storage.ss_family == AF_INET6) {
    inet_ntop(AF_INET6, &as_ipv6(*this).sin6_addr, text.data(), text.size());
  } else {
    return "unix";
  }
  return text.data();
}

std::uint16_t SocketAddress::port() const {
  if (storage.ss_family == AF_INET) return ntohs(as_ipv4(*this).sin_port);
  if (storage.ss_family == AF_INET6) return ntohs(as_ipv6(*this).sin6_port);
  return 0;
}

std::string SocketAddress::text() const {
  if (is_unix()) {
    return std::string("unix:") + reinterpret_cast<const sockaddr_un&>(storage).sun_path;
  }
  const std::string port_text = std::to_string(port());
  if (storage.ss_family == AF_INET6) return '[' + host() + "]:" + port_text;
  return host() + ':' + port_text;
}

void SocketAddress::set_port(std::uint16_t port) {
  if (storage.ss_family == AF_INET) {
    reinterpret_cast<sockaddr_in&>(storage).sin_port = htons(port);
  } else {
    reinterpret_cast<sockaddr_in6&>(storage).sin6_port = htons(port);
  }
}

}  // namespace milepost::server
