#include "schema/document/canonical_json.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace milepost {
namespace {

using nlohmann::json;

// The fewest digits that restore a number, and its power of ten: 0.DIGITS * 10^exponent.
struct Decimal {
  std::array<char, 24> all{};
  int count = 0;
  int exponent = 0;

  std::string_view digits(int from, int to) const {
    return {all.data() + from, static_cast<std::size_t>(to - from)};
  }
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
    if (*at != '.') decimal.all.at(decimal.count++) = *at;
  }
  ++at;
  if (*at == '+') ++at;
  std::from_chars(at, end, decimal.exponent);
  ++decimal.exponent;
  return decimal;
}

template <class Integer>
void append_integer(std::string& text, Integer value) {
  std::array<char, 24> digits{};
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

// As ECMAScript writes numbers (ECMA-262, Number::toString).
void append_number(std::string& text, double value) {
  if (value == 0) {
    text += '0';
    return;
  }
  if (value < 0) text += '-';
  const Decimal decimal = decimal_of(std::abs(value));
  const auto [count, exponent] = std::pair(decimal.count, decimal.exponent);
  if (exponent > 21 || exponent <= -6) {
    text += decimal.all.front();
    if (count > 1) text.append(".").append(decimal.digits(1, count));
    text += exponent > 0 ? "e+" : "e-";
    append_integer(text, std::abs(exponent - 1));
  } else if (exponent <= 0) {
    text.append("0.").append(-exponent, '0').append(decimal.digits(0, count));
  } else if (count <= exponent) {
    text.append(decimal.digits(0, count)).append(exponent - count, '0');
  } else {
    text.append(decimal.digits(0, exponent)).append(".").append(decimal.digits(exponent, count));
  }
}

// Whether a string is written as it is.
bool is_plain(std::string_view text) {
  return std::ranges::all_of(text,
                             [](char c) { return c >= ' ' && c < 0x7f && c != '"' && c != '\\'; });
}

void append_string(std::string& text, const std::string& value) {
  if (is_plain(value)) {
    text.append("\"").append(value).append("\"");
  } else {
    text += json(value).dump(-1, ' ', false, json::error_handler_t::replace);
  }
}

void append(std::string& text, const json& value) {
  const char* separator = "";
  switch (value.type()) {
    case json::value_t::object:
      text += '{';
      for (const auto& [name, member] : value.get_ref<const json::object_t&>()) {
        text += separator;
        append_string(text, name);
        text += ':';
        append(text, member);
        separator = ",";
      }
      text += '}';
      break;
    case json::value_t::array:
      text += '[';
      for (const json& member : value) {
        text += separator;
        append(text, member);
        separator = ",";
      }
      text += ']';
      break;
    case json::value_t::string:
      append_string(text, value.get_ref<const std::string&>());
      break;
    case json::value_t::number_float:
      append_number(text, value.get<double>());
      break;
    case json::value_t::number_integer:
      append_integer(text, value.get<std::int64_t>());
      break;
    case json::value_t::number_unsigned:
      append_integer(text, value.get<std::uint64_t>());
      break;
    default:
      text += value.dump();
  }
}

}  // namespace

std::string canonical_json(const nlohmann::json& value) {
  std::string text;
  append(text, value);
  return text;
}

}  // namespace milepost
