// Parses requests from the bytes of a connection, without a socket.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/http/error_code.h"
#include "server/http/settings.h"
#include "server/message/request.h"
#include "server/message/response.h"

namespace milepost::server {

// A request, or the response to bytes that are not a request.
struct Incoming {
  Request request;
  unsigned http_version = 11;       // 10 or 11
  bool keep_alive = false;          // the client may send another request
  std::optional<Response> refusal;  // the bytes after it cannot be interpreted
};

// Reads one request by the framing of HTTP/1.1 (RFC 9112), and rejects ambiguous framing: a proxy
// in front of the server must find the same end of the request (against request smuggling).
// The body is discarded. Not safe to use from several threads at once.
class RequestParser {
 public:
  // Uses the limits `header_bytes` and `body_bytes`.
  explicit RequestParser(const ConnectionLimits& limits);

  // Consumes bytes from the front and returns their number. Unless done(), the next call passes the
  // remaining bytes again, followed by more. REQUIRES: not done().
  std::size_t take(std::string_view bytes);
  // The request is complete, or rejected.
  bool done() const { return incoming_.refusal.has_value() || parser_.is_done(); }
  // Not a byte of a request has come, except for empty lines before it.
  bool untouched() const { return head_bytes_ == 0; }
  // The client sends the body only after 100 Continue (RFC 9110, section 10.1.1).
  bool wants_continue() const;
  // REQUIRES: done().
  const Incoming& incoming() const { return incoming_; }
  Incoming& incoming() { return incoming_; }

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;

  std::size_t take_empty_lines(std::string_view bytes);
  void take_head(std::string_view part, const error_code& error);
  void end_head();
  void refuse_long_head(std::string_view rest);
  void refuse(unsigned status, const std::string& detail);

  Parser parser_;
  std::size_t header_limit_;  // bytes
  std::size_t head_bytes_ = 0;
  std::size_t empty_lines_ = 0;  // before the request
  bool folded_ = false;          // a field continued on a second line
  Incoming incoming_;
};

}  // namespace milepost::server
