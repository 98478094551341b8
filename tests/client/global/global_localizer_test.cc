// The global localizer: walls, odometry and priors with frames that show nothing, and with a wall
// that they show.
#include "client/global/global_localizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "client/evaluate/baselines/orientation_filter.h"
#include "tests/client/global/painted_wall.h"

namespace milepost {
namespace {

using testing::kCamera;
using testing::kWallM;

const GeoPoint kPlace{49, 8.4, 0};

// A point relative to kPlace, in metres east and north.
GeoPoint beside(double east_m, double north_m) {
  return LocalFrame(kPlace).geo_from_enu({east_m, north_m, 0});
}

Wall wall(double east_m, double north_m, double end_east_m, double end_north_m, double sigma_m) {
  const GeoPoint begin = beside(east_m, north_m);
  const GeoPoint end = beside(end_east_m, end_north_m);
  return {
      {begin.latitude_deg, begin.longitude_deg}, {end.latitude_deg, end.longitude_deg}, sigma_m};
}

// Two walls at the ends of 200 x 100 m, with nothing in between.
const std::vector<Wall> kWalls = {wall(-100, -50, -100, 50, 0.3), wall(100, -50, 100, 50, 0.7)};

const cv::Mat& blank() {
  static const cv::Mat image(500, 600, CV_8UC1, cv::Scalar(90));
  return image;
}

GlobalLocalizerSettings starting_at(double east_m, double north_m, double sigma_m) {
  GlobalLocalizerSettings settings;
  settings.start = PosePrior{beside(east_m, north_m), sigma_m, 90};
  return settings;
}

// The box around all particles, relative to the localizer's origin.
PlanBox box_around(const ParticleSet& particles) {
  PlanBox box{particles.front().pose.enu_m, particles.front().pose.enu_m};
  for (const Particle& particle : particles) {
    box.min_m = box.min_m.cwiseMin(particle.pose.enu_m);
    box.max_m = box.max_m.cwiseMax(particle.pose.enu_m);
  }
  return box;
}

TEST(GlobalLocalizer, HasTheWallsInMetresAboutTheirMiddle) {
  const GlobalLocalizer localizer(kWalls, kCamera, {});
  EXPECT_LT(geodesic_distance_m(localizer.origin(), kPlace), 0.01);
  EXPECT_EQ(localizer.origin().altitude_m, 0);
  ASSERT_EQ(localizer.walls().walls().size(), 2U);
  const PlanWall& second = localizer.walls().walls()[1];
  EXPECT_LT((second.begin_m - Eigen::Vector2d(100, -50)).norm(), 0.01);
  EXPECT_LT((second.end_m - Eigen::Vector2d(100, 50)).norm(), 0.01);
  EXPECT_EQ(second.sigma_m, 0.7);
}

TEST(GlobalLocalizer, TheMiddleOfWallsOnBothSidesOf180IsBetweenThem) {
  const std::vector<Wall> walls = {{{-16.5, 179.999}, {-16.4999, 179.999}, 0.3},
                                   {{-16.5, -179.997}, {-16.4999, -179.997}, 0.3}};
  const GlobalLocalizer localizer(walls, kCamera, {});
  EXPECT_LT(geodesic_distance_m(localizer.origin(), {-16.49995, -179.999, 0}), 0.01);
  const PlanBox box = localizer.walls().bounds();
  EXPECT_NEAR((box.max_m - box.min_m).x(), 0.004 * 106756, 1);
}

TEST(GlobalLocalizer, WithoutAnyIdeaItLooksAboutAllWalls) {
  GlobalLocalizerSettings settings;
  settings.particles = 4000;
  GlobalLocalizer localizer(kWalls, kCamera, settings);
  EXPECT_EQ(localizer.particles().size(), 4000U);
  const PlanBox box = box_around(localizer.particles());
  EXPECT_NEAR(box.min_m.x(), -110, 1);
  EXPECT_NEAR(box.max_m.x(), 110, 1);
  EXPECT_NEAR(box.min_m.y(), -60, 1);
  EXPECT_NEAR(box.max_m.y(), 60, 1);
  // Of 220 x 120 m, around the densest mode: around the middle it is 51 m.
  const GlobalPoseEstimate fix = localizer.find(blank(), 0);
  EXPECT_EQ(fix.status, GlobalStatus::initializing);
  EXPECT_GT(fix.sigma_m, 51);
  EXPECT_LT(fix.mode_probability, 0.1);
}

TEST(GlobalLocalizer, LooksInTheAreaThatIsGiven) {
  GlobalLocalizerSettings settings;
  const GeoPoint south_west = beside(-30, -20);
  const GeoPoint north_east = beside(50, 10);
  settings.area = Bounds{south_west.longitude_deg, south_west.latitude_deg,
                         north_east.longitude_deg, north_east.latitude_deg};
  const GlobalLocalizer localizer(kWalls, kCamera, settings);
  const PlanBox box = box_around(localizer.particles());
  EXPECT_NEAR(box.min_m.x(), -30, 1);
  EXPECT_NEAR(box.max_m.x(), 50, 1);
  EXPECT_NEAR(box.min_m.y(), -20, 1);
  EXPECT_NEAR(box.max_m.y(), 10, 1);
}

// The paper's method redraws particles that leave the area: they would be anywhere.
TEST(GlobalLocalizer, AKnownStartFarFromTheWallsIsInTheArea) {
  GlobalLocalizerSettings settings = starting_at(-150, 20, 1);
  settings.method = orientations_method();
  GlobalLocalizer localizer(kWalls, kCamera, settings);
  localizer.find(blank(), 0);
  localizer.observe({0, 4, 0});
  localizer.find(blank(), 1);
  const PlanBox box = box_around(localizer.particles());
  EXPECT_GT(box.min_m.x(), -155);
  EXPECT_LT(box.max_m.x(), -135);
}

TEST(GlobalLocalizer, ItsSeedDecides) {
  GlobalLocalizerSettings settings;
  const Eigen::Vector2d first =
      GlobalLocalizer(kWalls, kCamera, settings).particles().front().pose.enu_m;
  EXPECT_EQ(GlobalLocalizer(kWalls, kCamera, settings).particles().front().pose.enu_m, first);
  settings.seed = 2;
  EXPECT_NE(GlobalLocalizer(kWalls, kCamera, settings).particles().front().pose.enu_m, first);
}

TEST(GlobalLocalizer, WithoutMeasurementsItFollowsOdometry) {
  GlobalLocalizer localizer(kWalls, kCamera, starting_at(-60, 20, 1));
  localizer.find(blank(), 100);
  for (int i = 0; i < 10; ++i) {
    localizer.observe({100 + 0.5 * i, 8, 0});
    localizer.find(blank(), 100.5 + 0.5 * i);
  }
  // 40 m to the east; then a curve of 90 degrees to the right, of 4 s.
  for (int i = 0; i < 8; ++i) {
    localizer.observe({105 + 0.5 * i, 4, 22.5});
    localizer.find(blank(), 105.5 + 0.5 * i);
  }
  const GlobalPoseEstimate fix = localizer.find(blank(), 109.001);
  EXPECT_EQ(fix.timestamp_s, 109.001);
  const double radius_m = 16 / (90 * kRadPerDeg);
  EXPECT_LT(geodesic_distance_m(fix.position, beside(-20 + radius_m, 20 - radius_m)), 1);
  EXPECT_EQ(fix.position.altitude_m, 0);
  EXPECT_NEAR(fix.heading_deg, 180, 2);
  EXPECT_EQ(fix.status, GlobalStatus::initializing);
  EXPECT_EQ(fix.inlier_ratio, 0);
}

// The uncertainty of the walls' positions and of the camera's mounting is added.
TEST(GlobalLocalizer, IsAsUnsureAsItsStartAtLeast) {
  const auto first_fix = [](double sigma_m, double heading_sigma_deg) {
    GlobalLocalizerSettings settings = starting_at(0, 0, sigma_m);
    settings.start->heading_sigma_deg = heading_sigma_deg;
    return GlobalLocalizer(kWalls, kCamera, settings).find(blank(), 0);
  };
  EXPECT_NEAR(first_fix(1.5, 4).sigma_m, std::hypot(1.5, 0.5), 0.1);
  EXPECT_NEAR(first_fix(1.5, 4).heading_sigma_deg, std::hypot(4, 0.5), 0.3);
  EXPECT_NEAR(first_fix(0.01, 0.01).sigma_m, 0.5, 0.01);
  EXPECT_NEAR(first_fix(0.01, 0.01).heading_sigma_deg, 0.5, 0.01);
  EXPECT_NEAR(first_fix(15, 4).sigma_m, 15, 1);  // more than that of the densest mode
}

TEST(GlobalLocalizer, AHeadingIsFrom0To360) {
  GlobalLocalizerSettings settings = starting_at(0, 0, 1);
  settings.start->heading_deg = -30;
  EXPECT_NEAR(GlobalLocalizer(kWalls, kCamera, settings).find(blank(), 0).heading_deg, 330, 2);
}

// Straight towards a wall with odometry that overestimates the distance: it is found, predicted
// without measurements, and at the true distance from the wall.
TEST(GlobalLocalizer, FindsItselfBeforeAWall) {
  const std::vector<Wall> across = {wall(-30, 0, 30, 0, 0.1)};
  GlobalLocalizerSettings settings = starting_at(0, -40, 1);
  settings.start->heading_deg = 0;
  settings.start->heading_sigma_deg = 1;
  const GeoPoint south_west = beside(-40, -60);
  const GeoPoint north_east = beside(40, 0);
  settings.area = Bounds{south_west.longitude_deg, south_west.latitude_deg,
                         north_east.longitude_deg, north_east.latitude_deg};
  GlobalLocalizer localizer(across, kCamera, settings);
  const cv::Mat painted = testing::painted_wall();
  GlobalPoseEstimate fix;
  int frame = 0;
  for (double away_m = 40; away_m >= 6; away_m -= 2, ++frame) {
    fix = localizer.find(testing::seen(painted, kWallM - away_m, 0), frame);
    localizer.observe({static_cast<double>(frame), 2 * 1.03, 0});
  }
  EXPECT_EQ(fix.status, GlobalStatus::tracking);
  EXPECT_GT(fix.mode_probability, 0.8);
  EXPECT_GT(fix.inlier_ratio, 0.6);
  EXPECT_LT(fix.sigma_m, 3);
  const double north_m = LocalFrame(kPlace).enu_from_geo(fix.position).north_m;
  EXPECT_NEAR(north_m, -6, 0.8);  // -5 by odometry
  EXPECT_EQ(localizer.find(blank(), frame).status, GlobalStatus::predicted);
}

TEST(GlobalLocalizer, AStartWithoutAHeadingMayLookAnywhere) {
  GlobalLocalizerSettings settings = starting_at(10, 20, 2);
  settings.start->heading_deg = std::nullopt;
  const GlobalLocalizer localizer(kWalls, kCamera, settings);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Particle& particle : localizer.particles()) {
    sum += direction_of(particle.pose.heading_rad);
    EXPECT_LT((particle.pose.enu_m - Eigen::Vector2d(10, 20)).norm(), 12);
  }
  EXPECT_LT(sum.norm(), 0.1 * static_cast<double>(localizer.particles().size()));
}

}  // namespace
}  // namespace milepost
