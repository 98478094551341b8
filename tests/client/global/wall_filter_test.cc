// The filter in a plan of streets: what a vehicle sees there is cast from the walls, with noise.
#include "client/global/wall_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "schema/geo/geodesy.h"
#include "tests/client/global/plan_rooms.h"

namespace milepost {
namespace {

constexpr double kStepM = 1.5;
constexpr double kStepS = 0.2;

struct Step {
  PlanPose truth;
  WheelMotion motion;
  WallObservation observation;
};

// Beams each 3 degrees that end at a wall within 50 m, three in four of them rightly, and the
// orientations of walls.
WallObservation seen_at(const PlanPose& pose, const WallIndex& walls, Random& random) {
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

class WallFilterTest : public ::testing::Test {
 protected:
  // On along a heading for so many steps, turning evenly. The wheels tell too much or too little,
  // and what is triangulated by them with them.
  void drive(int steps, double turn_rad = 0) {
    std::normal_distribution<double> normal;
    for (int i = 0; i < steps; ++i) {
      const double turn = turn_rad / steps;
      pose_ = moved(pose_, kStepM, turn);
      const double told_m = kStepM * (wheels_tell_ + 0.02 * normal(random_));
      Step step{
          pose_, {kStepS, told_m, turn + 0.003 * normal(random_)}, seen_at(pose_, walls_, random_)};
      for (Beam& beam : step.observation.beams) beam.range_m *= wheels_tell_;
      steps_.push_back(std::move(step));
    }
  }

  // Up the street and round the corner to the east.
  void drive_round_the_corner() {
    drive(62);
    drive(10, std::numbers::pi / 2);
    drive(40);
  }

  struct Outcome {
    int found = 0;  // frames
    int wrong = 0;  // of these, more than 5 m away
    double last_error_m = 0;
    FindStatus last = FindStatus::initializing;
    BeliefMode mode;
  };

  Outcome run(const FilterSettings& settings, const WallIndex& walls) const {
    PlanBox area = walls.bounds();
    area.min_m.array() -= 10;
    area.max_m.array() += 10;
    WallFilter filter(walls, area, settings);
    Outcome outcome;
    for (const Step& step : steps_) {
      const Found found = filter.update(step.observation, step.motion);
      outcome.last = found.status;
      outcome.mode = found.mode;
      outcome.last_error_m = (found.mode.pose.enu_m - step.truth.enu_m).norm();
      if (found.status != FindStatus::tracking) continue;
      ++outcome.found;
      outcome.wrong += outcome.last_error_m > 5 ? 1 : 0;
    }
    return outcome;
  }

  // About a known start.
  WallFilter after_a_short_drive() {
    drive(5);
    FilterSettings settings = seeded(1);
    settings.start = StartBelief{{{1, 3}, 0}, 2, 0.1};
    WallFilter filter(walls_, walls_.bounds(), settings);
    for (const Step& step : steps_) filter.update(step.observation, step.motion);
    return filter;
  }

  static FilterSettings seeded(std::uint64_t seed) {
    FilterSettings settings;
    settings.seed = seed;
    return settings;
  }

  WallIndex walls_{testing::bent_street()};
  Random random_{11};
  PlanPose pose_{{1, 3}, 0};
  double wheels_tell_ = 1.01;  // of a metre
  std::vector<Step> steps_;
};

TEST_F(WallFilterTest, FindsTheVehicleFromNoIdea) {
  drive_round_the_corner();
  drive(12);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Outcome outcome = run(seeded(seed), walls_);
    EXPECT_EQ(outcome.last, FindStatus::tracking) << "seed " << seed;
    EXPECT_LT(outcome.last_error_m, 1.5) << "seed " << seed;
    EXPECT_GT(outcome.found, 5) << "seed " << seed;
    EXPECT_LE(outcome.wrong, 5) << "seed " << seed;
  }
}

// Turned by 180 degrees the street is the same: up to its middle there are two places to be in.
TEST_F(WallFilterTest, APlaceThatLooksLikeAnotherIsNotFound) {
  std::vector<PlanWall> street = {{{-10, 0}, {-10, 400}, 0.2},
                                  {{10, 0}, {10, 400}, 0.2},
                                  {{-10, 0}, {10, 0}, 0.2},
                                  {{-10, 400}, {10, 400}, 0.2}};
  for (const double north_m : {40, 75, 120, 170}) {
    street.push_back({{10, north_m}, {5, north_m}, 0.2});
    street.push_back({{5, north_m}, {5, north_m + 8}, 0.2});
    street.push_back({{-10, 400 - north_m}, {-5, 400 - north_m}, 0.2});
    street.push_back({{-5, 400 - north_m}, {-5, 392 - north_m}, 0.2});
  }
  walls_ = WallIndex(street);
  pose_ = {{-1, 5}, 0};
  drive(120);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    EXPECT_EQ(run(seeded(seed), walls_).found, 0) << "seed " << seed;
  }
}

TEST_F(WallFilterTest, KeepsAStartThatIsKnown) {
  drive_round_the_corner();
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{3, 5}, 0.1}, 4, 0.2};
  const Outcome outcome = run(settings, walls_);
  EXPECT_EQ(outcome.wrong, 0);
  EXPECT_GT(outcome.found, 10);
}

TEST_F(WallFilterTest, LearnsTheScaleOfTheWheels) {
  for (const double wheels_tell : {0.96, 1.04}) {
    steps_.clear();
    pose_ = {{1, 3}, 0};
    wheels_tell_ = wheels_tell;
    drive_round_the_corner();
    FilterSettings settings = seeded(1);
    settings.start = StartBelief{{{1, 3}, 0}, 2, 0.2};
    const Outcome outcome = run(settings, walls_);
    EXPECT_NEAR(outcome.mode.wheel_scale * wheels_tell, 1, 0.015);
    EXPECT_LT(outcome.last_error_m, 1);
  }
}

// Nothing is looked for elsewhere, whatever goes through walls, as long as it was not found.
TEST_F(WallFilterTest, AStartThatIsKnownIsNotLookedForElsewhere) {
  drive(6);
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{1, 3}, 0}, 2, 1.5};
  PlanBox area = walls_.bounds();
  WallFilter filter(walls_, area, settings);
  for (const Step& step : steps_) filter.update(step.observation, step.motion);
  for (const Particle& particle : filter.particles()) {
    EXPECT_LT((particle.pose.enu_m - pose_.enu_m).norm(), 25);
  }
  EXPECT_GE(filter.particles().size(), settings.particles / 2);
}

TEST_F(WallFilterTest, ThePapersMethodKeepsAStartThatIsKnown) {
  drive_round_the_corner();
  FilterSettings settings = seeded(1);
  settings.method = FindMethod::orientations;
  settings.start = StartBelief{{{1, 3}, 0}, 2, 0.1};
  const Outcome outcome = run(settings, walls_);
  EXPECT_LT(outcome.last_error_m, 15);
}

// The drive of another place.
TEST_F(WallFilterTest, AmongOtherWallsItFindsNothing) {
  drive_round_the_corner();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> place(-60, 60);
  std::vector<PlanWall> others;
  for (int i = 0; i < 25; ++i) {
    const Eigen::Vector2d corner(place(random), place(random));
    testing::add_house(others, corner, corner + Eigen::Vector2d(7 + i % 5, 6 + i % 3));
  }
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_LE(run(seeded(seed), WallIndex(others)).found, 0) << "seed " << seed;
  }
}

TEST_F(WallFilterTest, TheBeliefOfAKidnappedVehicleGoesWhereItIs) {
  drive_round_the_corner();
  pose_ = {{1, 3}, 0};
  drive_round_the_corner();
  drive(12);
  const Outcome outcome = run(seeded(2), walls_);
  EXPECT_LT(outcome.last_error_m, 2);
}

TEST_F(WallFilterTest, TheSameSeedGivesTheSameAnswer) {
  drive(30);
  const Outcome first = run(seeded(3), walls_);
  const Outcome second = run(seeded(3), walls_);
  EXPECT_EQ(first.mode.pose.enu_m, second.mode.pose.enu_m);
  EXPECT_EQ(first.mode.mass, second.mode.mass);
  EXPECT_NE(first.mode.pose.enu_m, run(seeded(4), walls_).mode.pose.enu_m);
}

// At a red light the belief neither sharpens nor spreads.
TEST_F(WallFilterTest, StandingStillChangesNoBelief) {
  drive_round_the_corner();
  for (int i = 0; i < 100; ++i) {
    steps_.push_back({pose_, {kStepS, 0, 0}, {{}, {}}});
  }
  const Outcome outcome = run(seeded(1), walls_);
  EXPECT_EQ(outcome.last, FindStatus::predicted);
  EXPECT_LT(outcome.last_error_m, 1.5);
}

// ... and no particle moves or is drawn anew, so long as nothing is seen.
TEST_F(WallFilterTest, StandingStillParticlesStay) {
  WallFilter filter = after_a_short_drive();
  const ParticleCloud before = filter.particles();
  for (int i = 0; i < 20; ++i) filter.update({}, {kStepS, 0, 0});
  ASSERT_EQ(filter.particles().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(filter.particles()[i].pose.enu_m, before[i].pose.enu_m);
    EXPECT_EQ(filter.particles()[i].pose.heading_rad, before[i].pose.heading_rad);
  }
  filter.update({}, {kStepS, 0, 0.1});  // a turn on the spot is a motion
  EXPECT_NE(filter.particles().front().pose.heading_rad, before.front().pose.heading_rad);
}

// Most of those that look to the sides go into houses, and with them all of their weight.
TEST_F(WallFilterTest, AKnownStartThatLosesParticlesAtWallsHasEnoughAgain) {
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{0, 30}, 0}, 1, 1.5};
  WallFilter filter(walls_, walls_.bounds(), settings);
  for (int i = 0; i < 20; ++i) {
    filter.update({}, {kStepS, kStepM, 0});
    EXPECT_GE(filter.particles().size(), settings.particles / 2);
  }
  for (const Particle& particle : filter.particles()) {
    EXPECT_LT(std::abs(particle.pose.enu_m.x()), 8);  // in the street
  }
}

TEST_F(WallFilterTest, WhereNothingIsSeenTheBeliefSpreads) {
  const WallIndex far({{{500, 0}, {500, 100}, 0.1}});
  const PlanBox area{{-600, -600}, {600, 600}};
  for (const FindMethod method : {FindMethod::orientations, FindMethod::combined}) {
    FilterSettings settings = seeded(1);
    settings.method = method;
    settings.start = StartBelief{{{0, 0}, 0}, 0.01, 0.001};
    WallFilter filter(far, area, settings);
    Found found;
    for (int i = 0; i < 60; ++i) found = filter.update({}, {kStepS, kStepM, 0});
    EXPECT_NEAR(found.mode.pose.enu_m.y(), 90, 4);
    EXPECT_GT(found.mode.sigma_m, 0.2);
    EXPECT_GT(found.mode.heading_sigma_rad, 0.01);
  }
}

// However long the vehicle looks at the same walls, this is no news.
TEST_F(WallFilterTest, StandingStillASightSaysNothing) {
  WallFilter filter = after_a_short_drive();
  const ParticleCloud before = filter.particles();
  const WallObservation sight = seen_at({{4, 20}, 0.1}, walls_, random_);
  for (int i = 0; i < 20; ++i) filter.update(sight, {kStepS, 0, 0});
  ASSERT_EQ(filter.particles().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(filter.particles()[i].weight, before[i].weight, 1e-12);
  }
}

TEST_F(WallFilterTest, ThePapersMethodEnduresWhatNoParticleExplains) {
  FilterSettings settings = seeded(1);
  settings.method = FindMethod::orientations;
  const WallIndex far({{{500, 0}, {500, 100}, 0.1}});
  WallFilter filter(far, {{-50, -50}, {50, 50}}, settings);
  const WallObservation sight{{{{-0.1, 0.1}, {0.5}}}, {}};
  const Found found = filter.update(sight, {kStepS, kStepM, 0});
  EXPECT_GT(found.mode.mass, 0);
  EXPECT_LE(found.mode.mass, 1);
  EXPECT_EQ(filter.particles().size(), settings.particles);
  for (const Particle& particle : filter.particles()) EXPECT_GT(particle.weight, 0);
}

// Whatever is drawn, challenged and drawn again.
TEST_F(WallFilterTest, ParticlesAreNoMoreThanAskedForAndCarryOneBelief) {
  drive_round_the_corner();
  for (const bool is_start_known : {false, true}) {
    FilterSettings settings = seeded(1);
    settings.particles = 300;
    if (is_start_known) settings.start = StartBelief{{{1, 3}, 0}, 4, 0.2};
    WallFilter filter(walls_, walls_.bounds(), settings);
    for (const Step& step : steps_) {
      filter.update(step.observation, step.motion);
      const ParticleCloud& cloud = filter.particles();
      EXPECT_LE(cloud.size(), settings.particles);
      EXPECT_GE(cloud.size(), settings.particles / 2);
      double total = 0;
      for (const Particle& particle : cloud) total += particle.weight;
      EXPECT_NEAR(total, 1, 1e-9);
      EXPECT_GE(effective_count(cloud), 0.49 * static_cast<double>(cloud.size()));
    }
  }
}

TEST_F(WallFilterTest, WhatIsFoundTakesFewerParticles) {
  drive_round_the_corner();
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{1, 3}, 0}, 1, 0.1};
  WallFilter filter(walls_, walls_.bounds(), settings);
  Found found;
  for (const Step& step : steps_) found = filter.update(step.observation, step.motion);
  EXPECT_EQ(found.status, FindStatus::tracking);
  EXPECT_LT(filter.particles().size(), settings.particles);
}

TEST_F(WallFilterTest, WhereNothingIsSeenNothingIsLeftUnexplained) {
  drive(10);
  for (const FindMethod method : {FindMethod::orientations, FindMethod::combined}) {
    FilterSettings settings = seeded(1);
    settings.method = method;
    settings.start = StartBelief{{{1, 3}, 0}, 1, 0.1};
    WallFilter filter(walls_, walls_.bounds(), settings);
    Found found;
    for (const Step& step : steps_) found = filter.update(step.observation, step.motion);
    EXPECT_GT(found.explained, 0.1);
    EXPECT_EQ(filter.update({}, {kStepS, kStepM, 0}).explained, found.explained);
  }
}

// Section IV: each frame draws particles by their importance.
TEST_F(WallFilterTest, ThePapersMethodDrawsParticlesAfterEachFrame) {
  drive(10);
  FilterSettings settings = seeded(1);
  settings.method = FindMethod::orientations;
  WallFilter filter(walls_, walls_.bounds(), settings);
  for (const Step& step : steps_) {
    filter.update(step.observation, step.motion);
    EXPECT_EQ(filter.particles().size(), settings.particles);
    EXPECT_NEAR(effective_count(filter.particles()), 2000, 1e-6);
  }
}

TEST_F(WallFilterTest, OneParticleIsAllowed) {
  drive(20);
  FilterSettings settings = seeded(1);
  settings.particles = 1;
  EXPECT_EQ(run(settings, walls_).mode.sigma_m, 0);
}

}  // namespace
}  // namespace milepost
