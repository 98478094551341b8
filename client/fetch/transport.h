// HTTP GET: the one thing the client asks of the network.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "client/fetch/stopped.h"
#include "schema/base/bytes.h"
#include "schema/base/result.h"

namespace milepost {

// Takes the body of a successful answer piece by piece. An error ends the request with that error.
using BodySink = std::function<Status(ByteView piece)>;

// How a request ended.
struct HttpAnswer {
  // ok: status 200, no page of HTML, and the whole body went to the sink. Otherwise the error names
  // the URL: not_found (404), gone (410) and invalid_input (400 and other refusals), each only
  // where the body is application/problem+json, as a milepost server's is; invalid_input (a URL
  // that is none); corrupt (a body beyond the limit); cancelled; unavailable (no connection, a
  // timeout, a body that breaks off, 429, 5xx, and foreign_answer for all else), or what the sink
  // returned.
  Status status;
  double retry_after_s = 0;      // what a busy server asked for; 0 if it asked for nothing
  std::uint64_t body_bytes = 0;  // received, also of an answer that broke off
};

// The error where something else than a milepost server answered: a network's login page, a proxy,
// another program. As good as no server, so it is unavailable. `what`: how that is known.
Error foreign_answer(const std::string& url, const std::string& what);

// All members are safe to call from several threads at once.
class Transport {
 public:
  virtual ~Transport() = default;
  // Makes one request. `body_limit_bytes` bounds what the sink may be given; once `stopped` says
  // so, it ends within a tenth of a second, cancelled.
  virtual HttpAnswer get(const std::string& url, std::uint64_t body_limit_bytes,
                         const BodySink& sink, const Stopped& stopped) = 0;
};

struct TransportSettings {
  double connect_timeout_s = 5;
  // Ends an answer that brings less than least_bytes_per_s over so long; rounded up to whole
  // seconds.
  double stall_timeout_s = 10;
  double least_bytes_per_s = 200;
};

// libcurl: keeps connections open between requests, one handle a request under way; follows up to
// five redirects, http and https only; takes proxies from the environment as curl does.
std::unique_ptr<Transport> make_curl_transport(const TransportSettings& settings);

// `base` (http or https, a host, perhaps a path) without slashes at its end.
// Errors: invalid_input.
Result<std::string> checked_server_url(const std::string& base);

// One segment of a URL's path, with everything escaped that is not plain.
std::string escaped_for_url(const std::string& text);

}  // namespace milepost
