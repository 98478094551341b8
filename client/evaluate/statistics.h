// Statistics of errors and latencies.
#pragma once

#include <vector>

namespace milepost {

// The finite ones, in their order.
std::vector<double> finite_only(const std::vector<double>& values);

// The value below which that share of `ascending` lies, between neighbours in proportion.
// NaN without values.
double quantile(const std::vector<double>& ascending, double share);

// NaN without values.
double mean_of(const std::vector<double>& values);
// About the mean, of all values. NaN without values.
double deviation_of(const std::vector<double>& values);

}  // namespace milepost
