// JSON that comes from outside: documents of a server, parameters in a map, files of the user. Its
// size is bounded before anything is allocated for it, so that no text can exhaust the memory or
// the stack of those who walk through it.
#pragma once

#include <cstddef>
#include <string_view>

#include <nlohmann/json.hpp>

#include "schema/base/result.h"

namespace milepost {

struct JsonLimits {
  std::size_t bytes = 64U << 20U;  // of the text
  std::size_t values = 8'000'000;  // numbers, texts, lists, objects and their kin, all together
  std::size_t depth = 32;          // lists and objects within each other
  std::size_t members = 4096;      // of one object
};

// The value of a text that is one JSON value (RFC 8259, UTF-8; numbers must fit a double).
// Errors: corrupt; `where` is "byte N" (the first is 1) if the text is not JSON, and empty if it
// is beyond a limit.
Result<nlohmann::json> read_json(std::string_view text, const JsonLimits& limits = {});

// The same; the members of objects keep the order of the text.
Result<nlohmann::ordered_json> read_ordered_json(std::string_view text,
                                                 const JsonLimits& limits = {});

}  // namespace milepost
