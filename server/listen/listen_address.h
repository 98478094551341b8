// An address to listen on, as an operator writes it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "schema/base/result.h"

namespace milepost::server {

struct ListenAddress {
  std::string host = "127.0.0.1";  // a host name, or an IPv4 or IPv6 address without brackets
  std::uint16_t port = 0;          // 0: any free port
  std::string unix_path = {};      // of a unix socket, in place of host and port; empty for TCP
  bool plain = false;              // without TLS even if there is a certificate
};

// "HOST:PORT", "ADDR:PORT" or "[ADDR]:PORT", each also with "plain:" before it, or "unix:PATH",
// which is plain always. Errors: invalid_input.
Result<ListenAddress> parse_listen_address(std::string_view text);

}  // namespace milepost::server
