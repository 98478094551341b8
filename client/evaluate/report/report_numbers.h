// Numbers and words that the reports share.
#pragma once

#include <string>
#include <vector>

namespace milepost {

// For readers: "0.25", with a true minus sign; an en dash for what is not finite.
std::string number(double value, int decimals);
// The same with a plus sign before what rounds to more than zero.
std::string signed_number(double value, int decimals);

// "0.063 m", "0.21 m", "1.30 m": two digits that matter.
std::string metres(double value);
// "1 frame", "2 frames".
std::string counted(std::size_t count, const std::string& noun);
// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& words);

// How far a scale must reach for values that are no outliers: the greatest, but at most 2.5 times
// the 90th percentile, which is four sigmas of a normal distribution; and a little headroom. 0
// without a finite value.
double robust_reach(std::vector<double> magnitudes);

// 1, 2 or 5 times a power of ten.
struct RoundStep {
  double length = 0;
  int decimals = 0;  // that tell its multiples apart
};

// The least that is not shorter than a length. REQUIRES: the length is positive and finite.
RoundStep round_step(double least);
// The least multiple of a round step that is not below `reach`, of about `steps` steps from zero; 1
// where the reach is not positive and finite.
double rounded_up(double reach, int steps);

}  // namespace milepost
