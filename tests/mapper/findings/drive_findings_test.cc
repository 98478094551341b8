#include "mapper/findings/drive_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "mapper/findings/heading_findings.h"
#include "mapper/findings/position_findings.h"
#include "schema/geo/geodesy.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const GeoPoint kOrigin{49, 8.4, 110};

// A drive along a bending, climbing road, as exact as it can be recorded: a frame each 2 m, 0.2 s.
Drive sound_drive() {
  Drive drive;
  drive.folder = "drive";
  drive.name = "a";
  drive.camera = {600, 500, {400, 400, 300, 250}};
  const LocalFrame local(kOrigin);
  double east_m = 30;
  double north_m = -20;
  double heading_deg = 20;
  for (int i = 0; i < 80; ++i) {
    Frame frame;
    frame.filename = std::to_string(i) + ".jpg";
    frame.timestamp_s = 0.2 * i;
    frame.line = static_cast<std::size_t>(i) + 2;
    frame.position = local.geo_from_enu({east_m, north_m, 0.04 * i + std::sin(i / 9.0)});
    frame.heading_deg = wrapped_360(heading_deg);
    drive.frames.push_back(frame);
    const double turn_deg = i > 25 && i < 45 ? 4 : 0.2;
    const double course_rad = (heading_deg + turn_deg / 2) * kRadPerDeg;
    east_m += 2 * std::sin(course_rad);
    north_m += 2 * std::cos(course_rad);
    heading_deg += turn_deg;
  }
  return drive;
}

// The same with each frame changed.
Drive changed(const std::function<void(Frame&, std::mt19937&)>& change) {
  Drive drive = sound_drive();
  std::mt19937 random(3);
  for (Frame& frame : drive.frames) change(frame, random);
  return drive;
}

void move(Frame& frame, const EnuPoint& by) {
  frame.position = LocalFrame(frame.position).geo_from_enu(by);
}

double normal(std::mt19937& random, double sigma) {
  return std::normal_distribution<double>(0, sigma)(random);
}

std::vector<Finding> table_findings(const Drive& drive) {
  const std::vector<Step> steps = steps_of(drive);
  std::vector<Finding> findings = position_findings(drive, steps);
  for (Finding& finding : heading_findings(drive, steps)) findings.push_back(std::move(finding));
  return findings;
}

std::vector<std::string> kinds_of(const Drive& drive) {
  std::vector<std::string> kinds;
  for (const Finding& finding : table_findings(drive)) {
    EXPECT_EQ(finding.where, "drive/trajectory.csv");
    EXPECT_GE(finding.line, 2U);
    EXPECT_GE(finding.count, 1U);
    EXPECT_FALSE(finding.hint.empty());
    kinds.push_back(finding.kind);
  }
  return kinds;
}

// Positions as they are in the tangent frame of kOrigin, changed.
Drive replaced(const std::function<EnuPoint(const EnuPoint&)>& change) {
  const LocalFrame local(kOrigin);
  return changed([&](Frame& frame, std::mt19937&) {
    frame.position = local.geo_from_enu(change(local.enu_from_geo(frame.position)));
  });
}

TEST(DriveFindings, ASoundDriveHasNone) {
  EXPECT_THAT(kinds_of(sound_drive()), IsEmpty());
  Drive standing = sound_drive();
  standing.frames.resize(1);
  EXPECT_THAT(kinds_of(standing), IsEmpty());
}

TEST(DriveFindings, WhatVehiclesDoIsNone) {
  // Noise of a good receiver and of a shaking camera.
  EXPECT_THAT(kinds_of(changed([](Frame& frame, std::mt19937& random) {
                move(frame, {normal(random, 0.02), normal(random, 0.02), normal(random, 0.02)});
                frame.heading_deg += normal(random, 0.5);
              })),
              IsEmpty());
  // A camera mounted askew, which is stated.
  Drive askew = changed([](Frame& frame, std::mt19937&) { frame.heading_deg += 15; });
  askew.camera.mounting.yaw_deg = 15;
  EXPECT_THAT(kinds_of(askew), IsEmpty());
  // A stop of a minute without drift.
  Drive stopped = sound_drive();
  for (std::size_t i = 30; i < stopped.frames.size(); ++i) stopped.frames[i].timestamp_s += 60;
  EXPECT_THAT(kinds_of(stopped), IsEmpty());
}

TEST(DriveFindings, HeadingsThatVary) {
  const Drive drive =
      changed([](Frame& frame, std::mt19937& random) { frame.heading_deg += normal(random, 5); });
  ASSERT_THAT(kinds_of(drive), ElementsAre("heading_noise"));
  EXPECT_THAT(table_findings(drive)[0].what,
              ::testing::ContainsRegex("vary by [3-7].[0-9] degrees"));
}

TEST(DriveFindings, HeadingsThatPointElsewhere) {
  const Drive turned = changed([](Frame& frame, std::mt19937&) { frame.heading_deg += 30; });
  ASSERT_THAT(kinds_of(turned), ElementsAre("heading_offset"));
  EXPECT_THAT(table_findings(turned)[0].what, HasSubstr("turned by 30.0 degrees"));
  EXPECT_THAT(kinds_of(changed([](Frame& frame, std::mt19937&) { frame.heading_deg += 180; })),
              ElementsAre("reversed_camera"));
  EXPECT_THAT(kinds_of(changed([](Frame& frame, std::mt19937&) {
                frame.heading_deg = wrapped_360(frame.heading_deg) * kRadPerDeg;
              })),
              ElementsAre("heading_in_radians"));
  EXPECT_THAT(kinds_of(changed([](Frame& frame, std::mt19937&) {
                frame.heading_deg = 360 - frame.heading_deg;
              })),
              ElementsAre("mirrored_axis"));
}

TEST(DriveFindings, AVehicleThatIsRolled) {
  const auto rolled = [](double roll_deg) {
    Drive drive = changed([&](Frame& frame, std::mt19937&) { frame.roll_deg = roll_deg; });
    return kinds_of(drive);
  };
  EXPECT_THAT(rolled(-11.8), ElementsAre("tilted"));
  EXPECT_THAT(rolled(4), IsEmpty());
  Drive mounted = changed([](Frame& frame, std::mt19937&) { frame.roll_deg = 30; });
  mounted.camera.mounting.roll_deg = 30;
  EXPECT_THAT(kinds_of(mounted), IsEmpty());
}

TEST(DriveFindings, AxesThatAreExchanged) {
  EXPECT_THAT(kinds_of(replaced([](const EnuPoint& at) {
                return EnuPoint{at.north_m, at.east_m, at.up_m};
              })),
              ElementsAre("exchanged_axes"));
  EXPECT_THAT(kinds_of(replaced([](const EnuPoint& at) {
                return EnuPoint{-at.east_m, at.north_m, at.up_m};
              })),
              ElementsAre("mirrored_axis"));
  EXPECT_THAT(kinds_of(replaced([](const EnuPoint& at) {
                return EnuPoint{at.east_m, -at.north_m, at.up_m};
              })),
              ElementsAre("mirrored_axis"));
}

TEST(DriveFindings, LatitudeForLongitude) {
  EXPECT_THAT(kinds_of(changed([](Frame& frame, std::mt19937&) {
                std::swap(frame.position.latitude_deg, frame.position.longitude_deg);
              })),
              ElementsAre("exchanged_axes"));
}

TEST(DriveFindings, PositionsThatVary) {
  const Drive drive = changed([](Frame& frame, std::mt19937& random) {
    move(frame, {normal(random, 0.3), normal(random, 0.3), 0});
  });
  ASSERT_THAT(kinds_of(drive), ::testing::Contains("position_noise"));
  EXPECT_THAT(table_findings(drive)[0].what, ::testing::ContainsRegex("vary by 0.[2-4][0-9] m"));
  // Every second one to the side, as a zig-zag.
  int i = 0;
  EXPECT_THAT(kinds_of(changed([&](Frame& frame, std::mt19937&) {
                move(frame, {i++ % 2 == 0 ? 0.2 : -0.2, 0, 0});
              })),
              ::testing::Contains("position_noise"));
}

TEST(DriveFindings, AltitudesThatVaryOrJump) {
  const Drive noisy = changed([](Frame& frame, std::mt19937& random) {
    move(frame, {0, 0, normal(random, 1)});
  });
  ASSERT_THAT(kinds_of(noisy), ElementsAre("altitude_noise"));
  const Drive jumping = changed([](Frame& frame, std::mt19937&) {
    if (frame.timestamp_s > 7.9) move(frame, {0, 0, 40});
  });
  ASSERT_THAT(kinds_of(jumping), ElementsAre("altitude_jump"));
  EXPECT_EQ(table_findings(jumping)[0].count, 1U);
  EXPECT_EQ(table_findings(jumping)[0].line, 42U);
}

TEST(DriveFindings, PositionsThatAreNone) {
  const Drive drive = changed([](Frame& frame, std::mt19937&) {
    if (frame.line == 10 || frame.line == 11) frame.position = {0, 0, 0};
  });
  const std::vector<Finding> findings = table_findings(drive);
  ASSERT_FALSE(findings.empty());
  EXPECT_EQ(findings[0].kind, "null_island");
  EXPECT_EQ(findings[0].line, 10U);
  EXPECT_EQ(findings[0].count, 2U);
}

TEST(DriveFindings, PositionsThatAreRounded) {
  EXPECT_THAT(kinds_of(changed([](Frame& frame, std::mt19937&) {
                const auto rounded = [](double deg) { return std::round(deg * 1e5) / 1e5; };
                frame.position.latitude_deg = rounded(frame.position.latitude_deg);
                frame.position.longitude_deg = rounded(frame.position.longitude_deg);
              })),
              ::testing::Contains("rounded_positions"));
}

TEST(DriveFindings, AMountingHidesNothingOfWhatWasRecorded) {
  Drive drive = changed([](Frame& frame, std::mt19937&) {
    const auto rounded = [](double deg) { return std::round(deg * 1e5) / 1e5; };
    frame.position.latitude_deg = rounded(frame.position.latitude_deg);
    frame.position.longitude_deg = rounded(frame.position.longitude_deg);
  });
  drive.camera.mounting = {1.2, 0.3, 0.5, 3, -1, 0};
  for (Frame& frame : drive.frames) {
    const GeoAttitude camera =
        camera_of_vehicle({frame.position, frame.heading_deg}, drive.camera.mounting);
    frame.position = camera.position;
    frame.heading_deg = camera.heading_deg;
    frame.pitch_deg = camera.pitch_deg;
    frame.roll_deg = camera.roll_deg;
  }
  EXPECT_THAT(kinds_of(drive), ::testing::Contains("rounded_positions"));
}

TEST(DriveFindings, PositionsThatComeLessOftenThanFrames) {
  Drive drive = sound_drive();
  for (std::size_t i = 0; i < drive.frames.size(); ++i)
    drive.frames[i].position = drive.frames[i - i % 4].position;
  EXPECT_THAT(kinds_of(drive), ::testing::Contains("repeated_positions"));
}

TEST(DriveFindings, FramesThatLieFarApart) {
  Drive drive = sound_drive();
  for (std::size_t i = 0; i < drive.frames.size(); ++i)
    if (i % 4 == 0) drive.frames[i / 4] = drive.frames[i];
  drive.frames.resize(drive.frames.size() / 4);
  ASSERT_THAT(kinds_of(drive), ElementsAre("sparse_frames"));
  EXPECT_THAT(table_findings(drive)[0].what, HasSubstr("8.0 m apart"));
}

TEST(DriveFindings, AStandingVehicleThatWanders) {
  Drive drive = sound_drive();
  const Frame stop = drive.frames[40];
  std::vector<Frame> standing;
  for (int i = 1; i <= 60; ++i) {
    Frame frame = stop;
    frame.timestamp_s += 0.3 * i;
    move(frame, {0.5 * std::sin(i / 6.0), 0.3 * std::cos(i / 5.0) - 0.3, 0});
    standing.push_back(frame);
  }
  for (std::size_t i = 41; i < drive.frames.size(); ++i) drive.frames[i].timestamp_s += 18;
  drive.frames.insert(drive.frames.begin() + 41, standing.begin(), standing.end());
  EXPECT_THAT(kinds_of(drive), ElementsAre("standstill"));
}

TEST(DriveFindings, AReceiverThatIsElsewhere) {
  Drive drive = sound_drive();
  for (const Frame& frame : drive.frames)
    if (frame.line % 5 == 0) drive.gps.push_back({frame.timestamp_s, frame.position, 5});
  EXPECT_THAT(kinds_of(drive), IsEmpty());
  for (GpsFix& fix : drive.gps) fix.position.latitude_deg += 0.001;
  ASSERT_THAT(kinds_of(drive), ElementsAre("receiver_apart"));
  EXPECT_THAT(table_findings(drive)[0].what, HasSubstr("gps.csv lies 111 m"));
}

}  // namespace
}  // namespace milepost
