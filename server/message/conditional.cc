#include "server/message/conditional.h"

#include <algorithm>

namespace milepost::server {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

}  // namespace

std::string entity_tag(const std::string& digest) { return '"' + digest + '"'; }

bool names_tag(std::string_view if_none_match, std::string_view tag) {
  if (trimmed(if_none_match) == "*") return true;
  // Our tags contain no comma, so splitting at commas is sufficient.
  while (!if_none_match.empty()) {
    const std::size_t comma = std::min(if_none_match.find(','), if_none_match.size());
    std::string_view candidate = trimmed(if_none_match.substr(0, comma));
    if (candidate.starts_with("W/")) candidate.remove_prefix(2);  // weak comparison
    if (candidate == tag) return true;
    if_none_match.remove_prefix(std::min(comma + 1, if_none_match.size()));
  }
  return false;
}

Response unless_known(Response response, std::string_view if_none_match) {
  const std::string tag(response.header("ETag"));
  if (response.status != 200 || tag.empty() || !names_tag(if_none_match, tag)) return response;
  Response unchanged;
  unchanged.status = 304;
  unchanged.route = response.route;
  unchanged.map = response.map;
  unchanged.guard = response.guard;
  unchanged.headers = {{"ETag", tag},
                       {"Cache-Control", std::string(response.header("Cache-Control"))}};
  const std::string vary(response.header("Vary"));
  if (!vary.empty()) unchanged.headers.emplace_back("Vary", vary);
  return unchanged;
}

}  // namespace milepost::server
