// Reads and validates the fields of a JSON document from an untrusted source; keeps the first
// error.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "schema/base/json.h"
#include "schema/base/result.h"

namespace milepost {

using Json = nlohmann::ordered_json;

// After a field that is absent, of the wrong type or out of range, all getters return harmless
// values: read all fields, then check error() once.
class JsonFields {
 public:
  // `where` (a URL or a file) is used in the error message.
  explicit JsonFields(std::string where) : where_(std::move(where)) {}

  // Parses a text that must be a JSON object within JsonLimits; an empty object otherwise.
  Json parsed(std::string_view text);
  // A finite number in [min, max].
  double number(const Json& object, const char* key, double min, double max);
  // The same for a member of an array.
  double number_at(const Json& array, std::size_t index, double min, double max);
  std::uint64_t whole(const Json& object, const char* key, std::uint64_t max);
  // A string that satisfies is_name().
  std::string text(const Json& object, const char* key);
  const Json& array(const Json& object, const char* key);
  const Json& object(const Json& object, const char* key);

  // Records an error, unless there is one already.
  void fail(const std::string& what);
  bool ok() const { return !error_.has_value(); }
  // The first error, corrupt. REQUIRES: !ok().
  const Error& error() const { return *error_; }

 private:
  double checked(const Json& value, const std::string& name, double min, double max);
  const Json& field(const Json& object, const char* key);

  std::string where_;
  std::optional<Error> error_;
};

// Whether a string is a valid name: not empty, at most 255 bytes, no control characters.
bool is_name(std::string_view text);

}  // namespace milepost
