#include "mapper/landmarks/vehicles_ahead.h"

#include <algorithm>
#include <cmath>

namespace milepost {

double recession_px(const FeatureTrack& track, const std::vector<CameraPose>& poses,
                    const Pinhole& camera) {
  const CameraPose& first = poses[track.front().frame];
  const CameraPose& last = poses[track.back().frame];
  const Eigen::Vector3d motion = (last.enu_m - first.enu_m).normalized();
  const auto angle_to_motion = [&](const CameraPose& pose, const Eigen::Vector2d& pixel) {
    const Eigen::Vector3d ray =
        camera_from_enu(pose).transpose() * camera.unproject(pixel.x(), pixel.y());
    return std::atan2(ray.cross(motion).norm(), ray.dot(motion));
  };
  return camera.focal_px() *
         (angle_to_motion(first, track.front().pixel) - angle_to_motion(last, track.back().pixel));
}

void VehiclesAhead::add(const Place& place, double driven_m, std::size_t observations,
                        double recession_px) {
  if (driven_m < settings_.min_track_m || observations < settings_.min_observations) return;
  const double most_px = settings_.max_recession_a_m * driven_m * focal_px_;
  told_.push_back({place, recession_px > settings_.min_recession_px && recession_px < most_px});
}

// A vehicle draws away before it falls back, or after, or both.
bool VehiclesAhead::hold(const Place& place, double distance_m) const {
  if (distance_m < settings_.min_distance_m) return false;
  const double reach_m = settings_.reach_m;
  return recede(place, place.along_m - reach_m, place.along_m) ||
         recede(place, place.along_m, place.along_m + reach_m) ||
         recede(place, place.along_m - reach_m / 2, place.along_m + reach_m / 2);
}

// Whether enough of what was seen in one place in the image recedes.
bool VehiclesAhead::recede(const Place& place, double from_m, double to_m) const {
  const double reach_px = settings_.reach_focal * focal_px_;
  std::size_t all = 0;
  std::size_t receding = 0;
  for (const Told& told : told_) {
    if (told.place.along_m < from_m || told.place.along_m > to_m) continue;
    if ((told.place.pixel - place.pixel).norm() > reach_px) continue;
    ++all;
    if (told.recedes) ++receding;
  }
  return receding >= settings_.min_receding &&
         static_cast<double>(receding) >= settings_.min_part * static_cast<double>(all);
}

void VehiclesAhead::forget_before(double along_m) {
  std::erase_if(told_,
                [&](const Told& told) { return told.place.along_m < along_m - settings_.reach_m; });
}

}  // namespace milepost
