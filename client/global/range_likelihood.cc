#include "client/global/range_likelihood.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace milepost {

std::vector<Beam> beams_of(std::span<const ScenePoint> points,
                           const Eigen::Matrix3d& level_from_camera, const BeamSettings& settings) {
  std::map<int, std::vector<Beam>> bins;
  for (const ScenePoint& point : points) {
    const Eigen::Vector3d level_m = level_from_camera * point.camera_m;
    const Eigen::Vector2d plan_m(level_m.x(), level_m.z());
    const double range_m = plan_m.norm();
    if (-level_m.y() < settings.min_up_m || range_m > settings.max_range_m) continue;
    const double bearing_rad = std::atan2(plan_m.x(), plan_m.y());
    const double sigma_m = point.range_sigma_m * range_m / level_m.norm();
    bins[static_cast<int>(std::floor(bearing_rad / settings.bin_rad))].push_back(
        {bearing_rad, range_m, sigma_m});
  }
  std::vector<Beam> beams;
  for (auto& [bin, inside] : bins) {
    std::ranges::stable_sort(inside, {}, &Beam::range_sigma_m);
    inside.resize(std::min(inside.size(), settings.per_bin));
    beams.insert(beams.end(), inside.begin(), inside.end());
  }
  return beams;
}

RangeLikelihood range_likelihood(const Pose2& pose, double odometry_scale,
                                 std::span<const Beam> beams, const RayCastingGrid& walls,
                                 const RangeSettings& settings) {
  RangeLikelihood likelihood;
  for (const Beam& beam : beams) {
    const Eigen::Vector2d direction = direction_of(pose.heading_rad + beam.bearing_rad);
    const auto hit = walls.first_hit(pose.enu_m, direction, settings.reach_m);
    if (!hit) {
      likelihood.log_likelihood += std::log(settings.chance_nearer);
      continue;
    }
    // The residual is perpendicular to the wall: a grazing ray may hit it anywhere along it.
    const PlanWall& wall = walls.walls()[hit->wall];
    const Eigen::Vector2d along = (wall.end_m - wall.begin_m).normalized();
    const double cosine = direction.dot(along);
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double off_m = (odometry_scale * beam.range_m - hit->range_m) * sine;
    const double variance_m2 = std::pow(beam.range_sigma_m * sine, 2) +
                               std::pow(beam.range_m * settings.heading_sigma_rad * cosine, 2) +
                               wall.sigma_m * wall.sigma_m + settings.sigma_m * settings.sigma_m;
    const double fit = std::exp(-off_m * off_m / (2 * variance_m2));
    const double chance = off_m < 0 ? settings.chance_nearer : settings.chance_farther;
    likelihood.log_likelihood += std::log(chance + (1 - chance) * fit);
    if (off_m * off_m < 9 * variance_m2) likelihood.inlier_ratio += 1;
  }
  if (!beams.empty()) likelihood.inlier_ratio /= static_cast<double>(beams.size());
  return likelihood;
}

}  // namespace milepost
