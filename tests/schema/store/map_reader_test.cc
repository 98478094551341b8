#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "schema/base/digest.h"
#include "schema/store/map_store.h"
#include "tests/schema/store/example_map.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using testing::tile_bytes;

class MapReaderTest : public ::testing::Test {
 protected:
  // The indices of the tiles found on "east".
  std::vector<std::uint32_t> found(double from_m, double to_m) const {
    const auto entries = reader_->tiles_in("east", "tracklets", {from_m, to_m});
    std::vector<std::uint32_t> indices;
    if (!entries.ok()) ADD_FAILURE() << entries.error().line();
    if (entries.ok()) {
      for (const TileEntry& entry : *entries) indices.push_back(entry.index);
    }
    return indices;
  }

  testing::TempFolder folder_;
  std::filesystem::path file_ = folder_ / "town %?#.map";  // no part of it is parsed as an option
  std::string build_ = testing::write_example(file_);
  Result<MapReader> reader_ = MapReader::open(file_);
};

TEST_F(MapReaderTest, TellsWhatTheMapIs) {
  ASSERT_TRUE(reader_.ok()) << reader_.error().line();
  EXPECT_EQ(reader_->file(), file_);
  EXPECT_EQ(reader_->build(), build_);
  EXPECT_EQ(reader_->feature_json(), R"({"kind": "sift"})");
  EXPECT_THAT(reader_->layers(), ElementsAre(Pair("tracklets", R"({"model":  "inverse_scale"})"),
                                             Pair("walls", "{}")));
  EXPECT_THAT(reader_->segment_ids(), ElementsAre("east", "west"));
  EXPECT_EQ(reader_->bounds().west_deg, 8.25);
  EXPECT_EQ(reader_->bounds().south_deg, 49);
  EXPECT_EQ(reader_->bounds().east_deg, 8.75);
  EXPECT_EQ(reader_->bounds().north_deg, 49.5);
}

TEST_F(MapReaderTest, GivesBackASegment) {
  const auto segment = reader_->segment("east");
  ASSERT_TRUE(segment.ok()) << segment.error().line();
  EXPECT_EQ(segment->id, "east");
  EXPECT_EQ(segment->length_m, 110.25);
  ASSERT_EQ(segment->vertices.size(), 3U);
  EXPECT_EQ(segment->vertices[1].latitude_deg, 49.5);
  EXPECT_EQ(segment->vertices[1].longitude_deg, 8.75);
  EXPECT_EQ(segment->vertices[1].altitude_m, 111.5);
  EXPECT_EQ(segment->vertices[1].along_m, 60);
  EXPECT_THAT(segment->successors,
              ElementsAre(Successor{"west"}, Successor{"north", "of-another-map"}));
  EXPECT_THAT(segment->passes,
              ElementsAre(StoredPass{"monday", 20, 130.25}, StoredPass{"tuesday", 0, 110}));
  EXPECT_EQ(segment->position_error, (PositionError{0.15, 120, true}));
  EXPECT_EQ(reader_->segment("west")->position_error, PositionError());
  EXPECT_THAT(reader_->segment("west")->passes, IsEmpty());
  EXPECT_THAT(reader_->segment("west")->successors, IsEmpty());
}

TEST_F(MapReaderTest, GivesBackTheTileIndex) {
  const auto entries = reader_->tile_index("east", "tracklets");
  ASSERT_TRUE(entries.ok()) << entries.error().line();
  ASSERT_EQ(entries->size(), 10U);
  const TileEntry& entry = (*entries)[3];
  EXPECT_EQ(entry.index, 3U);
  EXPECT_EQ(entry.along.from_m, 30);
  EXPECT_EQ(entry.along.to_m, 80);
  EXPECT_EQ(entry.items, 8U);
  EXPECT_EQ(entry.bytes, 6000U);
  EXPECT_EQ(entry.digest, digest_of(tile_bytes(6000, 3)));
  EXPECT_THAT(*reader_->tile_index("west", "walls"), IsEmpty());
}

TEST_F(MapReaderTest, GivesBackEveryTile) {
  for (std::uint32_t i = 0; i < 10; ++i) {
    EXPECT_EQ(*reader_->tile("east", "tracklets", i), tile_bytes(3000 + 1000 * i, i));
  }
  EXPECT_EQ(*reader_->tile("west", "tracklets", 0), tile_bytes(50, 99));
  EXPECT_EQ(*reader_->tile("east", "walls", 7), tile_bytes(40, 7));
}

TEST_F(MapReaderTest, GivesBackTheCells) {
  const auto entries = reader_->cell_index("walls");
  ASSERT_TRUE(entries.ok()) << entries.error().line();
  ASSERT_EQ(entries->size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t cell = testing::kCells[i];
    EXPECT_EQ((*entries)[i].cell, cell);
    EXPECT_EQ((*entries)[i].items, 12U);
    EXPECT_EQ((*entries)[i].bytes, 500U);
    EXPECT_EQ((*entries)[i].digest, digest_of(tile_bytes(500, cell)));
    EXPECT_EQ(*reader_->cell("walls", cell), tile_bytes(500, cell));
  }
  EXPECT_THAT(*reader_->cell_index("tracklets"), IsEmpty());
}

// The cells: 0 [49.1, 49.105] x [8.5, 8.505]; 1 is to the east of it, 2 to the north.
TEST_F(MapReaderTest, FindsTheCellsThatMeetABox) {
  const auto found_in = [&](const Bounds& box) {
    const auto entries = reader_->cells_in("walls", box);
    std::vector<std::uint32_t> cells;
    if (!entries.ok()) ADD_FAILURE() << entries.error().line();
    if (entries.ok()) {
      for (const CellEntry& entry : *entries) cells.push_back(entry.cell);
    }
    return cells;
  };
  const auto& cells = testing::kCells;
  EXPECT_THAT(found_in({8.501, 49.101, 8.502, 49.102}), ElementsAre(cells[0]));
  EXPECT_THAT(found_in({8.504, 49.101, 8.506, 49.102}), ElementsAre(cells[0], cells[1]));
  EXPECT_THAT(found_in({8.501, 49.105, 8.502, 49.2}), ElementsAre(cells[0], cells[2]));
  EXPECT_THAT(found_in({-180, -90, 180, 90}), ElementsAre(cells[0], cells[1], cells[2]));
  EXPECT_THAT(found_in({8.511, 49.101, 9, 49.102}), IsEmpty());
}

TEST_F(MapReaderTest, AnAbsentCellOrLayerIsNotFound) {
  const auto cell = reader_->cell("walls", 7);
  ASSERT_FALSE(cell.ok());
  EXPECT_EQ(cell.error().code, ErrorCode::not_found);
  EXPECT_THAT(cell.error().line(), HasSubstr("the map has no layer walls, cell 7"));
  EXPECT_EQ(reader_->cell_index("signs").error().code, ErrorCode::not_found);
}

// Tiles of "east":   0 [0, 25]  1 [10, 35]  2 [20, 45]  3 [30, 80]  4 [40, 65] ... 9 [90, 115]
TEST_F(MapReaderTest, FindsTheTilesThatMeetARange) {
  EXPECT_THAT(found(26, 29), ElementsAre(1, 2));
  EXPECT_THAT(found(50, 52), ElementsAre(3, 4, 5));
  EXPECT_THAT(found(76, 79), ElementsAre(3, 6, 7));
  EXPECT_THAT(found(0, 200), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
}

TEST_F(MapReaderTest, RangesAreClosed) {
  EXPECT_THAT(found(25, 25), ElementsAre(0, 1, 2));
  EXPECT_THAT(found(25.001, 25.001), ElementsAre(1, 2));
  EXPECT_THAT(found(80, 80), ElementsAre(3, 6, 7, 8));
  EXPECT_THAT(found(80.001, 80.001), ElementsAre(6, 7, 8));
  EXPECT_THAT(found(-5, 0), ElementsAre(0));
  EXPECT_THAT(found(115, 300), ElementsAre(9));
}

TEST_F(MapReaderTest, ARangeBesideEveryTileFindsNone) {
  EXPECT_THAT(found(-5, -0.001), IsEmpty());
  EXPECT_THAT(found(115.001, 300), IsEmpty());
  EXPECT_THAT(*reader_->tiles_in("west", "walls", {0, 10}), IsEmpty());
}

TEST_F(MapReaderTest, NamesWhatIsNotThere) {
  const auto expect_not_found = [&](const Error& error, const std::string& what) {
    EXPECT_EQ(error.code, ErrorCode::not_found);
    EXPECT_EQ(error.line(), file_.string() + ": " + what);
  };
  expect_not_found(reader_->segment("north").error(), "the map has no segment north");
  expect_not_found(reader_->tile_index("north", "walls").error(), "the map has no segment north");
  expect_not_found(reader_->tiles_in("east", "glance", {}).error(), "the map has no layer glance");
  expect_not_found(reader_->tile("east", "walls", 8).error(),
                   "the map has no tile at segment east, layer walls, tile 8");
}

TEST_F(MapReaderTest, ASoundMapIsVerified) {
  const Status status = reader_->verify();
  EXPECT_TRUE(status.ok()) << status.error().line();
}

TEST_F(MapReaderTest, AnErrorLeavesTheReaderUsable) {
  EXPECT_FALSE(reader_->tile("east", "walls", 8).ok());
  EXPECT_TRUE(reader_->tile("east", "walls", 7).ok());
  EXPECT_THAT(found(26, 29), ElementsAre(1, 2));
}

TEST_F(MapReaderTest, CanBeMoved) {
  MapReader moved = std::move(*reader_);
  EXPECT_EQ(moved.build(), build_);
  EXPECT_TRUE(moved.tile("east", "walls", 7).ok());
}

// The start of the search is a difference, and differences are rounded.
TEST(MapReader, FindsATileByItsVeryEnds) {
  const testing::TempFolder folder;
  Result<MapWriter> writer = MapWriter::create(folder / "town.map");
  ASSERT_TRUE(writer->add_layer("l", "{}").ok());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> metres(0, 1000);
  std::vector<AlongRange> ranges;
  for (int i = 0; i < 300; ++i) {
    const double from_m = metres(random);
    ranges.push_back({from_m, from_m + metres(random)});
    const std::string segment = "s" + std::to_string(i);
    ASSERT_TRUE(writer->add_segment({segment, 2000, testing::kShortLine, {}}).ok());
    ASSERT_TRUE(writer->add_tile(segment, "l", 0, ranges.back(), 1, tile_bytes(9, 0)).ok());
  }
  ASSERT_TRUE(writer->finish().ok());
  const auto reader = MapReader::open(folder / "town.map");
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const std::string segment = "s" + std::to_string(i);
    for (const double end_m : {ranges[i].from_m, ranges[i].to_m}) {
      EXPECT_EQ(reader->tiles_in(segment, "l", {end_m, end_m})->size(), 1U) << segment;
    }
  }
}

TEST(MapReader, AMissingFileIsNotFound) {
  const testing::TempFolder folder;
  const auto reader = MapReader::open(folder / "none.map");
  ASSERT_FALSE(reader.ok());
  EXPECT_EQ(reader.error().code, ErrorCode::not_found);
  EXPECT_THAT(reader.error().line(), HasSubstr("none.map: there is no such file"));
}

}  // namespace
}  // namespace milepost
