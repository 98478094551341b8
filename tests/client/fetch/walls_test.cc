#include "client/fetch/walls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "client/fetch/file_source.h"
#include "schema/store/map_store.h"
#include "schema/tile/codec.h"
#include "tests/support/temp_folder.h"

namespace milepost::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr Bounds kEverywhere{-180, -90, 180, 90};

// In thousandths of a degree from 49 N 8.4 E; cells end at 5 and 10.
Wall wall(double north, double east, double end_north, double end_east) {
  return quantized({{49 + north / 1000, 8.4 + east / 1000},
                    {49 + end_north / 1000, 8.4 + end_east / 1000},
                    0.25});
}

const Wall kInFirst = wall(1, 1, 1, 2);
const Wall kInSecond = wall(1, 6, 1, 7);
const Wall kInBoth = wall(2, 4.9, 2, 5.1);

class WallsTest : public ::testing::Test {
 protected:
  // An opened map file of a layer with the given cells.
  std::shared_ptr<MapSource> map_of(const std::string& layer,
                                    const std::vector<EncodedCell>& cells) {
    auto writer = MapWriter::create(folder_ / "town.map");
    EXPECT_TRUE(writer.ok());
    EXPECT_TRUE(writer->add_layer(layer, R"({"items":"walls"})").ok());
    for (const EncodedCell& cell : cells) {
      EXPECT_TRUE(writer->add_cell(layer, cell.cell, 1, cell.bytes).ok());
    }
    const auto build = writer->finish();
    EXPECT_TRUE(build.ok());
    version_ = {"town", *build};
    return std::move(open_file_source(folder_ / "town.map")).value();
  }

  static std::vector<EncodedCell> cells_of(const std::vector<Wall>& walls) {
    std::vector<EncodedCell> cells;
    for (const WallTile& tile : tiles_of(walls)) cells.push_back({tile.cell, encode_walls(tile)});
    return cells;
  }

  TempFolder folder_;
  MapVersion version_;
};

TEST_F(WallsTest, OfABoxComeSortedAndOnceEach) {
  const auto source = map_of("walls", cells_of({kInSecond, kInBoth, kInFirst}));
  const auto all = walls_in(*source, version_, "walls", kEverywhere);
  ASSERT_TRUE(all.ok()) << all.error().line();
  EXPECT_THAT(*all, ElementsAre(kInFirst, kInSecond, kInBoth));
  const Bounds east{8.406, 49.001, 8.407, 49.002};
  EXPECT_THAT(*walls_in(*source, version_, "walls", east), ElementsAre(kInSecond, kInBoth));
  EXPECT_TRUE(walls_in(*source, version_, "walls", {1, 1, 2, 2})->empty());
}

TEST_F(WallsTest, OfAnAbsentLayerAreNotFound) {
  const auto source = map_of("walls", {});
  EXPECT_EQ(walls_in(*source, version_, "roofs", kEverywhere).error().code, ErrorCode::not_found);
  EXPECT_TRUE(walls_in(*source, version_, "walls", kEverywhere)->empty());
}

TEST_F(WallsTest, ADamagedTileIsNamed) {
  std::vector<EncodedCell> cells = cells_of({kInFirst});
  cells[0].bytes[cells[0].bytes.size() / 2] ^= 1;
  const auto source = map_of("walls", cells);
  const auto walls = walls_in(*source, version_, "walls", kEverywhere);
  ASSERT_FALSE(walls.ok());
  EXPECT_EQ(walls.error().code, ErrorCode::corrupt);
  EXPECT_THAT(walls.error().line(),
              HasSubstr("map 'town', layer 'walls', cell " + std::to_string(cells[0].cell)));
}

TEST_F(WallsTest, ATileOfAnotherCellIsRefused) {
  std::vector<EncodedCell> cells = cells_of({kInFirst});
  ++cells[0].cell;
  const auto source = map_of("walls", cells);
  const auto walls = walls_in(*source, version_, "walls", kEverywhere);
  ASSERT_FALSE(walls.ok());
  EXPECT_EQ(walls.error().code, ErrorCode::corrupt);
  EXPECT_THAT(walls.error().line(),
              HasSubstr("it holds the walls of cell " + std::to_string(cells[0].cell - 1)));
}

TEST_F(WallsTest, TheMapsThatHaveThemAreFoundWithTheirBounds) {
  const auto source = map_of("walls", cells_of({kInSecond}));
  const auto maps = maps_with_walls(*source);
  ASSERT_TRUE(maps.ok()) << maps.error().line();
  ASSERT_EQ(maps->size(), 1U);
  EXPECT_EQ(maps->front().version, version_);
  EXPECT_EQ(maps->front().bounds.west_deg, 8.405);
  EXPECT_EQ(maps->front().bounds.south_deg, 49);
  EXPECT_EQ(maps->front().bounds.east_deg, 8.41);
  EXPECT_EQ(maps->front().bounds.north_deg, 49.005);
  EXPECT_TRUE(maps_with_walls(*map_of("roofs", {}))->empty());
}

}  // namespace
}  // namespace milepost::testing
