#include "server/message/head.h"

#include <array>

#include <boost/beast/http/status.hpp>

namespace milepost::server {
namespace {

void append_field(std::string& head, std::string_view name, std::string_view value) {
  head.append(name).append(": ").append(value).append("\r\n");
}

}  // namespace

// The version of a response is the server's own, whatever the request's is (RFC 9110, section 2.5).
std::string head_of(const Response& response) {
  namespace http = boost::beast::http;
  std::string head = "HTTP/1.1 " + std::to_string(response.status) + ' ';
  head += std::string(http::obsolete_reason(http::int_to_status(response.status))) + "\r\n";
  append_field(head, "Server", "milepost/" MILEPOST_VERSION);
  for (const auto& [name, value] : response.headers) append_field(head, name, value);
  if (response.status != 204 && response.status != 304) {
    append_field(head, "Content-Length", std::to_string(response.content_length()));
  }
  return head;
}

std::string_view HeadEnds::end(std::time_t now, unsigned http_version, bool keep_alive) {
  if (now != at_) {
    at_ = now;
    const std::string date = "Date: " + http_date(now) + "\r\n";
    open_ = date + "\r\n";
    open_1_0_ = date + "Connection: keep-alive\r\n\r\n";
    closed_ = date + "Connection: close\r\n\r\n";
  }
  if (!keep_alive) return closed_;
  return http_version < 11 ? open_1_0_ : open_;
}

std::string http_date(std::time_t time) {
  std::tm utc{};
  gmtime_r(&time, &utc);
  std::array<char, 64> text{};
  // The program always uses the "C" locale, so the names are in English, as HTTP requires.
  const std::size_t length = std::strftime(text.data(), text.size(), "%a, %d %b %Y %T GMT", &utc);
  return {text.data(), length};
}

}  // namespace milepost::server
