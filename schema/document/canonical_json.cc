#include "schema/document/canonical_json.h"

#include <array>
#include <charconv>
#include <cmath>

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

using nlohmann::json;

// The fewest digits that restore a number, and its power of ten: 0.DIGITS * 10^exponent.
struct Decimal {
  std::string digits;
  int exponent = 0;
};

// REQUIRES: value > 0.
Decimal decimal_of(double value) {
  std::array<char, 32> text{};  // "1.2345e-67"
  const char* const end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific)
          .ptr;
  Decimal decimal;
  const char* at = text.data();
  for (; *at != 'e'; ++at) {
    if (*at != '.') decimal.digits += *at;
  }
  ++at;
  if (*at == '+') ++at;
  std::from_chars(at, end, decimal.exponent);
  ++decimal.exponent;
  return decimal;
}

// As ECMAScript writes numbers (ECMA-262, Number::toString).
std::string number_text(double value) {
  if (value == 0) return "0";
  const std::string sign = value < 0 ? "-" : "";
  const auto [digits, exponent] = decimal_of(std::abs(value));
  const int count = static_cast<int>(digits.size());
  if (exponent > 21 || exponent <= -6) {
    const std::string fraction = count > 1 ? "." + digits.substr(1) : "";
    return sign + digits.front() + fraction + (exponent > 0 ? "e+" : "e-") +
           std::to_string(std::abs(exponent - 1));
  }
  if (exponent <= 0) return sign + "0." + std::string(-exponent, '0') + digits;
  if (count <= exponent) return sign + digits + std::string(exponent - count, '0');
  return sign + digits.substr(0, exponent) + "." + digits.substr(exponent);
}

std::string string_text(const json& text) {
  return text.dump(-1, ' ', false, json::error_handler_t::replace);
}

void append(std::string& text, const json& value) {
  const char* separator = "";
  if (value.is_object()) {
    text += '{';
    for (const auto& [name, member] : value.items()) {
      text += separator + string_text(name) + ':';
      append(text, member);
      separator = ",";
    }
    text += '}';
  } else if (value.is_array()) {
    text += '[';
    for (const json& member : value) {
      text += separator;
      append(text, member);
      separator = ",";
    }
    text += ']';
  } else if (value.is_number_float()) {
    text += number_text(value.get<double>());
  } else {
    text += string_text(value);
  }
}

}  // namespace

std::string canonical_json(const nlohmann::json& value) {
  std::string text;
  append(text, value);
  return text;
}

}  // namespace milepost
