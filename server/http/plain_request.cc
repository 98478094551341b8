#include "server/http/plain_request.h"

#include <array>
#include <cstdint>
#include <utility>

#include "server/message/letters.h"

namespace milepost::server {
namespace {

enum : std::uint8_t { kTargetByte = 1, kNameByte = 2, kValueByte = 4 };

// A subset of what RFC 9112 allows in each place.
constexpr std::array<std::uint8_t, 256> classes() {
  std::array<std::uint8_t, 256> table{};
  for (unsigned c = 0x20; c < 0x7f; ++c) table[c] = kValueByte;
  for (unsigned c = 'a'; c <= 'z'; ++c) table[c] |= kTargetByte | kNameByte;
  for (unsigned c = 'A'; c <= 'Z'; ++c) table[c] |= kTargetByte | kNameByte;
  for (unsigned c = '0'; c <= '9'; ++c) table[c] |= kTargetByte | kNameByte;
  for (const char c : std::string_view("/?=&,.-_~%+:")) {
    table[static_cast<unsigned char>(c)] |= kTargetByte;
  }
  for (const char c : std::string_view("-_")) table[static_cast<unsigned char>(c)] |= kNameByte;
  return table;
}

constexpr std::array<std::uint8_t, 256> kClasses = classes();

// Removes and returns the longest beginning of bytes of a class.
std::string_view take_run(std::string_view& text, std::uint8_t wanted) {
  std::size_t length = 0;
  while (length < text.size() && (kClasses[static_cast<unsigned char>(text[length])] & wanted)) {
    ++length;
  }
  const std::string_view run = text.substr(0, length);
  text.remove_prefix(length);
  return run;
}

bool take_text(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

// Fields that change where a request ends, or what it asks of the connection.
bool is_of_framing(std::string_view name) {
  switch (name.size()) {
    case 2:
      return equals_lower(name, "te");
    case 6:
      return equals_lower(name, "expect");
    case 7:
      return equals_lower(name, "upgrade") || equals_lower(name, "trailer");
    case 14:
      return equals_lower(name, "content-length");
    case 16:
      return equals_lower(name, "proxy-connection");
    case 17:
      return equals_lower(name, "transfer-encoding");
    default:
      return false;
  }
}

// The member of a request that has the value of a field; null if none has.
std::string Request::*member_for(std::string_view name) {
  switch (name.size()) {
    case 5:
      return equals_lower(name, "range") ? &Request::range : nullptr;
    case 6:
      return equals_lower(name, "origin") ? &Request::origin : nullptr;
    case 8:
      return equals_lower(name, "if-range") ? &Request::if_range : nullptr;
    case 13:
      if (equals_lower(name, "if-none-match")) return &Request::if_none_match;
      return equals_lower(name, "authorization") ? &Request::authorization : nullptr;
    case 15:
      return equals_lower(name, "accept-encoding") ? &Request::accept_encoding : nullptr;
    default:
      return nullptr;
  }
}

// What the fields of a request say, each at most once.
struct PlainFields {
  bool host = false;
  bool connection = false;

  // False if the request is not plain.
  bool take(std::string_view name, std::string_view value, Incoming& incoming) {
    if (equals_lower(name, "host")) return !std::exchange(host, true);
    if (std::string Request::*member = member_for(name)) {
      std::string& taken = incoming.request.*member;
      if (!taken.empty() || value.empty()) return false;
      taken = value;
      return true;
    }
    if (equals_lower(name, "connection")) {
      incoming.keep_alive = equals_lower(value, "keep-alive");
      return !std::exchange(connection, true) &&
             (incoming.keep_alive || equals_lower(value, "close"));
    }
    return !is_of_framing(name);
  }
};

void clear_fields(Request& request) {
  for (std::string* field : {&request.if_none_match, &request.if_range, &request.range,
                             &request.accept_encoding, &request.authorization, &request.origin}) {
    field->clear();
  }
}

bool take_request_line(std::string_view& rest, Incoming& incoming) {
  if (take_text(rest, "GET ")) {
    incoming.request.method = "GET";
  } else if (take_text(rest, "HEAD ")) {
    incoming.request.method = "HEAD";
  } else {
    return false;
  }
  if (!rest.starts_with('/')) return false;
  incoming.request.target = take_run(rest, kTargetByte);
  return take_text(rest, " HTTP/1.1\r\n");
}

bool take_field(std::string_view& rest, PlainFields& fields, Incoming& incoming) {
  const std::string_view name = take_run(rest, kNameByte);
  if (name.empty() || !take_text(rest, ":")) return false;
  std::string_view value = take_run(rest, kValueByte);
  if (!take_text(rest, "\r\n")) return false;
  while (value.starts_with(' ')) value.remove_prefix(1);
  while (value.ends_with(' ')) value.remove_suffix(1);
  return fields.take(name, value, incoming);
}

}  // namespace

std::size_t take_plain_request(std::string_view bytes, const ConnectionLimits& limits,
                               Incoming& incoming) {
  std::string_view rest = bytes;
  clear_fields(incoming.request);
  incoming.http_version = 11;
  incoming.keep_alive = true;
  incoming.refusal.reset();
  if (!take_request_line(rest, incoming)) return 0;
  PlainFields fields;
  while (!take_text(rest, "\r\n")) {
    if (!take_field(rest, fields, incoming)) return 0;
  }
  const std::size_t length = bytes.size() - rest.size();
  return fields.host && length <= limits.header_bytes ? length : 0;
}

}  // namespace milepost::server
