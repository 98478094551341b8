#include "mapper/fusion/matching.h"

#include <cmath>

namespace milepost {

ComparedLandmark compared(const MappedLandmark& landmark, const LocalFrame& local) {
  const EnuPoint at = local.enu_from_geo(landmark.position);
  return {{at.east_m, at.north_m, at.up_m},
          landmark.covariance_m2,
          std::log(landmark.size_m),
          root_sift(landmark.descriptor)};
}

double squared_distance(const RootSift& a, const RootSift& b) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int off = a[i] - b[i];
    sum += static_cast<std::int64_t>(off) * off;
  }
  constexpr double kUnits = kRootSiftUnits;
  return static_cast<double>(sum) / (kUnits * kUnits);
}

bool are_of_one_size(const ComparedLandmark& a, const ComparedLandmark& b) {
  constexpr double kMaxLogRatio = 0.35;
  return std::abs(a.log_size - b.log_size) <= kMaxLogRatio;
}

}  // namespace milepost
