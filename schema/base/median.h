// Statistics that a part of wrong values hardly changes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace milepost {

// The upper one of two middle values. REQUIRES: there are values.
inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// The standard deviation of normally distributed values, from the median of how far they are from
// theirs. REQUIRES: there are values.
inline double robust_sigma_of(const std::vector<double>& values) {
  constexpr double kSigmaPerMedian = 1.4826;
  const double middle = median_of(values);
  std::vector<double> off;
  off.reserve(values.size());
  for (const double value : values) off.push_back(std::abs(value - middle));
  return kSigmaPerMedian * median_of(std::move(off));
}

}  // namespace milepost
