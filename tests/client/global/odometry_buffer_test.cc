#include "client/global/odometry_buffer.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace milepost {
namespace {

TEST(OdometryBuffer, AReadingHoldsUntilTheNext) {
  OdometryBuffer log;
  log.add({10, 4, 0});
  log.motion_until(10);
  log.add({10.5, 6, 90});
  const OdometryIncrement motion = log.motion_until(11);
  EXPECT_DOUBLE_EQ(motion.duration_s, 1);
  EXPECT_DOUBLE_EQ(motion.distance_m, 0.5 * 4 + 0.5 * 6);
  EXPECT_DOUBLE_EQ(motion.turn_rad, std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(log.motion_until(11.5).distance_m, 3);
}

TEST(OdometryBuffer, ItBeginsWithTheFirstCall) {
  OdometryBuffer log;
  log.add({0, 10, 0});
  const OdometryIncrement motion = log.motion_until(5);
  EXPECT_EQ(motion.duration_s, 0);
  EXPECT_EQ(motion.distance_m, 0);
}

TEST(OdometryBuffer, AReadingThatComesLateHoldsFromThenOn) {
  OdometryBuffer log;
  log.add({1, 2, 0});
  log.motion_until(2);
  log.add({1.5, 4, 0});
  const OdometryIncrement motion = log.motion_until(3);
  EXPECT_DOUBLE_EQ(motion.duration_s, 1);
  EXPECT_DOUBLE_EQ(motion.distance_m, 4);
}

TEST(OdometryBuffer, WithoutReadingsTimePassesOnly) {
  OdometryBuffer log;
  log.motion_until(1);
  const OdometryIncrement motion = log.motion_until(3);
  EXPECT_EQ(motion.duration_s, 2);
  EXPECT_EQ(motion.distance_m, 0);
}

TEST(OdometryBuffer, ReadingsThatAreNoneOrGoBackAreLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  OdometryBuffer log;
  log.add({1, 2, 0});
  log.motion_until(1);
  log.add({1.5, nan, 0});
  log.add({1.6, 1, nan});
  log.add({nan, 1, 0});
  log.add({0.5, 100, 100});
  log.add({1, 100, 100});
  const OdometryIncrement motion = log.motion_until(2);
  EXPECT_DOUBLE_EQ(motion.distance_m, 2);
  EXPECT_EQ(motion.turn_rad, 0);
}

}  // namespace
}  // namespace milepost
