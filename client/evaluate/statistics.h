// Statistics of errors and latencies.
#pragma once

#include <vector>

namespace milepost {

// The finite values, in their order.
std::vector<double> finite_only(const std::vector<double>& values);

// The quantile at `share` in [0, 1], linearly interpolated. NaN without values. REQUIRES: ascending
// values.
double quantile(const std::vector<double>& ascending, double share);

// NaN without values.
double mean_of(const std::vector<double>& values);
// Population standard deviation. NaN without values.
double deviation_of(const std::vector<double>& values);

}  // namespace milepost
