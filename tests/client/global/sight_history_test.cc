#include "client/global/sight_history.h"

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

class SightHistoryTest : public ::testing::Test {
 protected:
  // Steps of 1 m, turning evenly; how many sights were kept.
  int drive(int steps, double turn_rad = 0) {
    int kept = 0;
    for (int i = 0; i < steps; ++i) {
      const WheelMotion motion{0.2, 1, turn_rad / steps};
      pose_ = moved(pose_, motion.distance_m, motion.turn_rad);
      kept += history_.add(with_beams(7), motion) ? 1 : 0;
    }
    return kept;
  }

  SightHistory history_{HistorySettings{.step_m = 3, .way_m = 40}};
  PlanPose pose_{{100, 200}, 0.7};
};

TEST_F(SightHistoryTest, KeepsSightsApart) {
  EXPECT_EQ(drive(10), 4);  // the first, and each third metre
  ASSERT_EQ(history_.sights().size(), 4U);
  EXPECT_EQ(history_.sights()[0].way_m, 1);
  EXPECT_EQ(history_.sights()[1].way_m, 3);
}

TEST_F(SightHistoryTest, BackwardsIsAWayToo) {
  for (int i = 0; i < 7; ++i) history_.add(with_beams(1), {0.2, -1, 0});
  ASSERT_EQ(history_.sights().size(), 3U);
  EXPECT_EQ(history_.sights().back().way_m, 3);
  EXPECT_EQ(history_.sights().back().driven_m, 7);
}

TEST_F(SightHistoryTest, KeepsOrientations) {
  WallObservation observation = with_beams(1);
  observation.sections = {{{-0.1, 0.1}, {0.7}}};
  history_.add(observation, {0.2, 1, 0});
  ASSERT_EQ(history_.sights().front().observation.sections.size(), 1U);
  EXPECT_EQ(history_.sights().front().observation.sections[0].orientations_rad.front(), 0.7);
}

TEST_F(SightHistoryTest, KeepsNoneWithoutBeams) {
  EXPECT_FALSE(history_.add(with_beams(0), {0.2, 5, 0}));
  EXPECT_TRUE(history_.add(with_beams(1), {0.2, 1, 0}));
  EXPECT_EQ(history_.sights().front().way_m, 6);
}

TEST_F(SightHistoryTest, ForgetsTheWayFarBehind) {
  drive(200);
  ASSERT_FALSE(history_.sights().empty());
  EXPECT_GE(history_.sights().front().driven_m, 200 - 40 - 3);
  EXPECT_LE(history_.sights().size(), 15U);
}

TEST_F(SightHistoryTest, ThinsTheBeams) {
  drive(1);
  const std::vector<Beam>& beams = history_.sights().front().observation.beams;
  ASSERT_EQ(beams.size(), 3U);  // of seven, the first, the fourth and the seventh
  EXPECT_EQ(beams[1].bearing_rad, 0.03);
}

// Whatever the pose now, the one then lies as far behind and to the side as the wheels went.
TEST_F(SightHistoryTest, TellsWhereItWasThen) {
  drive(10);
  const PlanPose then = pose_;
  drive(12, std::numbers::pi / 2);
  drive(5);
  std::size_t found = 0;
  for (const PastSight& sight : history_.sights()) {
    if (sight.driven_m != 10) continue;
    ++found;
    const PlanPose pose = history_.pose_then(pose_, 1, sight);
    EXPECT_NEAR((pose.enu_m - then.enu_m).norm(), 0, 1e-9);
    EXPECT_NEAR(pose.heading_rad, then.heading_rad, 1e-9);
  }
  EXPECT_EQ(found, 1U);
}

TEST_F(SightHistoryTest, ItsWayIsTheWheelsUntilScaled) {
  drive(10);
  const PastSight& first = history_.sights().front();
  EXPECT_EQ(first.driven_m, 1);
  const PlanPose pose = history_.pose_then(pose_, 1.5, first);
  EXPECT_NEAR((pose_.enu_m - pose.enu_m).norm(), 1.5 * 9, 1e-9);
  EXPECT_NEAR(pose.heading_rad, pose_.heading_rad, 1e-9);
}

}  // namespace
}  // namespace milepost
