// Formatting of numbers and lists in the reports.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace milepost {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// "0.25", with a typographic minus sign; an en dash if not finite.
std::string number(double value, int decimals);
// The same with a plus sign for numbers that round to more than zero.
std::string signed_number(double value, int decimals);

// "0.063 m", "0.21 m", "1.30 m": about two significant digits.
std::string metres(double value);
// "1 frame", "2 frames".
std::string counted(std::size_t count, const std::string& noun);
// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& words);

// 1, 2 or 5 times a power of ten.
struct RoundStep {
  double length = 0;
  int decimals = 0;  // that distinguish its multiples
};

// The smallest round step that is not shorter than a length. REQUIRES: the length is positive and
// finite.
RoundStep round_step(double least);
// The smallest multiple of a round step that is not below `reach`, for about `steps` steps from
// zero; 1 if the reach is not positive and finite.
double rounded_up(double reach, int steps);

}  // namespace milepost
