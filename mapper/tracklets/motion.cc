#include "mapper/tracklets/motion.h"

#include <algorithm>
#include <cmath>

namespace milepost {
namespace {

constexpr double kMaxGrowth = 1.5;  // of inverse depth between two frames, against noisy scales

}  // namespace

PredictedPosition predict_position(const Track& track, double along_m) {
  const Observation& before = track[track.size() - 2];
  const Observation& latest = track.back();
  const double growth = std::clamp(
      static_cast<double>(latest.feature.scale_px) / before.feature.scale_px, 1.0, kMaxGrowth);
  const double spacing = (along_m - latest.along_m) / (latest.along_m - before.along_m);
  const auto factor = static_cast<float>(spacing * growth * growth);
  const float dx_px = factor * (latest.feature.x_px - before.feature.x_px);
  const float dy_px = factor * (latest.feature.y_px - before.feature.y_px);
  return {latest.feature.x_px + dx_px, latest.feature.y_px + dy_px, std::hypot(dx_px, dy_px)};
}

}  // namespace milepost
