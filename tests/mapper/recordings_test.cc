// Drives that are copies of others, and drives of two cameras of one vehicle.
#include "mapper/pipeline/recordings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mapper/findings/rounded_positions.h"
#include "tests/mapper/noise_drive.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::noise_drive;
using testing::TempFolder;

constexpr int kFrames = 60;

class Recordings : public ::testing::Test {
 protected:
  Drive drive(const std::string& name, int seed) const {
    return noise_drive(folder_.path(), name, kFrames, seed);
  }
  static Drive named(Drive drive, const std::string& name) {
    drive.name = name;
    return drive;
  }
  // Moved in metres east and north; `wave_m` is added to and from over some 100 m.
  static Drive moved(Drive drive, double east_m, double wave_m) {
    for (std::size_t i = 0; i < drive.frames.size(); ++i) {
      GeoPoint& position = drive.frames[i].position;
      const double off_m = east_m + wave_m * std::sin(static_cast<double>(i) / 8);
      position = LocalFrame(position).geo_from_enu({off_m, 0, 0});
    }
    return drive;
  }
  static std::vector<std::string> kept(const std::vector<Drive>& drives,
                                       std::vector<Finding>* findings = nullptr) {
    std::vector<const Drive*> given;
    for (const Drive& drive : drives) given.push_back(&drive);
    std::vector<Finding> found;
    std::vector<std::string> names;
    for (const Drive* drive : without_copies(given, found)) names.push_back(drive->name);
    if (findings != nullptr) *findings = found;
    return names;
  }
  // What is known of drives whose frames are each one stretch.
  static RecordedErrors known_of(const std::vector<Drive>& drives) {
    BuildPlan plan;
    for (const Drive& drive : drives) {
      std::vector<GeoPoint> vertices;
      std::vector<std::size_t> frames;
      for (std::size_t i = 0; i < drive.frames.size(); ++i) {
        vertices.push_back(drive.frames[i].position);
        frames.push_back(i);
      }
      StretchPlan stretch{frames, RouteLine::from_vertices(vertices).value(), {}, {}};
      plan.drives.push_back({&drive, {stretch}});
    }
    return recorded_errors(plan, {});
  }

  TempFolder folder_;
};

TEST_F(Recordings, ACopyIsLeftOutWithAFinding) {
  const Drive original = drive("a", 1);
  std::vector<Finding> findings;
  EXPECT_THAT(kept({original, named(original, "b"), drive("c", 3)}, &findings),
              ElementsAre("a", "c"));
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].where, "drive 'b'");
  EXPECT_THAT(findings[0].what, HasSubstr("are those of drive 'a'"));
}

TEST_F(Recordings, APartOfADriveIsACopyOfIt) {
  const Drive original = drive("b", 1);
  Drive half = named(original, "a");
  half.frames.erase(half.frames.begin(), half.frames.begin() + kFrames / 2);
  EXPECT_THAT(kept({half, original}), ElementsAre("b"));
}

TEST_F(Recordings, WhatOnlyLooksAlikeStays) {
  const Drive original = drive("a", 1);
  EXPECT_THAT(kept({original, drive("b", 2)}), ElementsAre("a", "b"));  // other images
  EXPECT_THAT(kept({original, moved(named(original, "b"), 0.1, 0)}), ElementsAre("a", "b"));
  Drive later = named(original, "b");
  for (Frame& frame : later.frames) frame.timestamp_s += 100;
  EXPECT_THAT(kept({original, later}), ElementsAre("a", "b"));
}

TEST_F(Recordings, TwoCamerasOfOneVehicleHaveOneError) {
  Drive right = moved(drive("right", 2), 0.54, 0);
  right.frames.resize(50);
  const RecordedErrors known = known_of({right, drive("left", 1), drive("other", 3)});
  EXPECT_EQ(known.drives[0].bias, known.drives[1].bias);
  ASSERT_TRUE(known.stretches[0].same_way);
  EXPECT_EQ(known.stretches[0].same_way->stretch, 1U);
  EXPECT_NEAR(known.stretches[0].same_way->there.to_m, 98, 0.1);
  EXPECT_FALSE(known.stretches[1].same_way);
}

TEST_F(Recordings, PositionsThatDriftApartAreOfTwoReceivers) {
  const RecordedErrors known = known_of({drive("a", 1), moved(drive("b", 2), 0.5, 0.1)});
  EXPECT_NE(known.drives[0].bias, known.drives[1].bias);
  EXPECT_FALSE(known.stretches[0].same_way || known.stretches[1].same_way);
}

TEST_F(Recordings, ImagesThatWerePlacedTwiceHaveTwoErrors) {
  const Drive original = drive("a", 1);
  const RecordedErrors known = known_of({original, moved(named(original, "b"), 0.3, 0)});
  EXPECT_NE(known.drives[0].bias, known.drives[1].bias);
  EXPECT_FALSE(known.stretches[1].same_way);
}

TEST_F(Recordings, DrivesOfOneGroupHaveOneBias) {
  std::vector<Drive> drives = {drive("a", 1), drive("b", 2), drive("c", 3)};
  for (Drive& each : drives) {
    for (Frame& frame : each.frames) frame.timestamp_s += 100 * (each.name[0] - 'a');
  }
  drives[0].position_error.group = drives[2].position_error.group = "receiver 7";
  drives[1].position_error.sigma_m = 0.05;
  const RecordedErrors known = known_of(drives);
  EXPECT_EQ(known.drives[0].bias, known.drives[2].bias);
  EXPECT_NE(known.drives[0].bias, known.drives[1].bias);
  EXPECT_EQ(known.drives[1].sigma_m, 0.05);
  EXPECT_THAT(known.stretches[0].sigma_factors, IsEmpty());
}

// To the north-east, in steps that are no multiples of anything.
TEST_F(Recordings, RoundedPositionsAreKnownAndCounted) {
  Drive rounded = drive("a", 1);
  const LocalFrame local({49, 8.4, 110});
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double way_m = 1.37 * static_cast<double>(i);
    rounded.frames[i].position = local.geo_from_enu({way_m, way_m, 0});
  }
  EXPECT_EQ(rounding_step_m(rounded), 0);
  EXPECT_EQ(known_of({rounded}).drives[0].sigma_m, std::nullopt);
  const auto round = [&](double steps_a_degree) {
    Drive drive = rounded;
    for (Frame& frame : drive.frames) {
      GeoPoint& position = frame.position;
      position.latitude_deg = std::round(position.latitude_deg * steps_a_degree) / steps_a_degree;
      position.longitude_deg = std::round(position.longitude_deg * steps_a_degree) / steps_a_degree;
    }
    return drive;
  };
  EXPECT_NEAR(rounding_step_m(round(1e5)), 1.11, 0.01);
  EXPECT_NEAR(*known_of({round(1e5)}).drives[0].sigma_m, std::hypot(0.18, 0.32), 0.01);
  EXPECT_NEAR(rounding_step_m(round(1e6)), 0.11, 0.01);
  EXPECT_EQ(rounding_step_m(round(1e7)), 0);
  Drive metres = rounded;
  metres.position_frame = PositionFrame::local;
  metres.origin = GeoPoint{49, 8.4, 110};
  EXPECT_EQ(rounding_step_m(metres), 0);
  for (std::size_t i = 0; i < kFrames; ++i) {
    const double way_m = std::round(13.7 * static_cast<double>(i)) / 10;
    metres.frames[i].position = local.geo_from_enu({way_m, way_m, 0});
  }
  EXPECT_NEAR(rounding_step_m(metres), 0.1, 1e-9);
}

TEST_F(Recordings, FramesStateWhereADriveIsWorse) {
  Drive stating = drive("a", 1);
  for (std::size_t i = 0; i < kFrames; ++i)
    stating.frames[i].position_sigma_m = i < kFrames / 2 ? 0.1 : 0.7;
  const RecordedErrors known = known_of({stating});
  ASSERT_TRUE(known.drives[0].sigma_m);
  EXPECT_NEAR(*known.drives[0].sigma_m, 0.5, 1e-9);
  const std::vector<double>& factors = known.stretches[0].sigma_factors;
  ASSERT_EQ(factors.size(), node_count(118, {}));
  EXPECT_NEAR(factors.front() * *known.drives[0].sigma_m, 0.1, 1e-9);
  EXPECT_NEAR(factors.back() * *known.drives[0].sigma_m, 0.7, 1e-9);
}

}  // namespace
}  // namespace milepost
