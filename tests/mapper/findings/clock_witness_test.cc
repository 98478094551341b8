#include "mapper/findings/clock_witness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

using ::testing::DoubleNear;
using ::testing::Optional;

constexpr double kIntervalS = 0.1;

// What the images of 60 frames say of a record that is late by so much, to 0.05 degrees.
std::vector<WitnessedHeading> headings(const std::function<double(double)>& heading_deg,
                                       double late_s) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.05);
  std::vector<WitnessedHeading> all;
  const LocalFrame local({49, 8.4, 100});
  EnuPoint at{0, 0, 0};
  for (int i = 0; i < 60; ++i) {
    const double at_s = kIntervalS * i;
    all.push_back({{at_s, {local.geo_from_enu(at), wrapped_360(heading_deg(at_s + late_s))}},
                   wrapped_360(heading_deg(at_s) + 2 + noise(random))});  // yawed by 2 degrees
    const double course_rad = heading_deg(at_s + late_s + kIntervalS / 2) * kRadPerDeg;
    at.east_m += std::sin(course_rad);
    at.north_m += std::cos(course_rad);
  }
  return all;
}

double begins_to_turn(double at_s) { return at_s < 4 ? 350 : 350 + 8 * (at_s - 4) * (at_s - 4); }
double winds(double at_s) { return 90 + 10 * std::sin(at_s); }

TEST(ClockWitness, TurnsTellHowLateTheRecordIs) {
  EXPECT_THAT(clock_offset_s(headings(begins_to_turn, 0.3)), Optional(DoubleNear(0.3, 0.03)));
  EXPECT_THAT(clock_offset_s(headings(begins_to_turn, -0.25)), Optional(DoubleNear(-0.25, 0.03)));
  EXPECT_THAT(clock_offset_s(headings(winds, 0.8)), Optional(DoubleNear(0.8, 0.03)));
}

TEST(ClockWitness, ARecordInTimeIsLeftAlone) {
  EXPECT_FALSE(clock_offset_s(headings(begins_to_turn, 0)).has_value());
  EXPECT_FALSE(clock_offset_s(headings(winds, 0.02)).has_value());
  EXPECT_FALSE(clock_offset_s({}).has_value());
}

TEST(ClockWitness, AnOffsetBeyondWhatIsTriedIsNotTaken) {
  EXPECT_FALSE(clock_offset_s(headings(winds, 1.4)).has_value());
}

TEST(ClockWitness, AStraightDriveTellsNothing) {
  const auto straight = [](double at_s) { return 90 + 0.3 * at_s; };
  EXPECT_FALSE(clock_offset_s(headings(straight, 1)).has_value());
}

// As of a receiver that tells its course late: its positions are in time.
TEST(ClockWitness, HeadingsThatAloneAreLateAreNoOffset) {
  std::vector<WitnessedHeading> late = headings(winds, 0.8);
  const std::vector<WitnessedHeading> in_time = headings(winds, 0);
  for (std::size_t i = 0; i < late.size(); ++i)
    late[i].recorded.attitude.position = in_time[i].recorded.attitude.position;
  EXPECT_FALSE(clock_offset_s(late).has_value());
}

// Headings that vary, or are wrong in another way, are no matter of time.
TEST(ClockWitness, NoiseIsNoOffset) {
  std::vector<WitnessedHeading> noisy = headings(winds, 0);
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0, 5);
  for (WitnessedHeading& heading : noisy) heading.recorded.attitude.heading_deg += noise(random);
  EXPECT_FALSE(clock_offset_s(noisy).has_value());
}

TEST(ClockWitness, FramesGetThePosesOfEarlier) {
  Drive drive;
  const LocalFrame local({49, 8.4, 100});
  for (int i = 0; i < 10; ++i) {
    Frame frame;
    frame.filename = std::to_string(i);
    frame.timestamp_s = kIntervalS * i;
    frame.position = local.geo_from_enu({0, 2.0 * i, 0});
    frame.heading_deg = wrapped_360(355 + 2.0 * i);
    drive.frames.push_back(frame);
  }
  const Drive moved = with_poses_of(drive, 0.15);
  ASSERT_EQ(moved.frames.size(), 8U);  // the first two have none
  const Frame& first = moved.frames.front();
  EXPECT_EQ(first.filename, "2");
  EXPECT_EQ(first.timestamp_s, 0.2);
  EXPECT_NEAR(local.enu_from_geo(first.position).north_m, 1, 1e-6);
  EXPECT_NEAR(first.heading_deg, 356, 1e-6);
  EXPECT_NEAR(with_poses_of(drive, -0.15).frames.front().heading_deg, 358, 1e-6);
}

}  // namespace
}  // namespace milepost
