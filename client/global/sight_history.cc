#include "client/global/sight_history.h"

#include <cmath>

#include <Eigen/Geometry>

namespace milepost {

bool SightHistory::add(const WallObservation& observation, const WheelMotion& motion) {
  driven_ = moved(driven_, motion.distance_m, motion.turn_rad);
  driven_m_ += std::abs(motion.distance_m);
  since_last_m_ += std::abs(motion.distance_m);
  if (observation.beams.empty()) return false;
  if (!sights_.empty() && since_last_m_ < settings_.step_m) return false;
  WallObservation thinned{observation.sections, {}};
  for (std::size_t i = 0; i < observation.beams.size(); i += settings_.each_beam) {
    thinned.beams.push_back(observation.beams[i]);
  }
  sights_.push_back({std::move(thinned), since_last_m_, driven_m_, driven_});
  since_last_m_ = 0;
  while (sights_.front().driven_m < driven_m_ - settings_.way_m) sights_.pop_front();
  return true;
}

PlanPose SightHistory::pose_then(const PlanPose& now, double wheel_scale,
                                 const PastSight& sight) const {
  // Headings are clockwise, Eigen's rotations are not.
  const double turned_rad = now.heading_rad - driven_.heading_rad;
  const Eigen::Rotation2Dd enu_from_driven(-turned_rad);
  return {now.enu_m + wheel_scale * (enu_from_driven * (sight.driven.enu_m - driven_.enu_m)),
          sight.driven.heading_rad + turned_rad};
}

}  // namespace milepost
