#include "client/global/measurement_window.h"

#include <cmath>

#include <Eigen/Geometry>

namespace milepost {

bool MeasurementWindow::add(const WallObservation& observation, const OdometryIncrement& motion) {
  driven_ = moved(driven_, motion.distance_m, motion.turn_rad);
  driven_m_ += std::abs(motion.distance_m);
  since_last_m_ += std::abs(motion.distance_m);
  if (observation.beams.empty()) return false;
  if (!measurements_.empty() && since_last_m_ < settings_.step_m) return false;
  WallObservation thinned{observation.sections, {}};
  for (std::size_t i = 0; i < observation.beams.size(); i += settings_.beam_stride) {
    thinned.beams.push_back(observation.beams[i]);
  }
  measurements_.push_back({std::move(thinned), since_last_m_, driven_m_, driven_});
  since_last_m_ = 0;
  while (measurements_.front().driven_m < driven_m_ - settings_.distance_m)
    measurements_.pop_front();
  return true;
}

Pose2 MeasurementWindow::pose_at(const Pose2& now, double odometry_scale,
                                 const PastMeasurement& past) const {
  // Headings are clockwise, Eigen's rotations counterclockwise.
  const double turned_rad = now.heading_rad - driven_.heading_rad;
  const Eigen::Rotation2Dd enu_from_driven(-turned_rad);
  return {now.enu_m + odometry_scale * (enu_from_driven * (past.driven.enu_m - driven_.enu_m)),
          past.driven.heading_rad + turned_rad};
}

}  // namespace milepost
