#include "mapper/geodata/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost {
namespace {

const LocalFrame kLocal({49, 8.4, 110});

RecordedPose pose(double timestamp_s, const EnuPoint& at, double heading_deg = 0) {
  return {timestamp_s, {kLocal.geo_from_enu(at), heading_deg}};
}

TEST(Trajectory, LiesBetweenItsPoses) {
  const Trajectory trajectory({pose(2, {0, 20, 4}, 10), pose(1, {0, 10, 2}, 350)}, 1);
  const auto at = trajectory.at(1.25);
  ASSERT_TRUE(at);
  const EnuPoint enu = kLocal.enu_from_geo(at->position);
  EXPECT_NEAR(enu.east_m, 0, 1e-4);
  EXPECT_NEAR(enu.north_m, 12.5, 1e-4);
  EXPECT_NEAR(enu.up_m, 2.5, 1e-4);
  EXPECT_NEAR(at->heading_deg, 355, 1e-9);  // the short way round
  EXPECT_NEAR(trajectory.at(2)->heading_deg, 10, 1e-9);
}

TEST(Trajectory, EndsAndHasGaps) {
  const Trajectory trajectory(
      {pose(1, {0, 0, 0}), pose(2, {0, 10, 0}), pose(5, {0, 40, 0}), pose(5, {9, 9, 9})}, 1);
  EXPECT_FALSE(trajectory.at(0.99));
  EXPECT_FALSE(trajectory.at(5.01));
  EXPECT_FALSE(trajectory.at(3));
  EXPECT_TRUE(trajectory.at(5));
  ASSERT_EQ(trajectory.gaps().size(), 1U);
  EXPECT_EQ(trajectory.gaps()[0].from_s, 2);
  EXPECT_EQ(trajectory.gaps()[0].to_s, 5);
  EXPECT_EQ(trajectory.poses().size(), 3U);  // of two at one time the first
}

TEST(Trajectory, HeadingsFollowTheMotion) {
  std::vector<RecordedPose> poses;
  for (int i = 0; i < 5; ++i) poses.push_back(pose(i, {0, 0, 0}));         // standing
  for (int i = 5; i < 15; ++i) poses.push_back(pose(i, {i - 4.0, 0, 0}));  // eastwards
  for (int i = 15; i < 20; ++i) poses.push_back(pose(i, {10, 0, 0}));
  for (int i = 20; i < 30; ++i) poses.push_back(pose(i, {10, 19.0 - i, 0}));  // southwards
  Trajectory trajectory(std::move(poses), 1);
  trajectory.set_headings_by_motion();
  for (const double standing_or_east_s : {0.0, 4.0, 8.0, 12.0})
    EXPECT_NEAR(trajectory.at(standing_or_east_s)->heading_deg, 90, 0.1) << standing_or_east_s;
  for (const double south_s : {24.0, 29.0})
    EXPECT_NEAR(trajectory.at(south_s)->heading_deg, 180, 0.1) << south_s;
}

}  // namespace
}  // namespace milepost
