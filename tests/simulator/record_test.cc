#include "tests/simulator/record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "schema/drive/frame_image.h"
#include "tests/support/temp_folder.h"

namespace milepost::simulator {
namespace fs = std::filesystem;
namespace {

using milepost::testing::TempFolder;
using ::testing::HasSubstr;

StreetPlan short_plan(std::uint64_t seed) {
  StreetPlan plan;
  plan.length_m = 10;
  plan.beyond_m = 15;
  plan.seed = seed;
  return plan;
}

// Made once: painting a street is slow.
const Street& short_street() {
  static const Street street = make_street(short_plan(1));
  return street;
}

// Every file of a folder with its bytes.
std::map<std::string, std::string> content_of(const fs::path& folder) {
  std::map<std::string, std::string> content;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ostringstream bytes;
    bytes << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    content[fs::relative(entry.path(), folder).string()] = bytes.str();
  }
  return content;
}

std::map<std::string, std::string> recorded(const StreetPlan& plan, const RunPlan& run) {
  const TempFolder folder;
  const Status status = record(make_street(plan), run, folder.path());
  EXPECT_TRUE(status.ok()) << status.error().line();
  return content_of(folder.path());
}

TEST(Record, TheSameSeedGivesTheSameBytes) {
  const StreetPlan plan = short_plan(3);
  const auto first = recorded(plan, query_run(plan));
  EXPECT_EQ(first.size(), 4U + 6U);  // drive.json, three tables, six frames
  EXPECT_TRUE(first == recorded(plan, query_run(plan)));
  const StreetPlan other = short_plan(4);
  EXPECT_NE(first.at("frames/000000.jpg"),
            recorded(other, query_run(other)).at("frames/000000.jpg"));
}

TEST(Record, IsReadBackAsADrive) {
  const StreetPlan& plan = short_street().plan;
  for (const RunPlan& run : {map_run(plan), query_run(plan)}) {
    SCOPED_TRACE(run.name);
    const TempFolder folder;
    ASSERT_TRUE(record(short_street(), run, folder.path()).ok());
    const Result<Drive> drive = read_drive(folder.path());
    ASSERT_TRUE(drive.ok()) << drive.error().line();
    EXPECT_EQ(drive->name, run.name);
    EXPECT_EQ(drive->camera, kPaperCamera);
    EXPECT_EQ(drive->gps.empty(), !run.has_receiver);
    EXPECT_EQ(drive->odometry.empty(), !run.has_odometer);
    for (std::size_t i = 0; i < drive->frames.size(); ++i) {
      const Result<cv::Mat> image = read_frame_gray(*drive, i);
      EXPECT_TRUE(image.ok()) << image.error().line();
    }
  }
}

TEST(Record, MapFramesStandTwoMetresApart) {
  const TempFolder folder;
  ASSERT_TRUE(record(short_street(), map_run(short_street().plan), folder.path()).ok());
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  ASSERT_EQ(drive->frames.size(), 5U);
  for (std::size_t i = 1; i < drive->frames.size(); ++i) {
    const double spacing_m =
        geodesic_distance_m(drive->frames[i - 1].position, drive->frames[i].position);
    EXPECT_NEAR(spacing_m, 2, 0.01);
    EXPECT_NEAR(drive->frames[i].timestamp_s - drive->frames[i - 1].timestamp_s, 0.2, 1e-9);
  }
}

TEST(Record, SensorsSayRoughlyWhatWasDriven) {
  RunPlan run = query_run(short_street().plan);
  run.to_m = 12;
  const TempFolder folder;
  ASSERT_TRUE(record(short_street(), run, folder.path()).ok());
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  for (const GpsFix& fix : drive->gps) {
    EXPECT_LT(geodesic_distance_m(fix.position, drive->frames[0].position), 30);
    EXPECT_GT(geodesic_distance_m(fix.position, drive->frames[0].position), 0.01);
  }
  ASSERT_GE(drive->odometry.size(), 9U);
  for (const OdometryReading& reading : drive->odometry) {
    EXPECT_NEAR(reading.speed_mps, run.speed_mps, 0.4);
    EXPECT_LT(std::abs(reading.yaw_rate_dps), 5);
  }
}

TEST(Record, ReportsProgressFrameByFrame) {
  const RunPlan run = map_run(short_street().plan);
  const TempFolder folder;
  std::vector<std::size_t> seen;
  const Progress progress = [&](std::size_t index, std::size_t count) {
    EXPECT_EQ(count, 5U);
    seen.push_back(index);
  };
  ASSERT_TRUE(record(short_street(), run, folder.path(), progress).ok());
  EXPECT_THAT(seen, ::testing::ElementsAre(0, 1, 2, 3, 4));
}

TEST(Record, RefusesARunThatIsNoDrive) {
  const StreetPlan plan = short_plan(1);
  RunPlan run = map_run(plan);
  run.spacing_m = 0;
  const TempFolder folder;
  const Status status = record({plan, Centreline(0, 0), {}}, run, folder.path());
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().line(), HasSubstr("street-map: the run has no way, spacing or speed"));
}

TEST(Record, SaysWhereItCannotWrite) {
  const StreetPlan plan = short_plan(1);
  const TempFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  const Status status =
      record({plan, Centreline(0, 0), {}}, map_run(plan), folder.path() / "file" / "drive");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::io);
  EXPECT_THAT(status.error().line(), HasSubstr("file/drive/frames: cannot be made"));
}

}  // namespace
}  // namespace milepost::simulator
