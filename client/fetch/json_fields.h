// Reads the fields of a document that came from outside, and keeps the first thing wrong with it.
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

// After a field that is absent, of the wrong type or out of range, all getters go on with harmless
// values: read everything, then ask for error() once.
class JsonFields {
 public:
  // `where` (a URL or a file) goes into the error.
  explicit JsonFields(std::string where) : where_(std::move(where)) {}

  // The document of a text, which must be a JSON object within JsonLimits; an empty object
  // otherwise.
  Json parsed(std::string_view text);
  // A finite number in [min, max].
  double number(const Json& object, const char* key, double min, double max);
  // The same for a member of an array.
  double number_at(const Json& array, std::size_t index, double min, double max);
  std::uint64_t whole(const Json& object, const char* key, std::uint64_t max);
  // Not empty, of at most 255 bytes, without control characters.
  std::string text(const Json& object, const char* key);
  const Json& array(const Json& object, const char* key);
  const Json& object(const Json& object, const char* key);

  // Notes what is wrong, unless something was before.
  void fail(const std::string& what);
  bool ok() const { return !error_.has_value(); }
  // REQUIRES: !ok(). Corrupt.
  const Error& error() const { return *error_; }

 private:
  double checked(const Json& value, const std::string& name, double min, double max);
  const Json& field(const Json& object, const char* key);

  std::string where_;
  std::optional<Error> error_;
};

// The text of a name that came from outside; fails as JsonFields::text.
bool is_name(std::string_view text);

}  // namespace milepost
