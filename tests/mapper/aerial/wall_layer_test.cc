#include "mapper/aerial/wall_layer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "schema/base/file.h"
#include "schema/store/map_store.h"
#include "schema/tile/codec.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using testing::TempFolder;

const std::vector<Wall> kWalls = {{{49, 8.4001}, {49.0001, 8.4001}, 0.4},
                                  {{49.0049, 8.4}, {49.0051, 8.4001}, 0.4}};  // in two cells
const WallLayerParameters kParameters = {};

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

// A map with a segment of one tile, a layer of cells, and old walls.
void write_old_map(const std::filesystem::path& file) {
  Result<MapWriter> writer = MapWriter::create(file);
  ASSERT_TRUE(writer.ok());
  ASSERT_TRUE(writer->set_feature_json(R"({"type":"sift"})").ok());
  for (const char* const layer : {"tracklets", "trees", "walls"}) {
    ASSERT_TRUE(writer->add_layer(layer, R"({"items":"tracklets"})").ok());
  }
  ASSERT_TRUE(writer
                  ->add_segment({"monday",
                                 12,
                                 {{49, 8.4, 110, 0}, {49.0001, 8.4, 110, 12}},
                                 {{"monday"}},
                                 {{"sunday", 0, 12}},
                                 {0.1, 50, true}})
                  .ok());
  ASSERT_TRUE(writer->add_tile("monday", "tracklets", 0, {0, 12}, 3, bytes_of("a tile")).ok());
  ASSERT_TRUE(writer->add_cell("trees", 2003217681, 2, bytes_of("a cell")).ok());
  ASSERT_TRUE(writer->add_cell("walls", 2003217690, 2, bytes_of("old walls")).ok());
  ASSERT_TRUE(writer->finish().ok());
}

std::vector<Wall> walls_in(const MapReader& map) {
  std::vector<WallTile> tiles;
  const Result<std::vector<CellEntry>> index = map.cell_index("walls");
  EXPECT_TRUE(index.ok());
  for (const CellEntry& entry : *index) {
    const Result<Bytes> frame = map.cell("walls", entry.cell);
    EXPECT_TRUE(frame.ok());
    const Result<WallTile> tile = decode_walls(*frame);
    EXPECT_TRUE(tile.ok());
    tiles.push_back(*tile);
  }
  return walls_of(tiles);
}

TEST(WallLayer, MakesAMapOfWallsAlone) {
  const TempFolder folder;
  const auto report = write_wall_layer(folder / "town.map", kWalls, kParameters);
  ASSERT_TRUE(report.ok()) << report.error().line();
  EXPECT_EQ(report->cells, 2U);
  const Result<MapReader> map = MapReader::open(folder / "town.map");
  ASSERT_TRUE(map.ok());
  EXPECT_EQ(map->build(), report->build);
  EXPECT_TRUE(map->verify().ok());
  EXPECT_EQ(walls_in(*map), kWalls);
}

TEST(WallLayer, KeepsAllElse) {
  const TempFolder folder;
  write_old_map(folder / "town.map");
  ASSERT_TRUE(write_wall_layer(folder / "town.map", kWalls, kParameters).ok());
  const Result<MapReader> map = MapReader::open(folder / "town.map");
  ASSERT_TRUE(map.ok());
  EXPECT_TRUE(map->verify().ok());
  EXPECT_EQ(map->feature_json(), R"({"type":"sift"})");
  EXPECT_EQ(map->layers().size(), 3U);
  EXPECT_EQ(map->layers().at("walls"), R"({"items":"walls"})");
  EXPECT_EQ(map->segment_ids(), std::vector<std::string>{"monday"});
  EXPECT_EQ(map->segment("monday")->vertices.size(), 2U);
  EXPECT_EQ(map->segment("monday")->successors, std::vector<Successor>{{"monday"}});
  EXPECT_EQ(map->segment("monday")->passes, (std::vector<StoredPass>{{"sunday", 0, 12}}));
  EXPECT_EQ(map->segment("monday")->position_error, (PositionError{0.1, 50, true}));
  EXPECT_EQ(*map->tile("monday", "tracklets", 0), bytes_of("a tile"));
  EXPECT_EQ(*map->cell("trees", 2003217681), bytes_of("a cell"));
  EXPECT_EQ(walls_in(*map), kWalls);
}

TEST(WallLayer, TheSameWallsGiveTheSameBytes) {
  const TempFolder folder;
  ASSERT_TRUE(write_wall_layer(folder / "a.map", kWalls, kParameters).ok());
  ASSERT_TRUE(write_wall_layer(folder / "b.map", {kWalls[1], kWalls[0]}, kParameters).ok());
  EXPECT_EQ(*read_text_file(folder / "a.map"), *read_text_file(folder / "b.map"));
}

TEST(WallLayer, ACellHoldsSoManyWallsAndNoMore) {
  const TempFolder folder;
  std::vector<Wall> walls;
  walls.reserve(65537);
  for (int i = 0; i < 65537; ++i) {
    const double north_deg = 49.0001 + 6e-8 * i;
    walls.push_back({{north_deg, 8.4001}, {north_deg, 8.4002}, 0.4});
  }
  const auto refused = write_wall_layer(folder / "town.map", walls, kParameters);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().line().find("65537 walls, more than 65536"), std::string::npos)
      << refused.error().line();
  EXPECT_FALSE(std::filesystem::exists(folder / "town.map"));
  walls.pop_back();
  EXPECT_TRUE(write_wall_layer(folder / "town.map", walls, kParameters).ok());
}

TEST(WallLayer, WhatOurReadersRefuseIsCutOrLeftOut) {
  const TempFolder folder;
  const auto report = write_wall_layer(folder / "island.map",
                                       {{{-16.5, 179.9999}, {-16.5, -179.9999}, 0.4},
                                        {{-89.999, 20}, {-89.999, 21}, 0.4},
                                        {{49, 8.4}, {49, 8.4}, 0.4},
                                        {{49, 8.4}, {49.000000001, 8.4}, 0.4}},
                                       kParameters);
  ASSERT_TRUE(report.ok()) << report.error().line();
  const Result<MapReader> map = MapReader::open(folder / "island.map");
  ASSERT_TRUE(map.ok());
  EXPECT_TRUE(map->verify().ok());
  const std::vector<Wall> walls = walls_in(*map);
  EXPECT_EQ(report->walls, walls.size());
  EXPECT_GT(walls.size(), 12U);
  EXPECT_NEAR(report->length_m, 21.34 + 1.95, 0.1);
  for (const Wall& wall : walls) EXPECT_NE(wall.begin, wall.end);
}

TEST(WallLayer, WallsLikeBordersOfCountriesAreRefused) {
  const TempFolder folder;
  std::vector<Wall> walls;
  walls.reserve(50000);
  for (int i = 0; i < 50000; ++i) {
    walls.push_back({{49 + 1e-6 * i, 8}, {49.0999 + 1e-6 * i, 8.0999}, 0.5});
  }
  const auto refused = write_wall_layer(folder / "town.map", walls, kParameters);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().line().find("so long"), std::string::npos) << refused.error().line();
  EXPECT_FALSE(std::filesystem::exists(folder / "town.map"));
}

TEST(WallLayer, AWallThatIsNowhereIsRefused) {
  const TempFolder folder;
  EXPECT_FALSE(
      write_wall_layer(folder / "town.map", {{{49, 8.4}, {91, 8.4}, 0.4}}, kParameters).ok());
  EXPECT_FALSE(std::filesystem::exists(folder / "town.map"));
}

TEST(WallLayer, WhatIsNoMapStaysAsItIs) {
  const TempFolder folder;
  ASSERT_TRUE(write_text_file(folder / "town.map", "not a map").ok());
  EXPECT_FALSE(write_wall_layer(folder / "town.map", kWalls, kParameters).ok());
  EXPECT_EQ(*read_text_file(folder / "town.map"), "not a map");
}

}  // namespace
}  // namespace milepost
