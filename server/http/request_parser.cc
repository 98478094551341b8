#include "server/http/request_parser.h"

#include <algorithm>
#include <string>

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/error.hpp>

namespace milepost::server {
namespace http = boost::beast::http;
namespace {

using Fields = http::request<http::string_body>;

constexpr std::size_t kEmptyLines = 8;  // skipped before a request; then it is none

constexpr const char* kTwoFramings =
    "the request has both Content-Length and Transfer-Encoding; send one of the two";
constexpr const char* kNoLength =
    "the request's Content-Length is not one whole number; send it once, in decimal digits";
constexpr const char* kTwoEncodings =
    "the request's Transfer-Encoding is given more than once; send it once, as 'chunked'";
constexpr const char* kTwoAuthorizations =
    "the request's Authorization is given more than once; send it once";
constexpr const char* kUnknownEncoding =
    "the request has a Transfer-Encoding other than 'chunked'; send the body in chunks, or with "
    "Content-Length";

std::string all_values(const Fields& fields, http::field name) {
  std::string joined;
  const auto [begin, end] = fields.equal_range(name);
  for (auto field = begin; field != end; ++field) {
    joined.append(joined.empty() ? "" : ", ").append(std::string(field->value()));
  }
  return joined;
}

Request request_of(const Fields& fields) {
  return {.method = std::string(fields.method_string()),
          .target = std::string(fields.target()),
          .if_none_match = all_values(fields, http::field::if_none_match),
          .if_range = all_values(fields, http::field::if_range),
          .range = all_values(fields, http::field::range),
          .accept_encoding = all_values(fields, http::field::accept_encoding),
          .authorization = std::string(fields[http::field::authorization]),
          .origin = all_values(fields, http::field::origin)};
}

bool is_whole_number(boost::beast::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Why the end of the request's body is ambiguous (RFC 9112, section 6), or null.
const char* fault_of_framing(const Fields& fields) {
  const std::size_t lengths = fields.count(http::field::content_length);
  const std::size_t encodings = fields.count(http::field::transfer_encoding);
  if (lengths > 0 && encodings > 0) return kTwoFramings;
  if (lengths > 1) return kNoLength;
  if (lengths == 1 && !is_whole_number(fields[http::field::content_length])) return kNoLength;
  if (encodings > 1) return kTwoEncodings;
  if (encodings == 0) return nullptr;
  if (fields.version() < 11) {
    return "HTTP/1.0 has no Transfer-Encoding; send Content-Length, or HTTP/1.1";
  }
  return boost::beast::iequals(fields[http::field::transfer_encoding], "chunked")
             ? nullptr
             : kUnknownEncoding;
}

const char* fault_of_host(const Fields& fields) {
  const std::size_t hosts = fields.count(http::field::host);
  const bool fits = fields.version() < 11 ? hosts <= 1 : hosts == 1;
  return fits ? nullptr : "the request needs one Host field; correct the client";
}

// The message for bytes that Beast rejects; a field that it rejects is not among `fields`.
std::string fault_of(const error_code& error, const Fields& fields) {
  const bool has_length = fields.count(http::field::content_length) > 0;
  const bool has_encoding = fields.count(http::field::transfer_encoding) > 0;
  if (error == http::error::bad_content_length) return has_encoding ? kTwoFramings : kNoLength;
  if (error == http::error::bad_transfer_encoding) return has_length ? kTwoFramings : kTwoEncodings;
  return "this is not an HTTP/1.1 request (" + error.message() + "); correct the client";
}

}  // namespace

RequestParser::RequestParser(const ConnectionLimits& limits) : header_limit_(limits.header_bytes) {
  parser_.header_limit(static_cast<std::uint32_t>(limits.header_bytes));
  parser_.body_limit(limits.body_bytes);
  parser_.eager(false);  // stops between header and body
}

bool RequestParser::wants_continue() const {
  const Fields& fields = parser_.get();
  return parser_.is_header_done() && !done() && fields.version() >= 11 &&
         boost::beast::iequals(fields[http::field::expect], "100-continue");
}

std::size_t RequestParser::take(std::string_view bytes) {
  std::size_t taken = untouched() ? take_empty_lines(bytes) : 0;
  if (untouched() && bytes.substr(taken) == "\r") return taken;  // perhaps of one more
  error_code error;
  while (!done() && !error && taken < bytes.size()) {
    const std::string_view rest = bytes.substr(taken);
    const bool in_head = !parser_.is_header_done();
    const std::size_t used = parser_.put(boost::asio::buffer(rest.data(), rest.size()), error);
    if (in_head) take_head(rest.substr(0, used), error);
    taken += used;
  }
  if (!error || incoming_.refusal) return taken;
  const std::string_view rest = bytes.substr(taken);
  if (error == http::error::need_more) {
    const bool in_head = !parser_.is_header_done();
    if (in_head && head_bytes_ + rest.size() > header_limit_) refuse_long_head(rest);
  } else if (error == http::error::header_limit) {
    refuse_long_head(rest);
  } else if (error == http::error::body_limit) {
    refuse(413, "the request's body is too long; no path of this server takes one");
  } else {
    refuse(400, fault_of(error, parser_.get()));
  }
  return taken;
}

// Clients of old end a request with one line end too many (RFC 9112, section 2.2).
std::size_t RequestParser::take_empty_lines(std::string_view bytes) {
  std::size_t taken = 0;
  for (; empty_lines_ < kEmptyLines && bytes.substr(taken).starts_with("\r\n"); taken += 2) {
    ++empty_lines_;
  }
  return taken;
}

void RequestParser::take_head(std::string_view part, const error_code& error) {
  head_bytes_ += part.size();
  folded_ = folded_ || part.find("\r\n ") != std::string_view::npos ||
            part.find("\r\n\t") != std::string_view::npos;
  // A body whose stated length is too long is an error at the end of the header.
  if (parser_.is_header_done() || error == http::error::body_limit) end_head();
}

void RequestParser::end_head() {
  const Fields& fields = parser_.get();
  if (head_bytes_ > header_limit_) return refuse_long_head({});
  if (folded_) {
    return refuse(400, "a field of the request's header continues on a second line; use one");
  }
  if (const char* fault = fault_of_framing(fields)) return refuse(400, fault);
  if (const char* fault = fault_of_host(fields)) return refuse(400, fault);
  if (fields.count(http::field::authorization) > 1) return refuse(400, kTwoAuthorizations);
  incoming_.request = request_of(fields);
  incoming_.http_version = fields.version();
  incoming_.keep_alive = fields.keep_alive();
}

// `rest`: the bytes of the head that were not taken.
void RequestParser::refuse_long_head(std::string_view rest) {
  const std::size_t line_end = rest.find("\r\n");
  const bool has_first_line =
      !parser_.get().target().empty() ||
      (line_end != std::string_view::npos && head_bytes_ + line_end <= header_limit_);
  if (has_first_line) {
    refuse(431, "the request's header is too long; send fewer or shorter fields");
  } else {
    refuse(414, "the request's first line is too long; shorten the URL");
  }
}

void RequestParser::refuse(unsigned status, const std::string& detail) {
  const Fields& fields = parser_.get();
  // For the log, as far as they were read.
  incoming_.request.method = std::string(fields.method_string());
  incoming_.request.target = std::string(fields.target());
  incoming_.keep_alive = false;
  incoming_.refusal = problem(status, detail);
}

}  // namespace milepost::server
