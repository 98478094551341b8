#include "client/global/wall_particle_filter.h"

#include <cmath>
#include <numbers>
#include <random>

#include "tests/client/global/plan_drive.h"

namespace milepost {
namespace {

using testing::kStepM;
using testing::kStepS;
using testing::seen_at;
using testing::Step;

const MakePlanFilter kMake = combined_method().make_filter;

class WallParticleFilterTest : public testing::PlanDriveTest {
 protected:
  // About a known start.
  WallParticleFilter after_a_short_drive() {
    drive(5);
    FilterSettings settings = seeded(1);
    settings.start = StartBelief{{{1, 3}, 0}, 2, 0.1};
    WallParticleFilter filter(walls_, walls_.bounds(), settings);
    for (const Step& step : steps_) filter.update(step.observation, step.motion);
    return filter;
  }
};

TEST_F(WallParticleFilterTest, FindsTheVehicleFromNoIdea) {
  drive_round_the_corner();
  drive(12);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Outcome outcome = run(kMake, seeded(seed), walls_);
    EXPECT_EQ(outcome.last, GlobalStatus::tracking) << "seed " << seed;
    EXPECT_LT(outcome.last_error_m, 1.5) << "seed " << seed;
    EXPECT_GT(outcome.found, 5) << "seed " << seed;
    EXPECT_LE(outcome.wrong, 5) << "seed " << seed;
  }
}

// Rotated by 180 degrees the street is the same: up to its middle there are two possible positions.
TEST_F(WallParticleFilterTest, APlaceThatLooksLikeAnotherIsNotFound) {
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
  walls_ = RayCastingGrid(street);
  pose_ = {{-1, 5}, 0};
  drive(120);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    EXPECT_EQ(run(kMake, seeded(seed), walls_).found, 0) << "seed " << seed;
  }
}

TEST_F(WallParticleFilterTest, KeepsAStartThatIsKnown) {
  drive_round_the_corner();
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{3, 5}, 0.1}, 4, 0.2};
  const Outcome outcome = run(kMake, settings, walls_);
  EXPECT_EQ(outcome.wrong, 0);
  EXPECT_GT(outcome.found, 10);
}

TEST_F(WallParticleFilterTest, EstimatesTheOdometryScale) {
  for (const double wheels_tell : {0.96, 1.04}) {
    steps_.clear();
    pose_ = {{1, 3}, 0};
    has_odometry_ = wheels_tell;
    drive_round_the_corner();
    FilterSettings settings = seeded(1);
    settings.start = StartBelief{{{1, 3}, 0}, 2, 0.2};
    const Outcome outcome = run(kMake, settings, walls_);
    EXPECT_NEAR(outcome.mode.odometry_scale * wheels_tell, 1, 0.015);
    EXPECT_LT(outcome.last_error_m, 1);
  }
}

// No alternatives are tested before convergence, even if particles cross walls.
TEST_F(WallParticleFilterTest, AStartThatIsKnownIsNotLookedForElsewhere) {
  drive(6);
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{1, 3}, 0}, 2, 1.5};
  PlanBox area = walls_.bounds();
  WallParticleFilter filter(walls_, area, settings);
  for (const Step& step : steps_) filter.update(step.observation, step.motion);
  for (const Particle& particle : filter.particles()) {
    EXPECT_LT((particle.pose.enu_m - pose_.enu_m).norm(), 25);
  }
  EXPECT_GE(filter.particles().size(), settings.particles / 2);
}

// A drive through walls that are not on the map.
TEST_F(WallParticleFilterTest, AmongOtherWallsItFindsNothing) {
  drive_round_the_corner();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> place(-60, 60);
  std::vector<PlanWall> others;
  for (int i = 0; i < 25; ++i) {
    const Eigen::Vector2d corner(place(random), place(random));
    testing::add_house(others, corner, corner + Eigen::Vector2d(7 + i % 5, 6 + i % 3));
  }
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_LE(run(kMake, seeded(seed), RayCastingGrid(others)).found, 0) << "seed " << seed;
  }
}

TEST_F(WallParticleFilterTest, TheBeliefOfAKidnappedVehicleGoesWhereItIs) {
  drive_round_the_corner();
  pose_ = {{1, 3}, 0};
  drive_round_the_corner();
  drive(12);
  const Outcome outcome = run(kMake, seeded(2), walls_);
  EXPECT_LT(outcome.last_error_m, 2);
}

TEST_F(WallParticleFilterTest, TheSameSeedGivesTheSameAnswer) {
  drive(30);
  const Outcome first = run(kMake, seeded(3), walls_);
  const Outcome second = run(kMake, seeded(3), walls_);
  EXPECT_EQ(first.mode.pose.enu_m, second.mode.pose.enu_m);
  EXPECT_EQ(first.mode.probability, second.mode.probability);
  EXPECT_NE(first.mode.pose.enu_m, run(kMake, seeded(4), walls_).mode.pose.enu_m);
}

// At a red light the belief neither sharpens nor spreads ...
TEST_F(WallParticleFilterTest, StandingStillChangesNoBelief) {
  drive_round_the_corner();
  for (int i = 0; i < 100; ++i) {
    steps_.push_back({pose_, {kStepS, 0, 0}, {{}, {}}});
  }
  const Outcome outcome = run(kMake, seeded(1), walls_);
  EXPECT_EQ(outcome.last, GlobalStatus::predicted);
  EXPECT_LT(outcome.last_error_m, 1.5);
}

// ... and without measurements no particle moves or is redrawn.
TEST_F(WallParticleFilterTest, StandingStillParticlesStay) {
  WallParticleFilter filter = after_a_short_drive();
  const ParticleSet before = filter.particles();
  for (int i = 0; i < 20; ++i) filter.update({}, {kStepS, 0, 0});
  ASSERT_EQ(filter.particles().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(filter.particles()[i].pose.enu_m, before[i].pose.enu_m);
    EXPECT_EQ(filter.particles()[i].pose.heading_rad, before[i].pose.heading_rad);
  }
  filter.update({}, {kStepS, 0, 0.1});  // a rotation on the spot is a motion
  EXPECT_NE(filter.particles().front().pose.heading_rad, before.front().pose.heading_rad);
}

// Most particles that head sideways enter houses and lose their weight.
TEST_F(WallParticleFilterTest, AKnownStartThatLosesParticlesAtWallsHasEnoughAgain) {
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{0, 30}, 0}, 1, 1.5};
  WallParticleFilter filter(walls_, walls_.bounds(), settings);
  for (int i = 0; i < 20; ++i) {
    filter.update({}, {kStepS, kStepM, 0});
    EXPECT_GE(filter.particles().size(), settings.particles / 2);
  }
  for (const Particle& particle : filter.particles()) {
    EXPECT_LT(std::abs(particle.pose.enu_m.x()), 8);  // in the street
  }
}

TEST_F(WallParticleFilterTest, WithoutMeasurementsTheBeliefSpreads) {
  const RayCastingGrid far({{{500, 0}, {500, 100}, 0.1}});
  const PlanBox area{{-600, -600}, {600, 600}};
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{0, 0}, 0}, 0.01, 0.001};
  WallParticleFilter filter(far, area, settings);
  PlanEstimate found;
  for (int i = 0; i < 60; ++i) found = filter.update({}, {kStepS, kStepM, 0});
  EXPECT_NEAR(found.mode.pose.enu_m.y(), 90, 4);
  EXPECT_GT(found.mode.sigma_m, 0.2);
  EXPECT_GT(found.mode.heading_sigma_rad, 0.01);
}

// Repeated measurements of the same walls at standstill are not independent.
TEST_F(WallParticleFilterTest, StandingStillAMeasurementChangesNothing) {
  WallParticleFilter filter = after_a_short_drive();
  const ParticleSet before = filter.particles();
  const WallObservation past = seen_at({{4, 20}, 0.1}, walls_, random_);
  for (int i = 0; i < 20; ++i) filter.update(past, {kStepS, 0, 0});
  ASSERT_EQ(filter.particles().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(filter.particles()[i].weight, before[i].weight, 1e-12);
  }
}

// Through proposals, tests and resampling.
TEST_F(WallParticleFilterTest, ParticlesAreNoMoreThanAskedForAndCarryOneBelief) {
  drive_round_the_corner();
  for (const bool is_start_known : {false, true}) {
    FilterSettings settings = seeded(1);
    settings.particles = 300;
    if (is_start_known) settings.start = StartBelief{{{1, 3}, 0}, 4, 0.2};
    WallParticleFilter filter(walls_, walls_.bounds(), settings);
    for (const Step& step : steps_) {
      filter.update(step.observation, step.motion);
      const ParticleSet& particles = filter.particles();
      EXPECT_LE(particles.size(), settings.particles);
      EXPECT_GE(particles.size(), settings.particles / 2);
      double total = 0;
      for (const Particle& particle : particles) total += particle.weight;
      EXPECT_NEAR(total, 1, 1e-9);
      EXPECT_GE(effective_count(particles), 0.49 * static_cast<double>(particles.size()));
    }
  }
}

TEST_F(WallParticleFilterTest, WhatIsFoundTakesFewerParticles) {
  drive_round_the_corner();
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{1, 3}, 0}, 1, 0.1};
  WallParticleFilter filter(walls_, walls_.bounds(), settings);
  PlanEstimate found;
  for (const Step& step : steps_) found = filter.update(step.observation, step.motion);
  EXPECT_EQ(found.status, GlobalStatus::tracking);
  EXPECT_LT(filter.particles().size(), settings.particles);
}

TEST_F(WallParticleFilterTest, WithoutMeasurementsTheInlierRatioStays) {
  drive(10);
  FilterSettings settings = seeded(1);
  settings.start = StartBelief{{{1, 3}, 0}, 1, 0.1};
  WallParticleFilter filter(walls_, walls_.bounds(), settings);
  PlanEstimate found;
  for (const Step& step : steps_) found = filter.update(step.observation, step.motion);
  EXPECT_GT(found.inlier_ratio, 0.1);
  EXPECT_EQ(filter.update({}, {kStepS, kStepM, 0}).inlier_ratio, found.inlier_ratio);
}

TEST_F(WallParticleFilterTest, OneParticleIsAllowed) {
  drive(20);
  FilterSettings settings = seeded(1);
  settings.particles = 1;
  EXPECT_EQ(run(kMake, settings, walls_).mode.sigma_m, 0);
}

}  // namespace
}  // namespace milepost
