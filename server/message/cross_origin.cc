#include "server/message/cross_origin.h"

#include <algorithm>

namespace milepost::server {
namespace {

constexpr std::string_view kReadable =
    "Access-Control-Expose-Headers: Content-Length, Content-Range, ETag, Retry-After, "
    "WWW-Authenticate\r\n";
// What a browser asks before a request that is not a plain one.
constexpr std::string_view kPreflight =
    "Access-Control-Allow-Methods: GET, HEAD\r\n"
    "Access-Control-Allow-Headers: Authorization, Cache-Control, If-None-Match, If-Range, Range\r\n"
    "Access-Control-Max-Age: 86400\r\n";

bool is_host_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
         std::string_view(".-:[]").find(c) != std::string_view::npos;
}

}  // namespace

std::string cross_origin_lines(const std::vector<std::string>& allowed, std::string_view origin,
                               std::string_view method) {
  if (allowed.empty()) return {};
  const bool all = std::ranges::find(allowed, "*") != allowed.end();
  // Caches keep one answer for each origin.
  std::string lines = all ? "" : "Vary: Origin\r\n";
  if (!all && std::ranges::find(allowed, origin) == allowed.end()) return lines;
  lines.append("Access-Control-Allow-Origin: ").append(all ? "*" : origin).append("\r\n");
  lines.append(method == "OPTIONS" ? kPreflight : kReadable);
  return lines;
}

bool is_origin(std::string_view text) {
  if (text == "*") return true;
  for (const std::string_view scheme : {"https://", "http://"}) {
    if (!text.starts_with(scheme)) continue;
    text.remove_prefix(scheme.size());
    return !text.empty() && std::ranges::all_of(text, is_host_character);
  }
  return false;
}

}  // namespace milepost::server
