// Numbers and words that the reports share.
#pragma once

#include <string>
#include <vector>

namespace milepost {

// How far a scale must reach for values that are no outliers: the greatest, but at most 2.5 times
// the 90th percentile, which is four sigmas of a normal distribution; and a little headroom. 0
// without a finite value.
double robust_reach(std::vector<double> magnitudes);

// "0.063 m", "0.21 m", "1.30 m": two digits that matter.
std::string metres(double value);
// "1 frame", "2 frames".
std::string counted(std::size_t count, const std::string& noun);
// "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& words);

}  // namespace milepost
