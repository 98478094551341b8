// A closed interval of arc length (`along_m`) on one segment.
#pragma once

#include <algorithm>

namespace milepost {

struct AlongRange {
  double from_m = 0;
  double to_m = 0;  // >= from_m

  bool meets(const AlongRange& other) const { return from_m <= other.to_m && other.from_m <= to_m; }
  bool contains(double along_m) const { return from_m <= along_m && along_m <= to_m; }
  double middle_m() const { return (from_m + to_m) / 2; }
  AlongRange shifted(double by_m) const { return {from_m + by_m, to_m + by_m}; }
  AlongRange widened(double by_m) const { return {from_m - by_m, to_m + by_m}; }
  AlongRange joined(const AlongRange& other) const {
    return {std::min(from_m, other.from_m), std::max(to_m, other.to_m)};
  }
};

}  // namespace milepost
