#include "client/global/mean_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace milepost {
namespace {

// `share` of a cloud of 1000 about `pose`.
void add_cluster(ParticleCloud& cloud, const PlanPose& pose, double share, Random& random) {
  const auto count = static_cast<std::size_t>(1000 * share);
  for (Particle particle : cloud_about({pose, 1, 0.05}, count, random)) {
    particle.weight = 0.001;
    cloud.push_back(particle);
  }
}

TEST(MeanShift, FindsTheHeavierOfTwoPlaces) {
  Random random(1);
  ParticleCloud cloud;
  add_cluster(cloud, {{100, 20}, 1}, 0.4, random);
  add_cluster(cloud, {{-30, 50}, 4}, 0.6, random);
  const BeliefMode mode = densest_mode(cloud, {5, 0.35});
  EXPECT_NEAR(mode.pose.enu_m.x(), -30, 0.2);
  EXPECT_NEAR(mode.pose.enu_m.y(), 50, 0.2);
  EXPECT_NEAR(std::remainder(mode.pose.heading_rad - 4, 2 * std::numbers::pi), 0, 0.02);
  EXPECT_NEAR(mode.mass, 0.6, 0.01);
  EXPECT_NEAR(mode.sigma_m, 1, 0.1);
  EXPECT_NEAR(mode.heading_sigma_rad, 0.05, 0.01);
}

TEST(MeanShift, OppositeHeadingsAreTwoPlaces) {
  Random random(1);
  ParticleCloud cloud;
  add_cluster(cloud, {{0, 0}, 0}, 0.45, random);
  add_cluster(cloud, {{0, 0}, std::numbers::pi}, 0.55, random);
  const BeliefMode mode = densest_mode(cloud, {5, 0.35});
  EXPECT_NEAR(mode.mass, 0.55, 0.01);
  EXPECT_NEAR(std::cos(mode.pose.heading_rad), -1, 0.01);
}

TEST(MeanShift, TheScaleOfTheWheelsIsThatOfThePlace) {
  const ParticleCloud cloud = {
      {{{0, 0}, 0}, 0.4, 1.1}, {{{1, 0}, 0}, 0.2, 0.8}, {{{100, 0}, 0}, 0.4, 0.5}};
  EXPECT_NEAR(densest_mode(cloud, {}).wheel_scale, 1, 1e-9);
}

TEST(MeanShift, HeadingsMeetAtNorth) {
  Random random(1);
  ParticleCloud cloud;
  add_cluster(cloud, {{0, 0}, 2 * std::numbers::pi}, 0.5, random);
  add_cluster(cloud, {{0, 0}, 0}, 0.5, random);
  EXPECT_NEAR(densest_mode(cloud, {5, 0.35}).mass, 1, 0.01);
}

// A cluster on the corner of four bins is found whole.
TEST(MeanShift, ClimbsToTheMiddle) {
  Random random(1);
  ParticleCloud cloud;
  add_cluster(cloud, {{10, 10}, 0.7}, 1, random);
  const BeliefMode mode = densest_mode(cloud, {5, 0.35});
  EXPECT_GT(mode.mass, 0.99);
  EXPECT_NEAR(mode.pose.enu_m.x(), 10, 0.15);
}

// The heaviest bin is the lighter place's, which lies in the middle of it.
TEST(MeanShift, APlaceOnTheCornerOfBinsIsNotOverlooked) {
  Random random(1);
  ParticleCloud cloud;
  add_cluster(cloud, {{102.5, 22.5}, 1.05}, 0.4, random);
  add_cluster(cloud, {{10, 10}, 0.7}, 0.6, random);
  EXPECT_NEAR(densest_mode(cloud, {5, 0.35}).mass, 0.6, 0.01);
}

TEST(MeanShift, PlacesBesideEachOtherAreToldApart) {
  for (const Eigen::Vector2d& apart_m : {Eigen::Vector2d(40, 0), Eigen::Vector2d(0, 40)}) {
    Random random(1);
    ParticleCloud cloud;
    add_cluster(cloud, {{2.5, 2.5}, 1}, 0.4, random);
    add_cluster(cloud, {Eigen::Vector2d(2.5, 2.5) + apart_m, 1}, 0.6, random);
    EXPECT_NEAR(densest_mode(cloud, {5, 0.35}).mass, 0.6, 0.01);
  }
}

// Particles that turned round once more than others look the same way.
TEST(MeanShift, OfManyPlacesTheHeaviestIsFoundHoweverOftenItTurned) {
  Random random(1);
  ParticleCloud cloud;
  for (int i = 0; i < 5; ++i) add_cluster(cloud, {{100.0 * i + 2.5, 2.5}, 1}, 0.14, random);
  for (int turns = 0; turns < 3; ++turns) {
    add_cluster(cloud, {{502.5, 2.5}, 1 + 2 * std::numbers::pi * turns}, 0.1, random);
  }
  const BeliefMode mode = densest_mode(cloud, {5, 0.35});
  EXPECT_NEAR(mode.mass, 0.3, 0.01);
  EXPECT_NEAR(mode.pose.enu_m.x(), 502.5, 0.3);
}

// From a lone particle by a few on the way to the place that most of the belief is in.
TEST(MeanShift, ClimbsUntilItSettles) {
  ParticleCloud cloud(900, {{{7.8, 7.8}, 0.1}, 0.001});
  cloud.insert(cloud.end(), 90, {{{4, 4}, 0.1}, 0.0011});
  cloud.push_back({{{0.1, 0.1}, 0.1}, 0.002});
  const BeliefMode mode = densest_mode(cloud, {8, 0.35});
  EXPECT_NEAR(mode.pose.enu_m.x(), (7.8 * 900 + 4 * 90 * 1.1) / (900 + 90 * 1.1), 1e-3);
}

// The heaviest particle of the only bin sees a part of its place.
TEST(MeanShift, ClimbsFromTheEdgeOfItsBin) {
  Random random(1);
  ParticleCloud cloud = cloud_about({{{13, 13}, 0.35}, 0.2, 0.05}, 1000, random);
  cloud.push_back({{{15.7, 15.7}, 0.35}, 0.002});
  const BeliefMode mode = densest_mode(cloud, {4, 0.35});
  EXPECT_GT(mode.mass, 0.99);
  EXPECT_NEAR(mode.pose.enu_m.x(), 13, 0.1);
}

}  // namespace
}  // namespace milepost
