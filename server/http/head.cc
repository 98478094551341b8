#include "server/http/head.h"

#include <array>
#include <ctime>
#include <sstream>

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/write.hpp>

namespace milepost::server {
namespace http = boost::beast::http;

std::string head_of(const Response& response, unsigned http_version, bool keep_alive) {
  http::response<http::empty_body> message;
  message.version(http_version);
  message.result(response.status);
  message.set(http::field::server, "milepost/" MILEPOST_VERSION);
  message.set(http::field::date, http_date());
  for (const auto& [name, value] : response.headers) message.set(name, value);
  if (response.status != 304) message.content_length(response.content_length());
  message.keep_alive(keep_alive);
  std::ostringstream text;
  text << message.base();
  return std::move(text).str();
}

std::string http_date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 64> text{};
  // The program always uses the "C" locale, so the names are in English, as HTTP requires.
  const std::size_t length = std::strftime(text.data(), text.size(), "%a, %d %b %Y %T GMT", &utc);
  return {text.data(), length};
}

}  // namespace milepost::server
