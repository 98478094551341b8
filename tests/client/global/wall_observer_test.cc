#include "client/global/wall_observer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/client/global/painted_wall.h"

namespace milepost {
namespace {

using testing::kCamera;
using testing::kWallM;
using testing::painted_wall;
using testing::seen;

// The distance of the wall ahead by the beams: their median, in plan view.
double wall_ahead_m(const std::vector<Beam>& beams) {
  std::vector<double> ahead_m;
  ahead_m.reserve(beams.size());
  for (const Beam& beam : beams) ahead_m.push_back(beam.range_m * std::cos(beam.bearing_rad));
  std::ranges::sort(ahead_m);
  return ahead_m[ahead_m.size() / 2];
}

TEST(WallObserver, SeesHowAWallIsTurnedAndHowFarItStands) {
  const cv::Mat wall = painted_wall();
  WallObserver observer(kCamera, {});
  EXPECT_TRUE(observer.observe(seen(wall, 0, 0), {}).beams.empty());
  observer.observe(seen(wall, 1, 0), {0.2, 1, 0});
  const WallObservation observation = observer.observe(seen(wall, 2, 0), {0.2, 1, 0});
  double seen_rad = 0;
  double across_rad = 0;
  for (const ViewSection& section : observation.sections) {
    const bool is_across = std::ranges::any_of(section.orientations_rad, [](double rad) {
      return std::abs(std::remainder(rad - std::numbers::pi / 2, std::numbers::pi)) < 0.05;
    });
    seen_rad += section.bearings.width_rad();
    across_rad += is_across ? section.bearings.width_rad() : 0;
  }
  EXPECT_GT(seen_rad, 0.5);  // of a view of 1.4
  EXPECT_GT(across_rad, 0.6 * seen_rad);
  ASSERT_GT(observation.beams.size(), 20U);
  EXPECT_NEAR(wall_ahead_m(observation.beams), kWallM - 2, 0.4);
}

// For a camera that looks up the wall's points are nearer than in plan view.
TEST(WallObserver, ATiltedCamerasBeamsAreLevel) {
  const cv::Mat wall = painted_wall();
  const double up_rad = 0.2;
  WallObserver observer(kCamera, {});
  for (const double ahead_m : {0.0, 1.0}) {
    observer.observe(seen(wall, ahead_m, 0, up_rad), {0.2, ahead_m, 0});
  }
  const WallObservation observation = observer.observe(seen(wall, 2, 0, up_rad), {0.2, 1, 0});
  ASSERT_GT(observation.beams.size(), 20U);
  EXPECT_NEAR(wall_ahead_m(observation.beams), kWallM - 2, 0.4);
}

TEST(WallObserver, WithoutBeamsOrientationsAreLeft) {
  const cv::Mat wall = painted_wall();
  ObserverSettings settings;
  settings.with_beams = false;
  WallObserver observer(kCamera, settings);
  observer.observe(seen(wall, 0, 0), {});
  const WallObservation observation = observer.observe(seen(wall, 1, 0), {0.2, 1, 0});
  EXPECT_TRUE(observation.beams.empty());
  EXPECT_FALSE(observation.sections.empty());
}

}  // namespace
}  // namespace milepost
