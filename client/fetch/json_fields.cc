#include "client/fetch/json_fields.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr std::size_t kMaxNameBytes = 255;

const Json kAbsent;
const Json kNoArray = Json::array();
const Json kNoObject = Json::object();

}  // namespace

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= kMaxNameBytes &&
         std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) >= 0x20; });
}

Json JsonFields::parsed(std::string_view text) {
  Result<Json> json = read_ordered_json(text);
  if (json && json->is_object()) return std::move(*json);
  fail(json ? "the document is not a JSON object" : "the document: " + json.error().what);
  return Json::object();
}

double JsonFields::number(const Json& object, const char* key, double min, double max) {
  return checked(field(object, key), key, min, max);
}

double JsonFields::number_at(const Json& array, std::size_t index, double min, double max) {
  const bool there = array.is_array() && index < array.size();
  return checked(there ? array[index] : kAbsent, "member " + std::to_string(index), min, max);
}

double JsonFields::checked(const Json& value, const std::string& name, double min, double max) {
  if (!value.is_number()) {
    fail("\"" + name + "\" is not a number");
    return min;
  }
  const double number = value.get<double>();
  if (number >= min && number <= max) return number;  // false for NaN
  fail("\"" + name + "\" is out of range");
  return min;
}

std::uint64_t JsonFields::whole(const Json& object, const char* key, std::uint64_t max) {
  const Json& value = field(object, key);
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= max) {
    return value.get<std::uint64_t>();
  }
  fail(std::string("\"") + key + "\" is not an integer in range");
  return 0;
}

std::string JsonFields::text(const Json& object, const char* key) {
  const Json& value = field(object, key);
  if (value.is_string() && is_name(value.get_ref<const std::string&>())) {
    return value.get<std::string>();
  }
  fail(std::string("\"") + key + "\" is not a valid name");
  return "";
}

const Json& JsonFields::array(const Json& object, const char* key) {
  const Json& value = field(object, key);
  if (value.is_array()) return value;
  fail(std::string("\"") + key + "\" is not a list");
  return kNoArray;
}

const Json& JsonFields::object(const Json& object, const char* key) {
  const Json& value = field(object, key);
  if (value.is_object()) return value;
  fail(std::string("\"") + key + "\" is not an object");
  return kNoObject;
}

const Json& JsonFields::field(const Json& object, const char* key) {
  if (!object.is_object()) return kAbsent;
  const auto found = object.find(key);
  return found == object.end() ? kAbsent : *found;
}

void JsonFields::fail(const std::string& what) {
  if (!error_.has_value()) {
    error_ = Error{ErrorCode::corrupt, where_, what, "check that a milepost server answers there"};
  }
}

}  // namespace milepost
