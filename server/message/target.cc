#include "server/message/target.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace milepost::server {
namespace {

Error wrong(const std::string& where, const std::string& what, const std::string& hint) {
  return {ErrorCode::invalid_input, where, what, hint};
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

// The byte that "%XX" at the start of `text` stands for, or -1.
int escaped_byte(std::string_view text) {
  unsigned value = 0;
  if (text.size() < 3) return -1;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 3, value, 16);
  return error == std::errc() && end == text.data() + 3 ? static_cast<int>(value) : -1;
}

Result<std::string> percent_decoded(std::string_view text, const std::string& where) {
  std::string decoded;
  while (!text.empty()) {
    char c = text.front();
    std::size_t length = 1;
    if (c == '%') {
      const int byte = escaped_byte(text);
      if (byte < 0) {
        return wrong(where, "'" + std::string(text.substr(0, 3)) + "' is not a percent-encoding",
                     "write % and two hexadecimal digits, and %25 for the sign itself");
      }
      c = static_cast<char>(byte);
      length = 3;
    }
    if (is_control(c)) return wrong(where, "holds a control byte", "leave it out");
    decoded += c;
    text.remove_prefix(length);
  }
  return decoded;
}

// Removes "http://host" from the absolute form.
std::string_view origin_form(std::string_view target) {
  const std::size_t scheme = target.find("://");
  if (target.starts_with('/') || scheme == std::string_view::npos) return target;
  const std::size_t path = target.find_first_of("/?", scheme + 3);
  return path == std::string_view::npos ? "/" : target.substr(path);
}

Result<std::vector<std::string>> parse_path(std::string_view path) {
  if (!path.starts_with('/')) {
    return wrong("path", "does not start with '/'", "request a path such as /v1/maps");
  }
  std::vector<std::string> segments;
  for (const std::string_view part : split(path.substr(1), '/')) {
    Result<std::string> segment = percent_decoded(part, "path");
    if (!segment) return segment.error();
    if (*segment == "." || *segment == "..") {
      return wrong("path", "holds the segment '" + *segment + "'", "write the path out");
    }
    segments.push_back(std::move(*segment));
  }
  return segments;
}

}  // namespace

Result<Query> Query::parse(std::string_view text) {
  Query query;
  if (text.empty()) return query;
  for (const std::string_view part : split(text, '&')) {
    const std::size_t equals = std::min(part.find('='), part.size());
    Result<std::string> name = percent_decoded(part.substr(0, equals), "query");
    if (!name) return name.error();
    const std::string_view rest = part.substr(std::min(equals + 1, part.size()));
    Result<std::string> value = percent_decoded(rest, "parameter " + *name);
    if (!value) return value.error();
    query.pairs_.emplace_back(std::move(*name), std::move(*value));
  }
  return query;
}

Status Query::allow_only(const std::vector<std::string_view>& names) const {
  for (auto pair = pairs_.begin(); pair != pairs_.end(); ++pair) {
    const std::string& name = pair->first;
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      std::string known;
      for (const std::string_view n : names) known.append(known.empty() ? "" : ", ").append(n);
      return wrong("parameter '" + name + "'", "is unknown here",
                   known.empty() ? "this path takes no parameters" : "known are " + known);
    }
    const auto same = [&name](const auto& other) { return other.first == name; };
    if (std::any_of(std::next(pair), pairs_.end(), same)) {
      return wrong("parameter " + name, "is given more than once", "give it once");
    }
  }
  return ok_status();
}

Result<std::string> Query::text(std::string_view name) const {
  const auto found = std::find_if(pairs_.begin(), pairs_.end(),
                                  [name](const auto& pair) { return pair.first == name; });
  if (found == pairs_.end()) {
    return wrong("parameter " + std::string(name), "is missing", "add " + std::string(name) + "=");
  }
  return found->second;
}

Result<double> Query::number(std::string_view name) const {
  const Result<std::string> value = text(name);
  if (!value) return value.error();
  return parse_number(*value, "parameter " + std::string(name));
}

Result<Target> Target::parse(std::string_view target) {
  const std::string_view text = origin_form(target);
  const std::size_t mark = std::min(text.find('?'), text.size());
  Result<std::vector<std::string>> path = parse_path(text.substr(0, mark));
  if (!path) return path.error();
  Result<Query> query = Query::parse(text.substr(std::min(mark + 1, text.size())));
  if (!query) return query.error();
  return Target{std::move(*path), std::move(*query)};
}

Result<double> parse_number(std::string_view text, const std::string& where) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || std::isnan(value)) {
    return wrong(where, "is '" + std::string(text) + "', not a number", "write a number");
  }
  return value;
}

}  // namespace milepost::server
