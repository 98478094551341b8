// milepost-mapper export, run as a user runs it on a map file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "schema/base/file.h"
#include "schema/store/map_store.h"
#include "schema/store/sqlite.h"
#include "schema/tile/codec.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct Outcome {
  int exit_code = -1;
  std::string output;  // both streams
};

// One wall within a cell, one across the corner of four, one in the far south.
const std::vector<Wall> kWalls = {
    {{-33.86881234, -151.20939876}, {-33.8687, -151.2093}, 0.5},
    {{49.00123456, 8.40123457}, {49.001, 8.402}, 0.24},
    {{49.0049, 8.4049}, {49.0051, 8.4051}, 0.01},
};

class ExportCommandTest : public ::testing::Test {
 protected:
  ExportCommandTest() {
    auto writer = MapWriter::create(map_);
    EXPECT_TRUE(writer.ok());
    EXPECT_TRUE(writer->add_layer("tracklets", R"({"items":"landmarks"})").ok());
    EXPECT_TRUE(writer->add_layer("walls", R"({"items":"walls"})").ok());
    EXPECT_TRUE(writer->add_layer("no-walls", R"({"items":"walls"})").ok());
    EXPECT_TRUE(
        writer->add_segment({"b", 20.5, {{49, 8.4, 110, 0}, {49.1, 8.3, 111.5, 20.5}}, {}}).ok());
    EXPECT_TRUE(writer
                    ->add_segment({"a",
                                   30,
                                   {{49.123456789, 8.4, 1, 0}, {49.2, 8.4, 2, 9}, {50, 8, 3, 30}},
                                   {{"b"}, {"c", "village"}},
                                   {{"monday", 5, 35}},
                                   {0.18, 200, true}})
                    .ok());
    for (const WallTile& tile : tiles_of(kWalls)) add_walls(*writer, tile.cell, encode_walls(tile));
    EXPECT_TRUE(writer->finish().ok());
  }

  static void add_walls(MapWriter& writer, std::uint32_t cell, const Bytes& frame) {
    EXPECT_TRUE(writer.add_cell("walls", cell, 1, frame).ok());
  }

  static Outcome run(const std::string& arguments) {
    const std::string command = std::string(MILEPOST_MAPPER) + " export " + arguments + " 2>&1";
    Outcome outcome;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    std::array<char, 4096> buffer;
    while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
      outcome.output.append(buffer.data(), count);
    }
    outcome.exit_code = WEXITSTATUS(::pclose(pipe));
    return outcome;
  }

  Outcome export_layer(const std::string& layer) const {
    return run("--map " + map_.string() + " --layer " + layer + " --geojson " + out_.string());
  }

  // The call ends with `code`, and with one line that holds each part; it leaves nothing behind.
  void expect_refused(const Outcome& outcome, int code, const std::vector<std::string>& parts) {
    EXPECT_EQ(outcome.exit_code, code) << outcome.output;
    EXPECT_EQ(std::ranges::count(outcome.output, '\n'), 1) << outcome.output;
    for (const std::string& part : parts) EXPECT_THAT(outcome.output, HasSubstr(part));
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      EXPECT_EQ(entry.path(), map_) << "is left behind";
    }
  }

  json geometry_across(const std::vector<std::pair<double, double>>& line);

  json exported() const { return json::parse(*read_text_file(out_)); }

  testing::TempFolder folder_;
  fs::path map_ = folder_ / "town.map";
  fs::path out_ = folder_ / "out.geojson";
};

TEST_F(ExportCommandTest, WritesEachWallOnce) {
  const Outcome outcome = export_layer("walls");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(outcome.output, out_.string() + ": 3 walls\n");
  const json collection = exported();
  EXPECT_EQ(collection.at("type"), "FeatureCollection");
  ASSERT_EQ(collection.at("features").size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const Wall& wall = kWalls[i];
    EXPECT_EQ(collection["features"][i],
              json({{"type", "Feature"},
                    {"geometry",
                     {{"type", "LineString"},
                      {"coordinates",
                       {{wall.begin.longitude_deg, wall.begin.latitude_deg},
                        {wall.end.longitude_deg, wall.end.latitude_deg}}}}},
                    {"properties", {{"sigma_m", wall.sigma_m}}}}));
  }
}

TEST_F(ExportCommandTest, WritesTheRoadNetwork) {
  const Outcome outcome = export_layer("segments");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(outcome.output, out_.string() + ": 2 segments\n");
  const json features = exported().at("features");
  ASSERT_EQ(features.size(), 2U);
  EXPECT_EQ(features[0].at("properties"),
            json({{"id", "a"},
                  {"length_m", 30.0},
                  {"successors",
                   {{{"map", "town"}, {"segment", "b"}}, {{"map", "village"}, {"segment", "c"}}}},
                  {"passes", {{{"drive", "monday"}, {"from_m", 5.0}, {"to_m", 35.0}}}},
                  {"position_sigma_m", 0.18},
                  {"assumed", true}}));
  EXPECT_EQ(
      features[0].at("geometry"),
      json({{"type", "LineString"},
            {"coordinates", {{8.4, 49.123456789, 1.0}, {8.4, 49.2, 2.0}, {8.0, 50.0, 3.0}}}}));
  EXPECT_EQ(features[1].at("properties").at("successors"), json::array());
  EXPECT_FALSE(features[1].at("properties").contains("position_sigma_m"));  // it is not known
}

TEST_F(ExportCommandTest, WritesTheSameBytesAgain) {
  ASSERT_EQ(export_layer("walls").exit_code, 0);
  const std::string first = *read_text_file(out_);
  ASSERT_EQ(export_layer("walls").exit_code, 0);
  EXPECT_EQ(*read_text_file(out_), first);
}

TEST_F(ExportCommandTest, ALayerWithoutWallsIsAnEmptyCollection) {
  EXPECT_EQ(export_layer("no-walls").output, out_.string() + ": 0 walls\n");
  EXPECT_EQ(exported(), json({{"type", "FeatureCollection"}, {"features", json::array()}}));
}

TEST_F(ExportCommandTest, AnAbsentLayerIsToldWithThoseThatThereAre) {
  expect_refused(export_layer("roofs"), 1,
                 {"town.map", "no layer 'roofs'", "segments, no-walls, tracklets, walls"});
}

TEST_F(ExportCommandTest, ALayerOfOtherItemsIsRefused) {
  expect_refused(export_layer("tracklets"), 1,
                 {"'tracklets'", "its items are 'landmarks'", "segments"});
}

TEST_F(ExportCommandTest, ADamagedCellIsNamed) {
  auto writer = MapWriter::create(map_);
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE(writer->add_layer("walls", R"({"items":"walls"})").ok());
  add_walls(*writer, 77, Bytes(100));
  ASSERT_TRUE(writer->finish().ok());
  expect_refused(export_layer("walls"), 1, {"town.map, layer walls, cell 77", "FORMAT.md 3.2"});
}

TEST_F(ExportCommandTest, ASegmentWithoutALineIsNamed) {
  auto map = sqlite::Database::open(map_, sqlite::Access::read_write);
  ASSERT_TRUE(map.ok());
  ASSERT_TRUE(map->execute("DELETE FROM vertices WHERE segment = 'b' AND position > 0").ok());
  expect_refused(export_layer("segments"), 1, {"town.map, segment b"});
}

// The positions of the exported geometry of a segment with these longitudes and latitudes.
json ExportCommandTest::geometry_across(const std::vector<std::pair<double, double>>& line) {
  auto writer = MapWriter::create(map_);
  StoredSegment segment{"far", 100, {}, {}};
  for (const auto& [longitude_deg, latitude_deg] : line) {
    const double along_m = 10.0 * static_cast<double>(segment.vertices.size());
    segment.vertices.push_back({latitude_deg, longitude_deg, along_m, along_m});
  }
  EXPECT_TRUE(writer->add_segment(segment).ok());
  EXPECT_TRUE(writer->finish().ok());
  EXPECT_EQ(export_layer("segments").output, out_.string() + ": 1 segments\n");
  return exported().at("features").at(0).at("geometry");
}

TEST_F(ExportCommandTest, WhatCrossesLongitude180IsCutThere) {
  // RFC 7946, 3.1.9; altitudes are those of the vertices, 10 m apart.
  EXPECT_EQ(geometry_across({{179.75, -17}, {-179.75, -18}}),
            json({{"type", "MultiLineString"},
                  {"coordinates",
                   {{{179.75, -17.0, 0.0}, {180.0, -17.5, 5.0}},
                    {{-180.0, -17.5, 5.0}, {-179.75, -18.0, 10.0}}}}}));
  EXPECT_EQ(geometry_across({{-179.5, 1}, {-179.75, 1}, {179.75, 2}, {-179.75, 2}}),
            json({{"type", "MultiLineString"},
                  {"coordinates",
                   {{{-179.5, 1.0, 0.0}, {-179.75, 1.0, 10.0}, {-180.0, 1.5, 15.0}},
                    {{180.0, 1.5, 15.0}, {179.75, 2.0, 20.0}, {180.0, 2.0, 25.0}},
                    {{-180.0, 2.0, 25.0}, {-179.75, 2.0, 30.0}}}}}));
}

TEST_F(ExportCommandTest, WhatOnlyTouchesLongitude180IsOneLine) {
  const auto is_line = [](const json& geometry, const json& coordinates) {
    return geometry == json({{"type", "LineString"}, {"coordinates", coordinates}});
  };
  EXPECT_TRUE(
      is_line(geometry_across({{180, 1}, {-179.5, 2}}), {{-180.0, 1.0, 0.0}, {-179.5, 2.0, 10.0}}));
  EXPECT_TRUE(
      is_line(geometry_across({{-179.5, 1}, {180, 2}}), {{-179.5, 1.0, 0.0}, {-180.0, 2.0, 10.0}}));
  EXPECT_TRUE(
      is_line(geometry_across({{180, 1}, {-180, 2}}), {{180.0, 1.0, 0.0}, {180.0, 2.0, 10.0}}));
  EXPECT_TRUE(
      is_line(geometry_across({{180, 1}, {180, 2}}), {{180.0, 1.0, 0.0}, {180.0, 2.0, 10.0}}));
}

TEST_F(ExportCommandTest, AMapIsNotReplacedByItsExport) {
  const std::string before = *read_text_file(map_);
  const Outcome outcome =
      run("--map " + map_.string() + " --layer walls --geojson " + map_.string());
  expect_refused(outcome, 1, {"town.map", "the command reads this file"});
  EXPECT_EQ(*read_text_file(map_), before);
}

TEST_F(ExportCommandTest, AFileThatIsNoMapIsRefused) {
  fs::remove(map_);
  expect_refused(export_layer("walls"), 1, {"town.map", "no such file"});
  std::ofstream(map_) << "not a map";
  expect_refused(export_layer("walls"), 1, {"town.map"});
}

TEST_F(ExportCommandTest, AFolderThatIsNotThereIsNamed) {
  expect_refused(run("--map " + map_.string() + " --layer walls --geojson " +
                     (folder_ / "nowhere" / "out.geojson").string()),
                 1, {"nowhere/out.geojson"});
}

TEST_F(ExportCommandTest, WrongCallsAreToldApart) {
  const std::string map = "--map " + map_.string();
  const std::string out = " --geojson " + out_.string();
  expect_refused(run("--layer walls" + out), 2, {"--map"});
  expect_refused(run(map + out), 2, {"--layer"});
  expect_refused(run(map + " --layer walls"), 2, {"--geojson"});
  expect_refused(run(map + " --layer walls" + out + " --format shp"), 2, {"--format"});
  expect_refused(run(map + " --layer walls" + out + " more"), 2, {"more"});
}

TEST_F(ExportCommandTest, HelpTeaches) {
  const Outcome outcome = run("--help");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.output,
              AllOf(HasSubstr("--map FILE"), HasSubstr("--layer NAME"), HasSubstr("--geojson FILE"),
                    HasSubstr("'segments'"), HasSubstr("Example: milepost-mapper export")));
}

}  // namespace
}  // namespace milepost
