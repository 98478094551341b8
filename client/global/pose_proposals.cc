#include "client/global/pose_proposals.h"

#include <cmath>
#include <numbers>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

constexpr double kHeadingSigmaRad = 3 * kRadPerDeg;
constexpr double kAgreesRad = 1 * kRadPerDeg;
constexpr int kMaxTurns = 4;
constexpr int kBeams = 2;

template <class Value>
const Value& any_of(std::span<const Value> values, Random& random) {
  std::uniform_int_distribution<std::size_t> index(0, values.size() - 1);
  return values[index(random)];
}

// Rotates the pose so that a visible wall has an observed orientation.
Pose2 turned_to_walls(Pose2 pose, std::span<const ViewSection> sections,
                      const RayCastingGrid& walls, double reach_m, Random& random) {
  const ViewSection& section = any_of(sections, random);
  const double observed_rad = any_of(std::span<const double>(section.orientations_rad), random);
  // After a rotation another wall may be visible.
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

// Moves the pose perpendicular to the wall that a beam hits, so that the beam ends there.
Pose2 moved_to_fit(const Pose2& pose, const Beam& beam, const RayCastingGrid& walls,
                   const PlanBox& area, double reach_m) {
  const Eigen::Vector2d direction = direction_of(pose.heading_rad + beam.bearing_rad);
  const auto hit = walls.first_hit(pose.enu_m, direction, reach_m);
  if (!hit) return pose;
  const PlanWall& wall = walls.walls()[hit->wall];
  const Eigen::Vector2d along = (wall.end_m - wall.begin_m).normalized();
  const Eigen::Vector2d normal(along.y(), -along.x());
  Pose2 fitting = pose;
  fitting.enu_m += (hit->range_m - beam.range_m) * direction.dot(normal) * normal;
  const bool is_possible =
      area.contains(fitting.enu_m) && !walls.is_crossed(pose.enu_m, fitting.enu_m);
  return is_possible ? fitting : pose;
}

}  // namespace

Pose2 proposed_pose(const WallObservation& observation, const RayCastingGrid& walls,
                    const PlanBox& area, double reach_m, Random& random) {
  Pose2 pose =
      turned_to_walls(uniform_pose(area, random), observation.sections, walls, reach_m, random);
  if (observation.beams.empty()) return pose;
  for (int i = 0; i < kBeams; ++i) {
    const Beam& beam = any_of(std::span<const Beam>(observation.beams), random);
    pose = moved_to_fit(pose, beam, walls, area, reach_m);
  }
  return pose;
}

ParticleSet proposed_particles(std::size_t count, const WallObservation& observation,
                               const RayCastingGrid& walls, const PlanBox& area, double reach_m,
                               Random& random) {
  ParticleSet particles(count);
  for (Particle& particle : particles) {
    particle = {proposed_pose(observation, walls, area, reach_m, random),
                1.0 / static_cast<double>(count)};
  }
  return particles;
}

}  // namespace milepost
