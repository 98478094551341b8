#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "schema/drive/drive.h"
#include "tests/schema/drive/drive_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Drive geographic_drive() {
  Drive drive;
  drive.name = "a drive \"with\" quotes";
  drive.camera = {16, 12, 20.123456789, 21.5, 8, 6};
  drive.images = "frames";
  drive.source = "Straße";
  drive.position_error = {0.05, 80, "receiver 7"};
  drive.frames = {{"a.png", 0.1 + 0.2, {49.0123456789, 8.4123456789, 114.123456}, 12.3456},
                  {"b.png", 0.5, {49.0123556789, 8.4123456789, 114.2}, 0}};
  drive.frames[0].position_sigma_m = 0.02;
  drive.frames[1].position_sigma_m = 0.1;
  drive.gps = {{0.25, {49.01234, 8.41234, 0}, 4.7}};
  drive.odometry = {{0.2, 9.87654, -1.25}, {0.4, 9.9, 0}};
  return drive;
}

// Its frames are those of a camera ahead of the reference point, which is where they are written.
Drive drive_of_a_mounted_fisheye() {
  Drive drive = geographic_drive();
  drive.camera.lens = *Lens::make(LensModel::kannala_brandt, {-0.0123456789, 0.02, 0, 1e-7});
  drive.camera.mounting = {1.2, -0.3, 0.9, 3, -2, 1};
  drive.has_tilts = true;
  drive.frames[0].pitch_deg = 2.5;
  drive.frames[0].roll_deg = -1.25;
  return drive;
}

Drive local_drive() {
  Drive drive = geographic_drive();
  drive.position_frame = PositionFrame::local;
  drive.origin = GeoPoint{49.012, 8.412, 110};
  return drive;
}

void expect_same_place(const GeoPoint& a, const GeoPoint& b) {
  EXPECT_LT(geodesic_distance_m(a, b), 5e-6);
  EXPECT_NEAR(a.altitude_m, b.altitude_m, 2e-6);
}

void expect_same(const Drive& read, const Drive& written) {
  EXPECT_EQ(read.name, written.name);
  EXPECT_EQ(read.camera, written.camera);
  EXPECT_EQ(read.position_frame, written.position_frame);
  EXPECT_EQ(read.origin, written.origin);
  EXPECT_EQ(read.images, written.images);
  EXPECT_EQ(read.captured, written.captured);
  EXPECT_EQ(read.source, written.source);
  EXPECT_EQ(read.position_error.sigma_m, written.position_error.sigma_m);
  EXPECT_EQ(read.position_error.correlation_m, written.position_error.correlation_m);
  EXPECT_EQ(read.position_error.group, written.position_error.group);
  ASSERT_EQ(read.frames.size(), written.frames.size());
  for (std::size_t i = 0; i < read.frames.size(); ++i) {
    EXPECT_EQ(read.frames[i].filename, written.frames[i].filename);
    EXPECT_EQ(read.frames[i].timestamp_s, written.frames[i].timestamp_s);
    EXPECT_NEAR(read.frames[i].heading_deg, written.frames[i].heading_deg, 1e-6);
    EXPECT_NEAR(read.frames[i].pitch_deg, written.frames[i].pitch_deg, 2e-6);
    EXPECT_NEAR(read.frames[i].roll_deg, written.frames[i].roll_deg, 2e-6);
    EXPECT_EQ(read.frames[i].position_sigma_m, written.frames[i].position_sigma_m);
    expect_same_place(read.frames[i].position, written.frames[i].position);
  }
  ASSERT_EQ(read.gps.size(), written.gps.size());
  for (std::size_t i = 0; i < read.gps.size(); ++i) {
    EXPECT_EQ(read.gps[i].timestamp_s, written.gps[i].timestamp_s);
    EXPECT_EQ(read.gps[i].sigma_m, written.gps[i].sigma_m);
    expect_same_place(read.gps[i].position, written.gps[i].position);
  }
  ASSERT_EQ(read.odometry.size(), written.odometry.size());
  for (std::size_t i = 0; i < read.odometry.size(); ++i) {
    EXPECT_EQ(read.odometry[i].timestamp_s, written.odometry[i].timestamp_s);
    EXPECT_NEAR(read.odometry[i].speed_mps, written.odometry[i].speed_mps, 1e-6);
    EXPECT_NEAR(read.odometry[i].yaw_rate_dps, written.odometry[i].yaw_rate_dps, 1e-6);
  }
}

void expect_round_trip(const Drive& drive) {
  const DriveFolder folder;  // holds the images a.png and b.png
  const Status written = write_drive(drive, folder.path());
  ASSERT_TRUE(written.ok()) << written.error().line();
  const Result<Drive> read = read_drive(folder.path());
  ASSERT_TRUE(read.ok()) << read.error().line();
  expect_same(*read, drive);
}

TEST(WriteDrive, IsReadBackWithGeographicPositions) { expect_round_trip(geographic_drive()); }

TEST(WriteDrive, IsReadBackWithLocalPositions) { expect_round_trip(local_drive()); }

TEST(WriteDrive, IsReadBackWithLensAndMounting) { expect_round_trip(drive_of_a_mounted_fisheye()); }

TEST(WriteDrive, WritesTheSameBytesAgainAfterReading) {
  const DriveFolder folder;
  ASSERT_TRUE(write_drive(local_drive(), folder.path()).ok());
  const std::string first = folder.read("trajectory.csv");
  const Result<Drive> read = read_drive(folder.path());
  ASSERT_TRUE(read.ok()) << read.error().line();
  ASSERT_TRUE(write_drive(*read, folder.path()).ok());
  EXPECT_EQ(folder.read("trajectory.csv"), first);
}

TEST(WriteDrive, MakesTheFolder) {
  const DriveFolder folder;
  const auto inner = folder.path() / "x" / "y";
  ASSERT_TRUE(write_drive(geographic_drive(), inner).ok());
  EXPECT_TRUE(std::filesystem::exists(inner / "drive.json"));
}

TEST(WriteDrive, RemovesTablesOfAnEarlierDrive) {
  const DriveFolder folder;
  Drive drive = geographic_drive();
  ASSERT_TRUE(write_drive(drive, folder.path()).ok());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "gps.csv"));
  drive.gps.clear();
  ASSERT_TRUE(write_drive(drive, folder.path()).ok());
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "gps.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "odometry.csv"));
}

// Writes a drive after `damage`; returns the error line.
template <class Damage>
std::string refusal(Damage damage) {
  const DriveFolder folder;
  const auto out = folder.path() / "out";
  Drive drive = local_drive();
  damage(drive);
  const Status status = write_drive(drive, out);
  EXPECT_FALSE(std::filesystem::exists(out)) << "a refused drive must leave nothing";
  return status.ok() ? "accepted" : status.error().line();
}

TEST(WriteDriveRefuses, WhatTheReaderWouldRefuse) {
  EXPECT_THAT(refusal([](Drive& d) { d.origin.reset(); }),
              HasSubstr("drive.json: a local drive has no valid origin"));
  EXPECT_THAT(refusal([](Drive& d) { d.frames.clear(); }),
              HasSubstr("trajectory.csv: there is no frame"));
  EXPECT_THAT(refusal([](Drive& d) { d.frames[1].filename = "a,b.png"; }),
              HasSubstr("trajectory.csv, line 3: filename 'a,b.png' is not the plain name"));
  EXPECT_THAT(refusal([](Drive& d) { d.frames[1].position.latitude_deg = kNan; }),
              HasSubstr("trajectory.csv, line 3: latitude_deg nan is out of range"));
  EXPECT_THAT(refusal([](Drive& d) { d.frames[1].position.altitude_m = kNan; }),
              HasSubstr("trajectory.csv, line 3: the altitude is not a finite number"));
  EXPECT_THAT(refusal([](Drive& d) { d.frames[0].heading_deg = kNan; }),
              HasSubstr("trajectory.csv, line 2: heading_deg is not a finite number"));
  EXPECT_THAT(refusal([](Drive& d) { d.frames[0].timestamp_s = kNan; }),
              HasSubstr("trajectory.csv, line 2: timestamp_s is not a finite number"));
  EXPECT_THAT(refusal([](Drive& d) { d.position_error.sigma_m = kNan; }),
              HasSubstr("drive.json: position_sigma_m is nan"));
  EXPECT_THAT(refusal([](Drive& d) { d.frames[1].position_sigma_m = kNan; }),
              HasSubstr("trajectory.csv, line 3: position_sigma_m is nan"));
  EXPECT_THAT(refusal([](Drive& d) { d.odometry[1].speed_mps = kNan; }),
              HasSubstr("odometry.csv, line 3: speed_mps or yaw_rate_dps is not a finite number"));
  EXPECT_THAT(refusal([](Drive& d) { d.gps[0].sigma_m = 0; }),
              HasSubstr("gps.csv, line 2: sigma_m"));
  EXPECT_THAT(refusal([](Drive& d) { d.camera.pinhole.focal_x_px = kNan; }),
              HasSubstr("drive.json: camera.focal_px holds nan"));
  EXPECT_THAT(refusal([](Drive& d) { d.camera.pinhole.principal_y_px = kNan; }),
              HasSubstr("drive.json: camera.principal_px is not finite"));
  EXPECT_THAT(refusal([](Drive& d) { d.source = "\xff"; }),
              HasSubstr("write the drive's texts in UTF-8"));
}

TEST(WriteDriveRefuses, AFolderThatCannotBeMade) {
  const DriveFolder folder;
  const Status status = write_drive(geographic_drive(), folder.path() / "drive.json" / "x");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::io);
  EXPECT_THAT(status.error().line(), HasSubstr("drive.json/x: cannot be created"));
}

}  // namespace
}  // namespace milepost
