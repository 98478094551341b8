// HTTP GET, the client's only use of the network.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "client/fetch/stopped.h"
#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost {

// Receives the body of a successful response piece by piece. An error aborts the request with that
// error.
using BodySink = std::function<Status(ByteView piece)>;

// The outcome of a request.
struct HttpAnswer {
  // ok: status 200, not an HTML page, and the whole body was passed to the sink. Otherwise the
  // error names the URL: not_found (404), gone (410) and invalid_input (400 and other refusals),
  // each only if the body is application/problem+json, as a milepost server sends it; invalid_input
  // (an invalid URL); corrupt (a body beyond the limit); cancelled; unavailable (no connection, a
  // timeout, an interrupted body, 401, 403, 429, 5xx, and foreign_answer for everything else); or
  // the error of the sink.
  Status status;
  double retry_after_s = 0;      // requested by a busy server; 0 if not
  std::uint64_t body_bytes = 0;  // received, also of an interrupted response
  bool is_foreign = false;       // `status` is a foreign_answer
};

// The error for a response from something other than a milepost server: a network's login page, a
// proxy, another program. Equivalent to no server, so its code is unavailable. `what`: how that was
// detected.
Error foreign_answer(const std::string& url, const std::string& what);

// Whether a cache between the client and the server may answer. Where one has served damaged bytes,
// the same request is sent with `Cache-Control: no-cache`.
enum class Caches { allowed, bypassed };

// All members are safe to call from several threads at once.
class Transport {
 public:
  virtual ~Transport() = default;
  // Sends one request. At most `body_limit_bytes` are passed to the sink. Once `stopped` returns
  // true, the call ends within 0.1 s with `cancelled`.
  virtual HttpAnswer get(const std::string& url, std::uint64_t body_limit_bytes, Caches caches,
                         const BodySink& sink, const Stopped& stopped) = 0;
};

struct TransportSettings {
  double connect_timeout_s = 5;
  // Aborts a response with less than least_bytes_per_s over this time; rounded up to whole seconds.
  double stall_timeout_s = 10;
  double least_bytes_per_s = 200;
  // Certificates in PEM form by which a server is trusted over https; empty: those of the system.
  std::string ca_file = {};
  // The token that the server's operator gave out (RFC 6750); empty: none is sent. No other host
  // gets it.
  std::string token = {};
};

// A transport by libcurl: keeps connections open between requests, with one handle per concurrent
// request; follows up to five redirects, http and https only; uses the proxies in the environment
// variables that curl uses; takes documents compressed.
std::unique_ptr<Transport> make_curl_transport(const TransportSettings& settings);

// `base` (http or https, a host, optionally a path) without trailing slashes. Errors:
// invalid_input.
Result<std::string> checked_server_url(const std::string& base);

// Percent-encodes one segment of a URL path.
std::string escaped_for_url(const std::string& text);

}  // namespace milepost
