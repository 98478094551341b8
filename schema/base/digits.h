// Locale-independent formatting of numbers.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <concepts>
#include <string>

namespace milepost {

namespace internal {

// The longest double in fixed notation has 309 digits before the point, the shortest 326
// characters.
template <std::floating_point Number, class... How>
std::string digits(Number value, How... how) {
  std::array<char, 400> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value, how...).ptr};
}

}  // namespace internal

// The shortest text that parses to the same number: 0.1, 1e+20.
template <std::floating_point Number>
std::string shortest(Number value) {
  return internal::digits(value);
}

// Likewise, but never with an exponent, whose + is a space in a URL: 100000000000000000000.
template <std::floating_point Number>
std::string shortest_fixed(Number value) {
  return internal::digits(value, std::chars_format::fixed);
}

// Rounded to `decimals` decimal places, at most 20: 0.10.
inline std::string fixed(double value, int decimals) {
  return internal::digits(value, std::chars_format::fixed, std::min(decimals, 20));
}

}  // namespace milepost
