// Recordings of the small city.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include <nlohmann/json.hpp>

#include "schema/base/file.h"
#include "schema/drive/drive.h"
#include "tests/simulator/city_graph.h"
#include "tests/simulator/city_runs.h"
#include "tests/simulator/kept_frames.h"
#include "tests/simulator/record.h"
#include "tests/simulator/sensors.h"
#include "tests/support/temp_folder.h"

namespace milepost::simulator {
namespace fs = std::filesystem;
namespace {

using milepost::testing::TempFolder;

const City& recorded_city() {
  static const City city = make_city(1, CityPlan::small);
  return city;
}

const Town& recorded_city_town() {
  static const Town town = build_town(recorded_city().network, recorded_city().seed);
  return town;
}

// The first metres of a drive, through a tiny camera.
RunPlan city_run(const std::string& name, double length_m) {
  for (RunPlan run : city_runs(recorded_city(), length_m)) {
    run.camera = {48, 40, {28.6, 32, 24, 20}};
    if (run.name == name) return run;
  }
  return {};
}

// The light of one time of day for all; shadows take a moment.
const Lighting& recorded_city_lighting() {
  static const Lighting lighting = light_town(recorded_city_town(), noon_light());
  return lighting;
}

Status record_in_city(const RunPlan& run, const fs::path& folder, int threads = 2) {
  return record(recorded_city_town(), recorded_city_lighting(), run, folder, threads);
}

std::map<std::string, std::string> city_content_of(const fs::path& folder) {
  std::map<std::string, std::string> content;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    content[fs::relative(entry.path(), folder).string()] = *read_text_file(entry.path());
  }
  return content;
}

TEST(CityRecord, TheSameRunGivesTheSameBytesOnAnyNumberOfThreads) {
  const TempFolder one, two;
  const RunPlan run = city_run("city-1-tour", 12);
  ASSERT_TRUE(record_in_city(run, one.path(), 1).ok());
  ASSERT_TRUE(record_in_city(run, two.path(), 3).ok());
  EXPECT_TRUE(city_content_of(one.path()) == city_content_of(two.path()));
}

TEST(CityRecord, IsADriveWithReceiverAndOdometerAboveTheRoad) {
  const TempFolder folder;
  const RunPlan run = city_run("city-1-map", 12);
  ASSERT_TRUE(record_in_city(run, folder.path()).ok());
  const Result<Drive> drive = read_drive(folder.path());
  ASSERT_TRUE(drive.ok()) << drive.error().line();
  EXPECT_FALSE(drive->gps.empty());
  EXPECT_FALSE(drive->odometry.empty());
  ASSERT_EQ(drive->frames.size(), 6U);
  const Route& route = *recorded_city().network.route(run.route);
  const LocalFrame frame(kOrigin);
  for (std::size_t i = 0; i < drive->frames.size(); ++i) {
    const EnuPoint at = frame.enu_from_geo(drive->frames[i].position);
    const RoadPlace place = route.path.place_of({at.east_m, at.north_m});
    EXPECT_NEAR(place.lateral_m, 0, run.motion.wander_m + 1e-3);
    EXPECT_NEAR(place.along_m, run.motion.from_m + 2.0 * static_cast<double>(i), 0.02);
    EXPECT_NEAR(
        at.up_m,
        route.height_m(recorded_city().network.terrain, place.along_m, {at.east_m, at.north_m}) +
            1.5,
        0.02);
  }
}

TEST(CityRecord, ToursStateRoadAndLane) {
  const TempFolder folder;
  RunPlan run = city_run("city-1-tour", 90);  // through the first junction
  run.frame_period_s = 1.5;
  ASSERT_TRUE(record_in_city(run, folder.path()).ok());
  EXPECT_TRUE(read_drive(folder.path()).ok());
  std::istringstream lines(*read_text_file(folder / "trajectory.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_THAT(line, ::testing::EndsWith(",heading_deg,road,lane"));
  bool was_on_edge = false, was_in_junction = false;
  while (std::getline(lines, line)) {
    was_on_edge |= line.ends_with("+,1") || line.ends_with("-,1");
    was_in_junction |= line.ends_with("tee,0");
  }
  EXPECT_TRUE(was_on_edge && was_in_junction);
}

TEST(CityRecord, ErrorsOfPositionsChangeTheTrajectoryAlone) {
  const TempFolder folder;
  RunPlan run = city_run("city-1-map", 12);
  EXPECT_FALSE(has_recorded(recorded_city_town(), run, folder.path()));
  ASSERT_TRUE(record_in_city(run, folder.path()).ok());
  const auto exact = city_content_of(folder.path());
  for (const PositionErrors& errors :
       {PositionErrors{0.2, 0, 0, 0}, PositionErrors{0, 0.2, 0, 0}, PositionErrors{0, 0, 0.2, 0},
        PositionErrors{0, 0, 0, 0.2}}) {
    run.errors = errors;
    ASSERT_TRUE(has_recorded(recorded_city_town(), run, folder.path()));
    ASSERT_TRUE(record_tables(recorded_city_town(), run, folder.path()).ok());
    auto changed = city_content_of(folder.path());
    EXPECT_NE(changed.at("trajectory.csv"), exact.at("trajectory.csv"));
    changed["trajectory.csv"] = exact.at("trajectory.csv");
    EXPECT_TRUE(changed == exact);
    // Rendering again gives the same.
    const TempFolder fresh;
    ASSERT_TRUE(record_in_city(run, fresh.path()).ok());
    EXPECT_TRUE(city_content_of(fresh.path()) == city_content_of(folder.path()));
  }
  run.errors = {};
  ASSERT_TRUE(record_tables(recorded_city_town(), run, folder.path()).ok());
  EXPECT_TRUE(city_content_of(folder.path()) == exact);
}

TEST(CityRecord, FramesOfAnotherPlanAreRenderedAgain) {
  const TempFolder folder;
  const RunPlan run = city_run("city-1-map", 6);
  ASSERT_TRUE(record_in_city(run, folder.path()).ok());
  std::vector<RunPlan> others(6, run);
  others[0].camera.width_px += 2;
  others[1].spacing_m = 1;
  others[2].seed += 1;
  others[3].light.sun_azimuth_deg += 1;
  others[4].has_truck_ahead = !run.has_truck_ahead;
  others[5].keeps_frames = false;
  for (const RunPlan& other : others) {
    EXPECT_FALSE(has_recorded(recorded_city_town(), other, folder.path()));
  }
  EXPECT_TRUE(has_recorded(recorded_city_town(), run, folder.path()));
  fs::remove(folder / "frames" / "000001.jpg");
  EXPECT_FALSE(has_recorded(recorded_city_town(), run, folder.path()));
}

TEST(CityRecord, FramesOfAStoppedRecordingAreNotTaken) {
  const TempFolder folder;
  const RunPlan run = city_run("city-1-map", 6);
  ASSERT_TRUE(record_in_city(run, folder.path()).ok());
  const Progress none = [](std::size_t, std::size_t) { return false; };
  const Status stopped =
      record(recorded_city_town(), recorded_city_lighting(), run, folder.path(), 1, none);
  EXPECT_FALSE(stopped.ok());
  EXPECT_FALSE(has_recorded(recorded_city_town(), run, folder.path()));
}

TEST(CityGraph, StatesJunctionsEdgesAndDrives) {
  const TempFolder folder;
  ASSERT_TRUE(write_city_graph(recorded_city(), folder / kCityGraphFile).ok());
  const auto graph = nlohmann::json::parse(*read_text_file(folder / kCityGraphFile));
  EXPECT_EQ(graph.at("junctions").size(), recorded_city().junctions.size());
  ASSERT_EQ(graph.at("edges").size(), recorded_city().edges.size());
  ASSERT_EQ(graph.at("drives").size(), 3U);
  EXPECT_EQ(graph["drives"][0]["name"], "city-1-map");
  EXPECT_EQ(graph["drives"][0]["edges"][0], "high-street.1+");
  for (const auto& edge : graph["edges"]) {
    const auto& lane = edge["lanes"][0];
    double length_m = 0;
    for (std::size_t i = 1; i < lane["line"].size(); ++i) {
      const auto place = [&](std::size_t at) {
        return GeoPoint{lane["line"][at][1], lane["line"][at][0], lane["line"][at][2]};
      };
      length_m += geodesic_distance_m(place(i - 1), place(i));
    }
    EXPECT_NEAR(length_m, lane["length_m"].get<double>(), 0.1) << edge["name"];
  }
}

}  // namespace
}  // namespace milepost::simulator
