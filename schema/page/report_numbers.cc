#include "schema/page/report_numbers.h"

#include <algorithm>
#include <cmath>

#include "schema/base/digits.h"

namespace milepost {
namespace {

constexpr double kRounding = 1e-9;  // tolerance of rounding errors in a step

}  // namespace

std::string number(double value, int decimals) {
  if (!std::isfinite(value)) return "\u2013";
  const std::string digits = fixed(std::abs(value), decimals);
  const bool is_zero = digits.find_first_of("123456789") == std::string::npos;
  return value < 0 && !is_zero ? "\u2212" + digits : digits;
}

std::string signed_number(double value, int decimals) {
  const std::string text = number(value, decimals);
  const bool is_positive =
      value > 0 && std::isfinite(value) && text.find_first_of("123456789") != std::string::npos;
  return is_positive ? "+" + text : text;
}

std::string metres(double value) {
  // The decimals depend on the printed number: 0.0996 is 0.10.
  return number(value, std::abs(value) < 0.0995 ? 3 : 2) + "\u00A0m";
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

RoundStep round_step(double least) {
  const double exponent = std::floor(std::log10(least));
  const double power = std::pow(10, exponent);
  for (const double digit : {1, 2, 5}) {
    if (digit * power < least * (1 - kRounding)) continue;
    return {digit * power, std::max(0, static_cast<int>(-exponent))};
  }
  return {10 * power, std::max(0, static_cast<int>(-exponent) - 1)};
}

double rounded_up(double reach, int steps) {
  if (!std::isfinite(reach) || reach <= 0) return 1;
  const double step = round_step(reach / steps).length;
  return step * std::ceil(reach / step - kRounding);
}

}  // namespace milepost
