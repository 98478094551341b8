// The bytes of a connection: requests one after the other, in two pieces each; and the fast path
// for ordinary requests takes none of them in another way.
#include <cstdint>
#include <string_view>

#include "server/http/plain_request.h"
#include "server/http/request_parser.h"
#include "tests/fuzz/check.h"

namespace {

using namespace milepost;
using namespace milepost::server;

// A rejected request has its response, and an accepted one has what handle() requires.
void check_incoming(const Incoming& incoming) {
  if (incoming.refusal) {
    fuzz::check(!incoming.keep_alive && incoming.refusal->status >= 400);
  } else {
    fuzz::check(!incoming.request.method.empty() && !incoming.request.target.empty());
  }
}

void check_fast_path(std::string_view connection) {
  Incoming plain;
  const std::size_t taken = take_plain_request(connection, ConnectionLimits{}, plain);
  if (taken == 0) return;
  RequestParser parser(ConnectionLimits{});
  fuzz::check(parser.take(connection) == taken && parser.done());
  const Incoming& full = parser.incoming();
  fuzz::check(!full.refusal && !plain.refusal);
  fuzz::check(plain.request == full.request);
  fuzz::check(plain.http_version == full.http_version && plain.keep_alive == full.keep_alive);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view connection(reinterpret_cast<const char*>(data), size);
  while (!connection.empty()) {
    check_fast_path(connection);
    RequestParser parser(ConnectionLimits{});
    std::size_t taken = 0;
    for (const std::size_t arrived : {connection.size() / 2, connection.size()}) {
      if (!parser.done()) taken += parser.take(connection.substr(taken, arrived - taken));
      fuzz::check(taken <= connection.size());
      if (taken > arrived) break;
    }
    if (!parser.done()) return 0;  // the parser waits for more
    check_incoming(parser.incoming());
    if (!parser.incoming().keep_alive || taken == 0) return 0;
    connection.remove_prefix(taken);
  }
  return 0;
}
