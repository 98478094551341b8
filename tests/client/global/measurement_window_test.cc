#include "client/global/measurement_window.h"

#include <gtest/gtest.h>

#include <numbers>

namespace milepost {
namespace {

WallObservation with_beams(std::size_t count) {
  WallObservation observation;
  for (std::size_t i = 0; i < count; ++i) {
    observation.beams.push_back({0.01 * static_cast<double>(i), 10, 0.1});
  }
  return observation;
}

class MeasurementWindowTest : public ::testing::Test {
 protected:
  // Drives steps of 1 m, turning evenly; returns the number of observations kept.
  int drive(int steps, double turn_rad = 0) {
    int kept = 0;
    for (int i = 0; i < steps; ++i) {
      const OdometryIncrement motion{0.2, 1, turn_rad / steps};
      pose_ = moved(pose_, motion.distance_m, motion.turn_rad);
      kept += window_.add(with_beams(7), motion) ? 1 : 0;
    }
    return kept;
  }

  MeasurementWindow window_{MeasurementWindowSettings{.step_m = 3, .distance_m = 40}};
  Pose2 pose_{{100, 200}, 0.7};
};

TEST_F(MeasurementWindowTest, KeepsObservationsApart) {
  EXPECT_EQ(drive(10), 4);  // the first, and each third metre
  ASSERT_EQ(window_.measurements().size(), 4U);
  EXPECT_EQ(window_.measurements()[0].distance_m, 1);
  EXPECT_EQ(window_.measurements()[1].distance_m, 3);
}

TEST_F(MeasurementWindowTest, DrivingBackwardsCountsAsDistance) {
  for (int i = 0; i < 7; ++i) window_.add(with_beams(1), {0.2, -1, 0});
  ASSERT_EQ(window_.measurements().size(), 3U);
  EXPECT_EQ(window_.measurements().back().distance_m, 3);
  EXPECT_EQ(window_.measurements().back().driven_m, 7);
}

TEST_F(MeasurementWindowTest, KeepsOrientations) {
  WallObservation observation = with_beams(1);
  observation.sections = {{{-0.1, 0.1}, {0.7}}};
  window_.add(observation, {0.2, 1, 0});
  ASSERT_EQ(window_.measurements().front().observation.sections.size(), 1U);
  EXPECT_EQ(window_.measurements().front().observation.sections[0].orientations_rad.front(), 0.7);
}

TEST_F(MeasurementWindowTest, KeepsNoneWithoutBeams) {
  EXPECT_FALSE(window_.add(with_beams(0), {0.2, 5, 0}));
  EXPECT_TRUE(window_.add(with_beams(1), {0.2, 1, 0}));
  EXPECT_EQ(window_.measurements().front().distance_m, 6);
}

TEST_F(MeasurementWindowTest, DiscardsOldObservations) {
  drive(200);
  ASSERT_FALSE(window_.measurements().empty());
  EXPECT_GE(window_.measurements().front().driven_m, 200 - 40 - 3);
  EXPECT_LE(window_.measurements().size(), 15U);
}

TEST_F(MeasurementWindowTest, ThinsTheBeams) {
  drive(1);
  const std::vector<Beam>& beams = window_.measurements().front().observation.beams;
  ASSERT_EQ(beams.size(), 3U);  // of seven, the first, the fourth and the seventh
  EXPECT_EQ(beams[1].bearing_rad, 0.03);
}

// The past pose relative to the current one is that of odometry.
TEST_F(MeasurementWindowTest, GivesThePastPose) {
  drive(10);
  const Pose2 then = pose_;
  drive(12, std::numbers::pi / 2);
  drive(5);
  std::size_t found = 0;
  for (const PastMeasurement& past : window_.measurements()) {
    if (past.driven_m != 10) continue;
    ++found;
    const Pose2 pose = window_.pose_at(pose_, 1, past);
    EXPECT_NEAR((pose.enu_m - then.enu_m).norm(), 0, 1e-9);
    EXPECT_NEAR(pose.heading_rad, then.heading_rad, 1e-9);
  }
  EXPECT_EQ(found, 1U);
}

TEST_F(MeasurementWindowTest, DistancesAreOdometryUntilScaled) {
  drive(10);
  const PastMeasurement& first = window_.measurements().front();
  EXPECT_EQ(first.driven_m, 1);
  const Pose2 pose = window_.pose_at(pose_, 1.5, first);
  EXPECT_NEAR((pose_.enu_m - pose.enu_m).norm(), 1.5 * 9, 1e-9);
  EXPECT_NEAR(pose.heading_rad, pose_.heading_rad, 1e-9);
}

}  // namespace
}  // namespace milepost
