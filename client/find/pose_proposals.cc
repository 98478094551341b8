#include "client/find/pose_proposals.h"

#include <cmath>
#include <numbers>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kHeadingSigmaRad = 3 * kRadPerDeg;
constexpr double kAgreesRad = 1 * kRadPerDeg;
constexpr int kMaxTurns = 4;

template <class Value>
const Value& any_of(std::span<const Value> values, Random& random) {
  std::uniform_int_distribution<std::size_t> index(0, values.size() - 1);
  return values[index(random)];
}

}  // namespace

PlanPose oriented_pose(std::span<const ViewSection> sections, const WallIndex& walls,
                       const PlanBox& area, double reach_m, Random& random) {
  PlanPose pose = uniform_pose(area, random);
  const ViewSection& section = any_of(sections, random);
  const double observed_rad = any_of(std::span<const double>(section.orientations_rad), random);
  // Having turned, it may look at another wall.
  for (int turns = 0; turns < kMaxTurns; ++turns) {
    const double azimuth_rad = pose.heading_rad + section.bearings.middle_rad();
    const auto hit = walls.first_hit(pose.enu_m, direction_of(azimuth_rad), reach_m);
    if (!hit) return pose;
    const double expected_rad = walls.walls()[hit->wall].azimuth_rad() - pose.heading_rad;
    const double turn_rad = std::remainder(expected_rad - observed_rad, std::numbers::pi);
    if (std::abs(turn_rad) < kAgreesRad) break;
    pose.heading_rad += turn_rad;
  }
  pose.heading_rad += std::normal_distribution<double>(0, kHeadingSigmaRad)(random);
  return pose;
}

ParticleCloud oriented_cloud(std::size_t count, std::span<const ViewSection> sections,
                             const WallIndex& walls, const PlanBox& area, double reach_m,
                             Random& random) {
  ParticleCloud cloud(count);
  for (Particle& particle : cloud) {
    particle = {oriented_pose(sections, walls, area, reach_m, random),
                1.0 / static_cast<double>(count)};
  }
  return cloud;
}

}  // namespace milepost
