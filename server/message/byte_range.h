// Requests for a part of a body (RFC 9110, section 14).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace milepost::server {

struct ByteRange {
  std::uint64_t first = 0;
  std::uint64_t bytes = 0;
};

// What a Range field asks for of a body of `size` bytes.
struct RangeRequest {
  // whole: no field, another unit than bytes, several ranges, or not as RFC 9110 has it.
  enum class Kind { whole, part, beyond };
  Kind kind = Kind::whole;
  ByteRange part = {};  // not empty, and within the body
};
RangeRequest parse_range(std::string_view field, std::uint64_t size);

// Whether a part may be sent: an If-Range field, empty if absent, names `tag` and nothing else.
bool allows_part(std::string_view if_range, std::string_view tag);

}  // namespace milepost::server
