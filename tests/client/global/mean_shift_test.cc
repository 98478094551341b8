#include "client/global/mean_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace milepost {
namespace {

// `share` of a set of 1000 particles around `pose`.
void add_cluster(ParticleSet& particles, const Pose2& pose, double share, Random& random) {
  const auto count = static_cast<std::size_t>(1000 * share);
  for (Particle particle : particles_about({pose, 1, 0.05}, count, random)) {
    particle.weight = 0.001;
    particles.push_back(particle);
  }
}

TEST(MeanShift, FindsTheHeavierOfTwoPlaces) {
  Random random(1);
  ParticleSet particles;
  add_cluster(particles, {{100, 20}, 1}, 0.4, random);
  add_cluster(particles, {{-30, 50}, 4}, 0.6, random);
  const BeliefMode mode = densest_mode(particles, {5, 0.35});
  EXPECT_NEAR(mode.pose.enu_m.x(), -30, 0.2);
  EXPECT_NEAR(mode.pose.enu_m.y(), 50, 0.2);
  EXPECT_NEAR(std::remainder(mode.pose.heading_rad - 4, 2 * std::numbers::pi), 0, 0.02);
  EXPECT_NEAR(mode.probability, 0.6, 0.01);
  EXPECT_NEAR(mode.sigma_m, 1, 0.1);
  EXPECT_NEAR(mode.heading_sigma_rad, 0.05, 0.01);
}

TEST(MeanShift, OppositeHeadingsAreTwoPlaces) {
  Random random(1);
  ParticleSet particles;
  add_cluster(particles, {{0, 0}, 0}, 0.45, random);
  add_cluster(particles, {{0, 0}, std::numbers::pi}, 0.55, random);
  const BeliefMode mode = densest_mode(particles, {5, 0.35});
  EXPECT_NEAR(mode.probability, 0.55, 0.01);
  EXPECT_NEAR(std::cos(mode.pose.heading_rad), -1, 0.01);
}

TEST(MeanShift, TheOdometryScaleIsThatOfTheMode) {
  const ParticleSet particles = {
      {{{0, 0}, 0}, 0.4, 1.1}, {{{1, 0}, 0}, 0.2, 0.8}, {{{100, 0}, 0}, 0.4, 0.5}};
  EXPECT_NEAR(densest_mode(particles, {}).odometry_scale, 1, 1e-9);
}

TEST(MeanShift, HeadingsMeetAtNorth) {
  Random random(1);
  ParticleSet particles;
  add_cluster(particles, {{0, 0}, 2 * std::numbers::pi}, 0.5, random);
  add_cluster(particles, {{0, 0}, 0}, 0.5, random);
  EXPECT_NEAR(densest_mode(particles, {5, 0.35}).probability, 1, 0.01);
}

// A cluster on the corner of four bins is found whole.
TEST(MeanShift, ClimbsToTheMiddle) {
  Random random(1);
  ParticleSet particles;
  add_cluster(particles, {{10, 10}, 0.7}, 1, random);
  const BeliefMode mode = densest_mode(particles, {5, 0.35});
  EXPECT_GT(mode.probability, 0.99);
  EXPECT_NEAR(mode.pose.enu_m.x(), 10, 0.15);
}

// The heaviest bin belongs to the lighter mode, which lies in the middle of it.
TEST(MeanShift, APlaceOnTheCornerOfBinsIsNotOverlooked) {
  Random random(1);
  ParticleSet particles;
  add_cluster(particles, {{102.5, 22.5}, 1.05}, 0.4, random);
  add_cluster(particles, {{10, 10}, 0.7}, 0.6, random);
  EXPECT_NEAR(densest_mode(particles, {5, 0.35}).probability, 0.6, 0.01);
}

TEST(MeanShift, PlacesBesideEachOtherAreToldApart) {
  for (const Eigen::Vector2d& apart_m : {Eigen::Vector2d(40, 0), Eigen::Vector2d(0, 40)}) {
    Random random(1);
    ParticleSet particles;
    add_cluster(particles, {{2.5, 2.5}, 1}, 0.4, random);
    add_cluster(particles, {Eigen::Vector2d(2.5, 2.5) + apart_m, 1}, 0.6, random);
    EXPECT_NEAR(densest_mode(particles, {5, 0.35}).probability, 0.6, 0.01);
  }
}

// Headings that differ by full turns are the same.
TEST(MeanShift, OfManyPlacesTheHeaviestIsFoundHoweverOftenItTurned) {
  Random random(1);
  ParticleSet particles;
  for (int i = 0; i < 5; ++i) add_cluster(particles, {{100.0 * i + 2.5, 2.5}, 1}, 0.14, random);
  for (int turns = 0; turns < 3; ++turns) {
    add_cluster(particles, {{502.5, 2.5}, 1 + 2 * std::numbers::pi * turns}, 0.1, random);
  }
  const BeliefMode mode = densest_mode(particles, {5, 0.35});
  EXPECT_NEAR(mode.probability, 0.3, 0.01);
  EXPECT_NEAR(mode.pose.enu_m.x(), 502.5, 0.3);
}

// From a single particle over a few others to the mode with most of the belief.
TEST(MeanShift, ClimbsUntilItSettles) {
  ParticleSet particles(900, {{{7.8, 7.8}, 0.1}, 0.001});
  particles.insert(particles.end(), 90, {{{4, 4}, 0.1}, 0.0011});
  particles.push_back({{{0.1, 0.1}, 0.1}, 0.002});
  const BeliefMode mode = densest_mode(particles, {8, 0.35});
  EXPECT_NEAR(mode.pose.enu_m.x(), (7.8 * 900 + 4 * 90 * 1.1) / (900 + 90 * 1.1), 1e-3);
}

// The kernel around the heaviest particle of the only bin covers only a part of the mode.
TEST(MeanShift, ClimbsFromTheEdgeOfItsBin) {
  Random random(1);
  ParticleSet particles = particles_about({{{13, 13}, 0.35}, 0.2, 0.05}, 1000, random);
  particles.push_back({{{15.7, 15.7}, 0.35}, 0.002});
  const BeliefMode mode = densest_mode(particles, {4, 0.35});
  EXPECT_GT(mode.probability, 0.99);
  EXPECT_NEAR(mode.pose.enu_m.x(), 13, 0.1);
}

}  // namespace
}  // namespace milepost
