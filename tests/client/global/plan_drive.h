// Simulated drives in a plan of streets: observations are ray cast from the walls, with noise.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "client/global/plan_filter.h"
#include "tests/client/global/plan_rooms.h"

namespace milepost::testing {

inline constexpr double kStepM = 1.5;
inline constexpr double kStepS = 0.2;

struct Step {
  Pose2 truth;
  OdometryIncrement motion;
  WallObservation observation;
};

// Beams every 3 degrees that end at a wall within 50 m, three in four of them inliers, and the
// orientations of walls.
inline WallObservation seen_at(const Pose2& pose, const RayCastingGrid& walls, Random& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> chance(0, 1);
  WallObservation observation;
  for (double bearing = -0.7; bearing < 0.7; bearing += 0.05) {
    const auto hit = walls.first_hit(pose.enu_m, direction_of(pose.heading_rad + bearing), 50);
    if (!hit) continue;
    const double part = chance(random) < 0.75 ? 1 + 0.02 * normal(random) : chance(random);
    observation.beams.push_back({bearing, hit->range_m * part, 0.02 * hit->range_m});
    const double orientation_rad = walls.walls()[hit->wall].azimuth_rad() - pose.heading_rad;
    observation.sections.push_back(
        {{bearing - 0.025, bearing + 0.025}, {orientation_rad + 0.02 * normal(random)}});
  }
  return observation;
}

class PlanDriveTest : public ::testing::Test {
 protected:
  // Drives straight or turning evenly. Odometry has a scale error, and so have the ranges
  // triangulated with it.
  void drive(int steps, double turn_rad = 0) {
    std::normal_distribution<double> normal;
    for (int i = 0; i < steps; ++i) {
      const double turn = turn_rad / steps;
      pose_ = moved(pose_, kStepM, turn);
      const double odometry_m = kStepM * (has_odometry_ + 0.02 * normal(random_));
      Step step{pose_,
                {kStepS, odometry_m, turn + 0.003 * normal(random_)},
                seen_at(pose_, walls_, random_)};
      for (Beam& beam : step.observation.beams) beam.range_m *= has_odometry_;
      steps_.push_back(std::move(step));
    }
  }

  // Along the street and around the corner to the east.
  void drive_round_the_corner() {
    drive(62);
    drive(10, std::numbers::pi / 2);
    drive(40);
  }

  struct Outcome {
    int found = 0;  // frames
    int wrong = 0;  // of these, more than 5 m away
    double last_error_m = 0;
    GlobalStatus last = GlobalStatus::initializing;
    BeliefMode mode;
  };

  Outcome run(const MakePlanFilter& make_filter, const FilterSettings& settings,
              const RayCastingGrid& walls) const {
    PlanBox area = walls.bounds();
    area.min_m.array() -= 10;
    area.max_m.array() += 10;
    const std::unique_ptr<PlanFilter> filter = make_filter(walls, area, settings);
    Outcome outcome;
    for (const Step& step : steps_) {
      const PlanEstimate found = filter->update(step.observation, step.motion);
      outcome.last = found.status;
      outcome.mode = found.mode;
      outcome.last_error_m = (found.mode.pose.enu_m - step.truth.enu_m).norm();
      if (found.status != GlobalStatus::tracking) continue;
      ++outcome.found;
      outcome.wrong += outcome.last_error_m > 5 ? 1 : 0;
    }
    return outcome;
  }

  static FilterSettings seeded(std::uint64_t seed) {
    FilterSettings settings;
    settings.seed = seed;
    return settings;
  }

  RayCastingGrid walls_{testing::bent_street()};
  Random random_{11};
  Pose2 pose_{{1, 3}, 0};
  double has_odometry_ = 1.01;  // metres of odometry per metre
  std::vector<Step> steps_;
};

}  // namespace milepost::testing
