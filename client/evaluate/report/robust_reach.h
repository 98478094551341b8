// The scale of plots of errors.
#pragma once

#include <vector>

namespace milepost {

// The range of a scale that ignores outliers: the largest value, at most 2.5 times the 90th
// percentile (four sigmas of a normal distribution), plus some headroom. 0 without finite values.
double robust_reach(std::vector<double> magnitudes);

}  // namespace milepost
