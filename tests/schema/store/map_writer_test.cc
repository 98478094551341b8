#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>

#include "schema/base/digest.h"
#include "schema/base/file.h"
#include "schema/store/map_store.h"
#include "tests/schema/store/example_map.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;
using testing::content_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::tile_bytes;

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

class MapWriterTest : public ::testing::Test {
 protected:
  MapWriter writer() {
    Result<MapWriter> writer = MapWriter::create(file_);
    EXPECT_TRUE(writer.ok()) << writer.error().line();
    return std::move(*writer);
  }

  testing::TempFolder folder_;
  fs::path file_ = folder_ / "town.map";
};

TEST_F(MapWriterTest, TheFileIsThereAfterFinishAndNotBefore) {
  MapWriter map = writer();
  testing::add_example(map);
  EXPECT_FALSE(fs::exists(file_));
  ASSERT_TRUE(map.finish().ok());
  EXPECT_TRUE(fs::exists(file_));
  EXPECT_EQ(files_in(folder_.path()), 1);
}

TEST_F(MapWriterTest, AbandonedItLeavesNothing) {
  {
    MapWriter map = writer();
    testing::add_example(map);
  }
  EXPECT_EQ(files_in(folder_.path()), 0);
}

TEST_F(MapWriterTest, TheSameCallsGiveTheSameBytes) {
  const std::string build = testing::write_example(file_);
  const fs::path other = folder_ / "another-name.map";
  EXPECT_EQ(testing::write_example(other), build);
  EXPECT_EQ(content_of(other), content_of(file_));
}

// `"bytes":N,"digest":"D"` of a text.
std::string listed(const std::string& text) {
  return "\"bytes\":" + std::to_string(text.size()) + ",\"digest\":\"" + digest_of(as_bytes(text)) +
         "\"";
}

// The documents of FORMAT.md 7, assembled by hand.
TEST_F(MapWriterTest, TheBuildIsTheDigestThatFormatMdTells) {
  MapWriter map = writer();
  ASSERT_TRUE(map.set_feature_json("{}").ok());
  ASSERT_TRUE(map.add_layer("l", "{\"a\": 1.0}").ok());
  ASSERT_TRUE(
      map.add_segment({"s", 20, {{49, 8, 100, 0.5}, {50, 9, 101, 20}}, {{"t"}}, {{"d", 0, 20}}})
          .ok());
  ASSERT_TRUE(map.add_tile("s", "l", 6, {1, 2.5}, 3, as_bytes("abc")).ok());
  ASSERT_TRUE(map.add_cell("l", 0, 4, as_bytes("walls")).ok());
  const std::string of_map =
      R"({"bounds":{"east_deg":9,"north_deg":50,"south_deg":-90,"west_deg":-180},"feature":{},)"
      R"("layer_parameters":{"l":{"a":1}},"layers":["l"],"length_m":20,"segment_count":1})";
  const std::string areas = R"({"cells":{"l":[{"bytes":5,"cell":0,"digest":")" +
                            digest_of(as_bytes("walls")) +
                            R"(","east_deg":-179.995,"items":4,"north_deg":-89.995,)"
                            R"("south_deg":-90,"west_deg":-180}]}})";
  const std::string segment =
      R"({"length_m":20,"line":[[49,8,100,0.5],[50,9,101,20]],)"
      R"("passes":[{"drive":"d","from_m":0,"to_m":20}],"segment":"s",)"
      R"("successors":[{"segment":"t"}],"tiles":{"l":[{"bytes":3,"digest":")" +
      digest_of(as_bytes("abc")) + R"(","from_m":1,"index":6,"items":3,"to_m":2.5}]}})";
  const std::string manifest = "{\"areas\":{" + listed(areas) + "},\"format\":3,\"map\":{" +
                               listed(of_map) + "},\"segments\":[{" + listed(segment) +
                               ",\"segment\":\"s\"}]}";
  const std::string build = *map.finish();
  const auto reader = MapReader::open(file_);
  ASSERT_TRUE(reader.ok()) << reader.error().line();
  EXPECT_EQ(reader->map_document(), of_map);
  EXPECT_EQ(*reader->areas_document(), areas);
  EXPECT_EQ(*reader->segment_document("s"), segment);
  EXPECT_EQ(reader->manifest_document(), manifest);
  EXPECT_EQ(build, digest_of(as_bytes(manifest)));
}

TEST_F(MapWriterTest, TheOrderOfTheCallsIsNotInTheBuild) {
  const auto write = [&](std::uint32_t first, std::uint32_t second) {
    MapWriter map = writer();
    EXPECT_TRUE(map.add_layer("l", "{}").ok());
    EXPECT_TRUE(map.add_segment({"s", 20, testing::kShortLine, {}}).ok());
    EXPECT_TRUE(map.add_tile("s", "l", first, {0, 1}, 1, tile_bytes(10, first)).ok());
    EXPECT_TRUE(map.add_tile("s", "l", second, {0, 1}, 1, tile_bytes(10, second)).ok());
    return *map.finish();
  };
  EXPECT_EQ(write(1, 2), write(2, 1));
  EXPECT_NE(write(1, 2), write(1, 3));
}

TEST_F(MapWriterTest, APositionErrorCanFollowItsSegment) {
  const PositionError error{0.15, 120, true};
  const auto write = [&](const PositionError& at_first, const PositionError& then) {
    MapWriter map = writer();
    EXPECT_TRUE(map.add_segment({"r", 20, testing::kShortLine, {}}).ok());
    EXPECT_TRUE(map.add_segment({"s", 20, testing::kShortLine, {}, {}, at_first}).ok());
    EXPECT_TRUE(map.set_position_error("s", then).ok());
    return *map.finish();
  };
  EXPECT_EQ(write({}, error), write(error, error));
  EXPECT_NE(write(error, {}), write(error, error));
}

TEST_F(MapWriterTest, ReplacesAMapWhileAReaderGoesOnReadingItsBuild) {
  const std::string old_build = testing::write_example(file_);
  const auto reader = MapReader::open(file_);
  ASSERT_TRUE(reader.ok());
  MapWriter map = writer();
  ASSERT_TRUE(map.add_layer("tracklets", "{}").ok());
  ASSERT_TRUE(map.add_segment({"new", 1, testing::kShortLine, {}}).ok());
  const std::string new_build = *map.finish();

  EXPECT_TRUE(reader->verify().ok());
  EXPECT_EQ(reader->build(), old_build);
  EXPECT_EQ(*reader->tile("east", "tracklets", 9), tile_bytes(12000, 9));
  EXPECT_NE(new_build, old_build);
  EXPECT_EQ(MapReader::open(file_)->build(), new_build);
  EXPECT_THAT(MapReader::open(file_)->segment_ids(), ElementsAre("new"));
}

TEST_F(MapWriterTest, AWriterThatIsDoneDoesNotDisturbTheNext) {
  auto first = std::make_unique<MapWriter>(writer());
  ASSERT_TRUE(first->finish().ok());
  MapWriter second = writer();
  first.reset();
  testing::add_example(second);
  ASSERT_TRUE(second.finish().ok());
  EXPECT_TRUE(MapReader::open(file_)->verify().ok());
}

TEST_F(MapWriterTest, LeftoversOfAKilledWriterDoNotMatter) {
  std::ofstream(partial_path_for(file_)) << "half a map";
  testing::write_example(file_);
  EXPECT_TRUE(MapReader::open(file_)->verify().ok());
}

TEST_F(MapWriterTest, ReplacesNothingButMaps) {
  std::ofstream(file_) << "notes";
  const auto over_notes = MapWriter::create(file_);
  ASSERT_FALSE(over_notes.ok());
  EXPECT_EQ(over_notes.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(over_notes.error().line(), HasSubstr("town.map: the existing file is not a"));
  EXPECT_EQ(content_of(file_), "notes");
  EXPECT_EQ(files_in(folder_.path()), 1);
}

TEST_F(MapWriterTest, AMapWithoutAnythingIsAMap) {
  MapWriter map = writer();
  ASSERT_TRUE(map.finish().ok());
  const auto reader = MapReader::open(file_);
  ASSERT_TRUE(reader.ok()) << reader.error().line();
  EXPECT_EQ(reader->feature_json(), "{}");
  EXPECT_EQ(reader->bounds().north_deg, 0);
  EXPECT_TRUE(reader->verify().ok());
}

TEST_F(MapWriterTest, RefusesWhatCannotBeStoredAndGoesOn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const StoredVertex begin{49, 8, 100, 0};
  MapWriter map = writer();
  testing::add_example(map);
  const auto expect_refused = [&](const Status& status, const std::string& what) {
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::invalid_input);
    EXPECT_EQ(status.error().line(), file_.string() + what);
  };
  expect_refused(map.add_layer("", "{}"), ": '' is not a layer name");
  const std::string deep = "{\"a\": " + std::string(40, '[') + std::string(40, ']') + "}";
  for (const std::string& json :
       {std::string(), std::string("[]"), std::string("{"), std::string("{} {}"),
        std::string("{\"a\": NaN}"), std::string("{\"a\": \"\xff\"}"), deep}) {
    expect_refused(map.add_layer("l", json),
                   ": the parameters of layer l are not a JSON object (FORMAT.md 2.4)");
    expect_refused(map.set_feature_json(json),
                   ": the feature parameters are not a JSON object (FORMAT.md 2.3)");
  }

  const auto with = [&](const StoredVertex& end) {
    return StoredSegment{"c", 1, {begin, end}, {}};
  };
  expect_refused(map.add_segment({"a/b", 1, testing::kShortLine, {}}),
                 ": 'a/b' is not a segment id");
  expect_refused(map.add_segment({"c", 1, testing::kShortLine, {{"d"}, {"e/f"}}}),
                 ", segment c: a successor is not a segment id (FORMAT.md 2.5)");
  expect_refused(map.add_segment({"c", 1, testing::kShortLine, {{"d", "e/f"}}}),
                 ", segment c: a successor's map is not a name (FORMAT.md 2.5)");
  expect_refused(map.add_segment({"c", 1, testing::kShortLine, {}, {{"e/f", 0, 1}}}),
                 ", segment c: a pass's drive is not a name (FORMAT.md 2.5)");
  for (const StoredPass& pass : {StoredPass{"d", -1, 1}, StoredPass{"d", 2, 1},
                                 StoredPass{"d", nan, 1}, StoredPass{"d", 0, nan}}) {
    expect_refused(map.add_segment({"c", 1, testing::kShortLine, {}, {pass}}),
                   ", segment c: a pass's range is not ascending from 0 on (FORMAT.md 2.5)");
  }
  for (const PositionError& error :
       {PositionError{-0.1}, PositionError{nan}, PositionError{0.1, nan}}) {
    expect_refused(map.add_segment({"c", 1, testing::kShortLine, {}, {}, error}),
                   ", segment c: the position error is not a distance (FORMAT.md 2.5)");
    expect_refused(map.set_position_error("c", error),
                   ", segment c: the position error is not a distance (FORMAT.md 2.5)");
  }
  for (const double length_m : {nan, -1.0, 0.0, 1e8 + 1}) {
    expect_refused(map.add_segment({"c", length_m, testing::kShortLine, {}}),
                   ", segment c: the length is not above 0 and at most 100000 km (FORMAT.md 2.5)");
  }
  expect_refused(map.add_segment({"c", 1, {begin}, {}}),
                 ", segment c: a line needs two or more vertices (FORMAT.md 2.5)");
  for (const StoredVertex& end : {StoredVertex{nan, 8, 100, 1},
                                  {90.01, 8, 100, 1},
                                  {49, 180.01, 100, 1},
                                  {49, -180.01, 100, 1}}) {
    expect_refused(map.add_segment(with(end)),
                   ", segment c, vertex 1: the position is not a valid latitude and longitude "
                   "(FORMAT.md 2.5)");
  }
  for (const double altitude_m : {nan, 100001.0, -100001.0}) {
    expect_refused(map.add_segment(with({49, 8, altitude_m, 1})),
                   ", segment c, vertex 1: the altitude is more than 100 km (FORMAT.md 2.5)");
  }
  for (const double along_m : {nan, -0.5, 1e8 + 1}) {
    expect_refused(map.add_segment(with({49, 8, 100, along_m})),
                   ", segment c, vertex 1: along_m does not ascend from 0 (FORMAT.md 2.5)");
  }

  const Bytes bytes = tile_bytes(10, 1);
  for (const AlongRange& along : {AlongRange{2, 1}, {nan, 1}, {0, nan}, {0, 1e8 + 1}}) {
    expect_refused(map.add_tile("east", "walls", 8, along, 1, bytes),
                   ", segment east, layer walls, tile 8: the along range is not ascending and "
                   "within 100000 km (FORMAT.md 2.6)");
  }
  expect_refused(map.add_tile("east", "walls", 8, {0, 1}, 1, {}),
                 ", segment east, layer walls, tile 8: a tile without bytes (FORMAT.md 2.6)");
  expect_refused(map.add_tile("east", "walls", 8, {0, 1}, std::uint64_t{1} << 63U, bytes),
                 ", segment east, layer walls, tile 8: a tile of too many items (FORMAT.md 2.6)");
  expect_refused(map.add_cell("walls", kCellRows * kCellColumns, 1, bytes),
                 ": the grid has no cell 2592000000");
  expect_refused(map.add_cell("walls", 77, 1, {}),
                 ", layer walls, cell 77: a tile without bytes (FORMAT.md 2.6)");
  const auto build = map.finish();
  ASSERT_TRUE(build.ok()) << build.error().line();
  EXPECT_EQ(*build, testing::write_example(folder_ / "same.map"));
}

TEST_F(MapWriterTest, AfterAnErrorOfSqliteThereIsNoMap) {
  MapWriter map = writer();
  testing::add_example(map);
  const Status twice = map.add_tile("east", "walls", 7, {0, 1}, 1, tile_bytes(9, 7));
  ASSERT_FALSE(twice.ok());
  EXPECT_EQ(twice.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(twice.error().line(), HasSubstr(file_.string() + ": UNIQUE constraint failed"));
  EXPECT_FALSE(map.add_layer("more", "{}").ok());
  const auto build = map.finish();
  ASSERT_FALSE(build.ok());
  EXPECT_EQ(build.error().line(), twice.error().line());
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(MapWriterTest, ACellNeedsItsLayerAndIsThereOnce) {
  for (const std::string layer : {"nowhere", "walls"}) {
    MapWriter map = writer();
    testing::add_example(map);
    const Status status = map.add_cell(layer, testing::kCells[0], 1, tile_bytes(9, 7));
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::invalid_input);
    EXPECT_THAT(status.error().line(), HasSubstr("constraint failed"));
  }
}

TEST_F(MapWriterTest, TheBoundsAreAroundTheCellsToo) {
  MapWriter map = writer();
  ASSERT_TRUE(map.add_layer("walls", "{}").ok());
  ASSERT_TRUE(
      map.add_cell("walls", GridCell::at(49.101, 8.501).number(), 0, tile_bytes(9, 1)).ok());
  ASSERT_TRUE(
      map.add_cell("walls", GridCell::at(49.106, 8.491).number(), 0, tile_bytes(9, 2)).ok());
  ASSERT_TRUE(map.finish().ok());
  const auto reader = MapReader::open(file_);
  ASSERT_TRUE(reader.ok()) << reader.error().line();
  EXPECT_EQ(reader->bounds().west_deg, 8.49);
  EXPECT_EQ(reader->bounds().south_deg, 49.1);
  EXPECT_EQ(reader->bounds().east_deg, 8.505);
  EXPECT_EQ(reader->bounds().north_deg, 49.11);
  EXPECT_TRUE(reader->verify().ok());
}

TEST_F(MapWriterTest, ATileNeedsItsSegmentAndItsLayer) {
  MapWriter map = writer();
  testing::add_example(map);
  const Status status = map.add_tile("nowhere", "walls", 0, {0, 1}, 1, tile_bytes(9, 7));
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(status.error().line(), HasSubstr("FOREIGN KEY constraint failed"));
}

TEST_F(MapWriterTest, NamesAFolderThatIsNotThere) {
  const auto writer = MapWriter::create(folder_ / "none" / "town.map");
  ASSERT_FALSE(writer.ok());
  EXPECT_EQ(writer.error().code, ErrorCode::io);
  EXPECT_THAT(writer.error().line(), HasSubstr("none/town.map: there is no folder"));
}

TEST_F(MapWriterTest, NamesAPlaceThatCannotBeTaken) {
  MapWriter map = writer();
  fs::create_directories(file_ / "full");
  const auto build = map.finish();
  ASSERT_FALSE(build.ok());
  EXPECT_EQ(build.error().code, ErrorCode::io);
  EXPECT_THAT(build.error().line(), HasSubstr("town.map: cannot be replaced"));
  EXPECT_EQ(files_in(folder_.path()), 1);
}

}  // namespace
}  // namespace milepost
