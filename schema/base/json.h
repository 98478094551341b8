// Untrusted JSON: documents of a server, parameters in a map, files of the user. Sizes are checked
// before memory is allocated, so that no input can exhaust the memory, or the stack of code that
// traverses it.
#pragma once

#include <cstddef>
#include <string_view>

#include <nlohmann/json.hpp>

#include "schema/base/result.h"

namespace milepost {

struct JsonLimits {
  std::size_t bytes = 64U << 20U;  // of the text
  std::size_t values = 8'000'000;  // of all types, in total
  std::size_t depth = 32;          // nested arrays and objects
  std::size_t members = 4096;      // of one object
};

// Parses a text that is one JSON value (RFC 8259, UTF-8; numbers must fit a double).
// Errors: corrupt; `where` is "byte N" (the first is 1) if the text is not JSON, and empty if it
// exceeds a limit.
Result<nlohmann::json> read_json(std::string_view text, const JsonLimits& limits = {});

// The same; the members of objects keep the order of the text.
Result<nlohmann::ordered_json> read_ordered_json(std::string_view text,
                                                 const JsonLimits& limits = {});

}  // namespace milepost
