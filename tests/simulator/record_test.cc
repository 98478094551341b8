#include "tests/simulator/record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "schema/drive/frame_image.h"
#include "tests/simulator/sensors.h"
#include "tests/support/temp_folder.h"

namespace milepost::simulator {
namespace fs = std::filesystem;
namespace {

using milepost::testing::TempFolder;
using ::testing::HasSubstr;

// Generated once: a town takes a second or two.
const Town& recorded_town() {
  static const Town made = make_town(1);
  return made;
}
const Lighting& recorded_lighting() {
  static const Lighting made = light_town(recorded_town(), noon_light());
  return made;
}

// The first metres of a drive, through a small camera.
RunPlan short_run(const std::string& name, double length_m = 10) {
  for (RunPlan run : make_runs(recorded_town().network, recorded_town().seed, length_m)) {
    run.camera = {150, 125, 89.4, 100, 75, 62.5};
    if (run.name == name) return run;
  }
  return {};
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

std::map<std::string, std::string> recorded(const RunPlan& run, int threads) {
  const TempFolder folder;
  const Status status = record(recorded_town(), recorded_lighting(), run, folder.path(), threads);
  EXPECT_TRUE(status.ok()) << status.error().line();
  return content_of(folder.path());
}

TEST(Record, TheSameRunGivesTheSameBytesOnAnyNumberOfThreads) {
  const RunPlan run = short_run("town-main-query-traffic");
  const auto first = recorded(run, 1);
  EXPECT_GE(first.size(), 4U + 5U);  // drive.json, three tables, frames
  EXPECT_TRUE(first == recorded(run, 2));
  RunPlan other = run;
  ++other.seed;
  EXPECT_NE(first.at("frames/000000.jpg"), recorded(other, 1).at("frames/000000.jpg"));
}

TEST(Record, IsReadBackAsADrive) {
  for (const char* name : {"town-loop-map", "town-hill-query-lane"}) {
    SCOPED_TRACE(name);
    const RunPlan run = short_run(name);
    const TempFolder folder;
    ASSERT_TRUE(record(recorded_town(), recorded_lighting(), run, folder.path(), 2).ok());
    const Result<Drive> drive = read_drive(folder.path());
    ASSERT_TRUE(drive.ok()) << drive.error().line();
    EXPECT_EQ(drive->name, run.name);
    EXPECT_EQ(drive->camera, run.camera);
    EXPECT_FALSE(drive->gps.empty());
    EXPECT_FALSE(drive->odometry.empty());
    for (std::size_t i = 0; i < drive->frames.size(); ++i) {
      const Result<cv::Mat> image = FrameReader(*drive).gray(i);
      EXPECT_TRUE(image.ok()) << image.error().line();
    }
  }
}

TEST(Record, MapFramesStandTwoMetresApart) {
  const TempFolder folder;
  const RunPlan run = short_run("town-main-map", 20);
  ASSERT_TRUE(record(recorded_town(), recorded_lighting(), run, folder.path(), 2).ok());
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  ASSERT_EQ(drive->frames.size(), 10U);
  const Path& path = recorded_town().network.route("town-main")->path;
  const LocalFrame frame(kOrigin);
  for (std::size_t i = 0; i < drive->frames.size(); ++i) {
    const EnuPoint at = frame.enu_from_geo(drive->frames[i].position);
    const RoadPlace place = path.place_of({at.east_m, at.north_m});
    EXPECT_NEAR(place.along_m, run.motion.from_m + 2.0 * static_cast<double>(i), 0.02);
    EXPECT_NEAR(place.lateral_m, kLaneM, 0.001);
    EXPECT_NEAR(at.up_m, recorded_town().network.terrain.height_m({at.east_m, at.north_m}) + 1.5,
                0.02);
  }
}

TEST(Record, QueryFramesComeAtUnevenTimes) {
  const TempFolder folder;
  ASSERT_TRUE(
      record(recorded_town(), recorded_lighting(), short_run("street-query", 30), folder.path(), 2)
          .ok());
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  double shortest = 1e9, longest = 0;
  for (std::size_t i = 1; i < drive->frames.size(); ++i) {
    const double step = drive->frames[i].timestamp_s - drive->frames[i - 1].timestamp_s;
    shortest = std::min(shortest, step);
    longest = std::max(longest, step);
  }
  EXPECT_LT(shortest, 0.199);
  EXPECT_GT(longest, 0.201);
  EXPECT_GT(shortest, 0.1);
}

TEST(Record, NoisyPositionsAreWrittenButNotDriven) {
  RunPlan run = short_run("street-map", 20);
  const auto exact = recorded(run, 2);
  run.position_noise_m = 2;
  const auto noisy = recorded(run, 2);
  EXPECT_EQ(exact.at("frames/000003.jpg"), noisy.at("frames/000003.jpg"));
  EXPECT_NE(exact.at("trajectory.csv"), noisy.at("trajectory.csv"));
}

TEST(Record, TellsItsProgressAndStopsWhenTold) {
  const RunPlan run = short_run("street-map");
  std::vector<std::size_t> seen;
  const TempFolder folder;
  const Progress all = [&seen](std::size_t done, std::size_t count) {
    EXPECT_EQ(count, 5U);
    seen.push_back(done);
    return true;
  };
  ASSERT_TRUE(record(recorded_town(), recorded_lighting(), run, folder.path(), 2, all).ok());
  EXPECT_THAT(seen, ::testing::ElementsAre(1, 2, 3, 4, 5));
  const TempFolder stopped;
  const Progress none = [](std::size_t, std::size_t) { return false; };
  const Status status = record(recorded_town(), recorded_lighting(), run, stopped.path(), 2, none);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::cancelled);
  EXPECT_FALSE(read_drive(stopped.path()).ok());
}

TEST(Record, RefusesARunThatIsNoDrive) {
  RunPlan run = short_run("street-map");
  run.motion.cruise_mps = 0;
  const TempFolder folder;
  const Status status = record(recorded_town(), recorded_lighting(), run, folder.path(), 1);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().line(), HasSubstr("street-map: the run has no way, spacing or speed"));
  run.route = "nowhere";
  EXPECT_THAT(record(recorded_town(), recorded_lighting(), run, folder.path(), 1).error().line(),
              HasSubstr("there is no route nowhere"));
}

TEST(Record, SaysWhereItCannotWrite) {
  const TempFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  const Status status = record(recorded_town(), recorded_lighting(), short_run("street-map"),
                               folder.path() / "file" / "drive", 1);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::io);
  EXPECT_THAT(status.error().line(), HasSubstr("file/drive/frames: cannot be created"));
}

}  // namespace
}  // namespace milepost::simulator
