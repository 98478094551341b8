// Cells of the tables that the commands write.
#pragma once

#include <array>
#include <cstdio>
#include <optional>
#include <string>

namespace milepost {

inline std::string number(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

inline std::string number(const std::optional<double>& value, int digits) {
  return value ? number(*value, digits) : std::string();
}

}  // namespace milepost
