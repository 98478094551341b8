#include "server/listen/listen_address.h"

#include <sys/un.h>

#include <charconv>

namespace milepost::server {
namespace {

constexpr std::string_view kUnix = "unix:";
constexpr std::string_view kPlain = "plain:";

Error wrong_listen_address(std::string_view text, const std::string& what) {
  return {ErrorCode::invalid_input, "address " + std::string(text), what,
          "write 127.0.0.1:8080, [::1]:8080, localhost:8080 or unix:/run/milepost.sock"};
}

Result<ListenAddress> unix_address(std::string_view text) {
  const std::string_view path = text.substr(kUnix.size());
  if (path.empty()) return wrong_listen_address(text, "has no path");
  if (path.size() >= sizeof(sockaddr_un::sun_path)) {
    return wrong_listen_address(text, "has a path that is too long for a unix socket");
  }
  return ListenAddress{{}, 0, std::string(path), true};
}

}  // namespace

Result<ListenAddress> parse_listen_address(std::string_view text) {
  if (text.starts_with(kUnix)) return unix_address(text);
  const bool plain = text.starts_with(kPlain);
  if (plain) text.remove_prefix(kPlain.size());
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) {
    return wrong_listen_address(text, "is not HOST:PORT");
  }
  std::string_view host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    return wrong_listen_address(text, "is an IPv6 address without brackets");
  }
  const std::string_view digits = text.substr(colon + 1);
  ListenAddress address{std::string(host), 0, {}, plain};
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), address.port);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    return wrong_listen_address(text, "has no port from 0 to 65535");
  }
  return address;
}

}  // namespace milepost::server
