// Files that are not a map, or no longer the map that was written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "schema/store/map_store.h"
#include "schema/store/sqlite.h"
#include "tests/schema/store/example_map.h"
#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class MapDamageTest : public ::testing::Test {
 protected:
  void write_file(const std::string& content) const {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << content;
  }

  // Changes the map's tables directly, not through the store.
  void change(const std::string& sql) const {
    auto database = sqlite::Database::open(file_, sqlite::Access::read_write);
    ASSERT_TRUE(database.ok());
    const Status changed = database->execute(sql);
    ASSERT_TRUE(changed.ok()) << changed.error().line();
  }

  std::string open_error() const {
    const auto reader = MapReader::open(file_);
    if (reader.ok()) return "no error";
    EXPECT_EQ(reader.error().code, ErrorCode::corrupt);
    return reader.error().line();
  }

  std::string verify_error() const {
    const auto reader = MapReader::open(file_);
    if (!reader.ok()) return "cannot be opened: " + reader.error().line();
    const Status status = reader->verify();
    if (status.ok()) return "no error";
    EXPECT_EQ(status.error().code, ErrorCode::corrupt);
    return status.error().line();
  }

  // Flips a byte in the middle of a tile's bytes.
  void damage_tile(std::uint32_t index) const {
    const Bytes bytes = testing::tile_bytes(3000 + 1000 * index, index);
    std::string content = testing::content_of(file_);
    const std::size_t place = content.find(as_text(ByteView(bytes).subspan(1000, 32)));
    ASSERT_NE(place, std::string::npos);
    content[place] = static_cast<char>(content[place] ^ 1);
    write_file(content);
  }

  testing::TempFolder folder_;
  fs::path file_ = folder_ / "town.map";
  std::string build_ = testing::write_example(file_);
};

TEST_F(MapDamageTest, AnotherKindOfFileIsNoMap) {
  write_file("filename,timestamp_s,east_m,north_m,up_m,heading_deg\n" + std::string(5000, '1'));
  EXPECT_THAT(open_error(), HasSubstr("town.map: file is not a database"));
  write_file("");
  EXPECT_THAT(open_error(), HasSubstr("town.map: this is not a milepost map"));
}

TEST_F(MapDamageTest, AnotherDatabaseIsNoMap) {
  fs::remove(file_);
  change("CREATE TABLE t (x)");
  EXPECT_THAT(open_error(), HasSubstr("town.map: this is not a milepost map"));
}

TEST_F(MapDamageTest, AnotherFormatVersionIsNamed) {
  change("PRAGMA user_version = 1");
  EXPECT_THAT(open_error(), HasSubstr("town.map: this is a map of format version 1, not 3; build "
                                      "the map anew"));
}

TEST_F(MapDamageTest, AMissingTableIsNamed) {
  change("DROP TABLE successors");
  EXPECT_THAT(open_error(), HasSubstr("town.map: no such table: successors"));
}

TEST_F(MapDamageTest, AMissingKeyIsNamed) {
  for (const std::string key :
       {"build", "manifest", "feature", "west_deg", "south_deg", "east_deg", "north_deg"}) {
    testing::write_example(file_);
    change("DELETE FROM meta WHERE key = '" + key + "'");
    EXPECT_THAT(open_error(), HasSubstr("town.map: the map lacks its " + key));
  }
}

TEST_F(MapDamageTest, ABuildIsADigest) {
  change("UPDATE meta SET value = 'newest' WHERE key = 'build'");
  EXPECT_THAT(open_error(), HasSubstr("town.map: the map's build is not a digest"));
}

// No JSON text can hold the last one.
TEST_F(MapDamageTest, NamesAreIds) {
  for (const std::string name : {"x'2e2e'", "x'612f62'", "''", "x'73ff'"}) {
    for (const std::string table : {"segments SET id", "layers SET name"}) {
      testing::write_example(file_);
      change("UPDATE OR REPLACE " + table + " = CAST(" + name + " AS TEXT)");
      EXPECT_THAT(open_error(), HasSubstr("town.map: a ")) << table << name;
      EXPECT_THAT(open_error(), HasSubstr("'s name is malformed; ")) << table << name;
    }
  }
}

TEST_F(MapDamageTest, BoundsAreDegrees) {
  for (const std::string value : {"9e999", "-181"}) {
    testing::write_example(file_);
    change("UPDATE meta SET value = " + value + " WHERE key = 'west_deg'");
    EXPECT_THAT(open_error(), HasSubstr("town.map: the map's bounds are not in degrees"));
  }
}

TEST_F(MapDamageTest, SegmentsAreWhatAWriterTakes) {
  const auto segment_error = [&](const std::string& sql) {
    testing::write_example(file_);
    change(sql);
    const auto reader = MapReader::open(file_);
    if (!reader.ok()) return "cannot be opened: " + reader.error().line();
    const auto segment = reader->segment("east");
    if (segment.ok()) return std::string("no error");
    EXPECT_EQ(segment.error().code, ErrorCode::corrupt);
    return segment.error().line();
  };
  EXPECT_THAT(segment_error("UPDATE vertices SET latitude_deg = 91 WHERE position = 1"),
              HasSubstr("town.map, segment east, vertex 1: the position is not a valid latitude"));
  EXPECT_THAT(segment_error("UPDATE vertices SET altitude_m = 9e999 WHERE position = 0"),
              HasSubstr("town.map, segment east, vertex 0: the altitude is more than 100 km"));
  EXPECT_THAT(segment_error("UPDATE vertices SET along_m = -1 WHERE position = 1"),
              HasSubstr("town.map, segment east, vertex 1: along_m does not ascend"));
  EXPECT_THAT(segment_error("DELETE FROM vertices"),
              HasSubstr("town.map, segment east: a line needs two or more vertices"));
  EXPECT_THAT(segment_error("UPDATE passes SET from_m = 999"),
              HasSubstr("town.map, segment east: a pass's range is not ascending"));
  EXPECT_THAT(segment_error("UPDATE successors SET successor = CAST(x'73ff' AS TEXT)"),
              HasSubstr("town.map, segment east: a successor is not a segment id"));
}

TEST_F(MapDamageTest, ATruncatedFileIsRefused) {
  const std::string whole = testing::content_of(file_);
  constexpr std::size_t kPage = 4096;
  for (std::size_t length = 1; length <= whole.size() - kPage; length += 1777) {
    write_file(whole.substr(0, length));
    EXPECT_THAT(open_error(), HasSubstr("town.map: ")) << length;
  }
}

// SQLite reads a partial last page as a page that ends in zeros.
TEST_F(MapDamageTest, AFileWithoutItsLastBytesIsCaughtByVerify) {
  Result<MapWriter> writer = MapWriter::create(file_);
  ASSERT_TRUE(writer->add_layer("l", "{}").ok());
  ASSERT_TRUE(writer->add_segment({"s", 1, testing::kShortLine, {}}).ok());
  ASSERT_TRUE(writer->add_tile("s", "l", 0, {0, 1}, 1, testing::tile_bytes(100'000, 1)).ok());
  ASSERT_TRUE(writer->finish().ok());
  EXPECT_EQ(verify_error(), "no error");
  const std::string whole = testing::content_of(file_);
  write_file(whole.substr(0, whole.size() - 4000));
  EXPECT_THAT(verify_error(), HasSubstr("tile 0: the tile's bytes do not match its digest"));
}

TEST_F(MapDamageTest, ADamagedTileIsCaughtByReadingIt) {
  damage_tile(4);
  const auto reader = MapReader::open(file_);
  ASSERT_TRUE(reader.ok());
  const auto tile = reader->tile("east", "tracklets", 4);
  ASSERT_FALSE(tile.ok());
  EXPECT_EQ(tile.error().code, ErrorCode::corrupt);
  EXPECT_THAT(tile.error().line(), HasSubstr("town.map, segment east, layer tracklets, tile 4: the "
                                             "tile's bytes do not match its digest"));
  EXPECT_TRUE(reader->tile("east", "tracklets", 5).ok());
}

TEST_F(MapDamageTest, ADamagedTileIsCaughtByVerify) {
  damage_tile(9);
  EXPECT_THAT(verify_error(), HasSubstr("segment east, layer tracklets, tile 9: the tile's bytes"));
}

TEST_F(MapDamageTest, ADamagedIndexEntryIsNamed) {
  change("PRAGMA ignore_check_constraints = ON; UPDATE tiles SET digest = 'x' WHERE number = 2");
  const auto reader = MapReader::open(file_);
  const auto entries = reader->tiles_in("east", "tracklets", {50, 51});
  ASSERT_FALSE(entries.ok());
  EXPECT_EQ(entries.error().code, ErrorCode::corrupt);
  EXPECT_THAT(
      entries.error().line(),
      HasSubstr("segment east, layer tracklets, tile 2: the entry in the tile index is damaged"));
}

TEST_F(MapDamageTest, ADamagedEntryOfTheCellsIsNamed) {
  change("PRAGMA ignore_check_constraints = ON; UPDATE cells SET items = -1");
  const auto reader = MapReader::open(file_);
  const auto entries = reader->cell_index("walls");
  ASSERT_FALSE(entries.ok());
  EXPECT_EQ(entries.error().code, ErrorCode::corrupt);
  EXPECT_THAT(entries.error().line(), HasSubstr("layer walls, cell 2003077700: the entry in the "
                                                "index of cells is damaged"));
}

struct Change {
  const char* name;
  const char* sql;
  const char* message;
};

void PrintTo(const Change& change, std::ostream* out) { *out << change.name; }

class MapChange : public MapDamageTest, public ::testing::WithParamInterface<Change> {};

TEST_P(MapChange, IsCaughtByVerify) {
  change(GetParam().sql);
  EXPECT_THAT(verify_error(), HasSubstr(GetParam().message));
}

const char* const kOtherBuild = "town.map: the content has the build ";
const char* const kOtherManifest = "town.map: the manifest is not that of build ";
const char* const kOtherSummary =
    "town.map: its layers, parameters, bounds, datum or lengths are not those of build ";

const std::vector<Change> kChanges = {
    {"Feature", "UPDATE meta SET value = '{}' WHERE key = 'feature'", kOtherSummary},
    {"Build", "UPDATE meta SET value = '0123456789abcdef0123456789abcdef' WHERE key = 'build'",
     kOtherManifest},
    {"Manifest", "UPDATE meta SET value = replace(value, '3', '4') WHERE key = 'manifest'",
     kOtherManifest},
    {"Layer", "UPDATE layers SET parameters = '{\"a\": 1}' WHERE name = 'walls'", kOtherSummary},
    {"LayerWithoutParameters", "UPDATE layers SET parameters = '[]' WHERE name = 'walls'",
     "town.map, layer walls: the parameters are not a JSON object"},
    {"Length", "UPDATE segments SET length_m = 12 WHERE id = 'west'", kOtherSummary},
    {"MissingSegment", "DELETE FROM segments WHERE id = 'west'", kOtherSummary},
    {"OtherSegment", "UPDATE segments SET id = 'wes' WHERE id = 'west'",
     "town.map: its segments are not those of build "},
    {"Vertex", "UPDATE vertices SET altitude_m = 1 WHERE position = 1", kOtherBuild},
    {"Successor", "UPDATE successors SET successor = 'east' WHERE position = 0", kOtherBuild},
    {"MissingSuccessor", "DELETE FROM successors WHERE position = 1", kOtherBuild},
    {"Items", "UPDATE tiles SET items = 0 WHERE number = 5", kOtherBuild},
    {"From", "UPDATE tiles SET from_m = 51 WHERE number = 5", kOtherBuild},
    {"MissingTile", "DELETE FROM tiles WHERE number = 5", kOtherBuild},
    {"CellItems", "UPDATE cells SET items = 0", kOtherBuild},
    {"MissingCell", "DELETE FROM cells WHERE number % 2 = 1", kOtherBuild},
    {"CellBytes", "UPDATE cells SET bytes = 1 WHERE number = 27820 * 72000 + 37700",
     "layer walls, cell 2003077700: the tile's bytes do not match its digest"},
    {"CellContent", "UPDATE frames SET frame = x'00' WHERE id = 12",
     "layer walls, cell 2003077700: the tile's bytes do not match its digest"},
    {"MissingCellBytes", "DELETE FROM frames WHERE id = 14",
     "layer walls, cell 2003149700: the tile's bytes do not match its digest"},
    {"Bounds", "UPDATE meta SET value = 1.0 WHERE key = 'west_deg'", kOtherSummary},
    {"MissingBytes", "DELETE FROM frames WHERE id = 5",
     "tile 5: the tile's bytes do not match its digest"},
    {"TileContent", "UPDATE frames SET frame = x'00' WHERE id = 5",
     "tile 5: the tile's bytes do not match its digest"},
    {"Bytes", "UPDATE tiles SET bytes = 1 WHERE number = 5",
     "tile 5: the tile's bytes do not match its digest"},
    {"Pass", "UPDATE passes SET to_m = 131 WHERE position = 0", kOtherBuild},
    {"MissingPass", "DELETE FROM passes WHERE position = 1", kOtherBuild},
    {"NeighbourMap", "UPDATE successors SET map = '' WHERE position = 1", kOtherBuild},
    {"PositionSigma", "UPDATE segments SET position_sigma_m = 0.01 WHERE id = 'east'", kOtherBuild},
    {"PositionCorrelation", "UPDATE segments SET position_correlation_m = NULL", kOtherBuild},
    {"Assumed", "UPDATE segments SET assumed = 0", kOtherBuild},
};

INSTANTIATE_TEST_SUITE_P(Each, MapChange, ::testing::ValuesIn(kChanges),
                         [](const auto& test) { return std::string(test.param.name); });

// What the client uses is checked when it is read, also without verify.
TEST_F(MapDamageTest, AChangedSegmentIsCaughtByReadingIt) {
  for (const std::string sql :
       {"UPDATE vertices SET latitude_deg = 49.0001 WHERE segment = 'east' AND position = 0",
        "UPDATE successors SET successor = 'east'", "UPDATE passes SET drive = 'sunday'",
        "UPDATE segments SET position_sigma_m = 0.01",
        "UPDATE tiles SET to_m = 26 WHERE number = 0 AND segment = 'east'",
        "UPDATE tiles SET digest = '0123456789abcdef0123456789abcdef' WHERE number = 4"}) {
    SCOPED_TRACE(sql);
    testing::write_example(file_);
    change(sql);
    const auto reader = MapReader::open(file_);
    ASSERT_TRUE(reader.ok()) << reader.error().line();
    const auto expect_caught = [](const auto& read) {
      ASSERT_FALSE(read.ok());
      EXPECT_EQ(read.error().code, ErrorCode::corrupt);
      EXPECT_THAT(read.error().line(), HasSubstr("town.map, segment east: its line, links, passes "
                                                 "or tile index are not those of build "));
    };
    expect_caught(reader->segment("east"));
    expect_caught(reader->segment_document("east"));
    expect_caught(reader->tile_index("east", "tracklets"));
    expect_caught(reader->tiles_in("east", "tracklets", {0, 20}));
    expect_caught(reader->tile("east", "tracklets", 4));
  }
}

TEST_F(MapDamageTest, AChangedIndexOfCellsIsCaughtByReadingIt) {
  change("UPDATE cells SET number = number + 1 WHERE number % 2 = 1");
  const auto reader = MapReader::open(file_);
  const auto index = reader->cell_index("walls");
  ASSERT_FALSE(index.ok());
  EXPECT_EQ(index.error().code, ErrorCode::corrupt);
  EXPECT_THAT(index.error().line(),
              HasSubstr("town.map: the index of its cells is not that of build "));
  EXPECT_FALSE(reader->cell("walls", testing::kCells[0]).ok());
}

// Whatever byte is flipped: no crash, and if the map's content differs from what was written,
// verify reports it.
TEST_F(MapDamageTest, FlippedBytesDoNoHarmUnseen) {
  const std::string whole = testing::content_of(file_);
  int caught = 0;
  for (std::size_t i = 0; i < whole.size(); i += 211) {
    std::string content = whole;
    content[i] = static_cast<char>(content[i] ^ 0x55);
    write_file(content);
    const auto reader = MapReader::open(file_);
    if (!reader.ok() || !reader->verify().ok()) {
      ++caught;
      continue;
    }
    ASSERT_EQ(reader->build(), build_) << "byte " << i;
    for (std::uint32_t index = 0; index < 10; ++index) {
      ASSERT_EQ(*reader->tile("east", "tracklets", index),
                testing::tile_bytes(3000 + 1000 * index, index))
          << "byte " << i;
    }
  }
  EXPECT_GT(caught, 300);  // most of the file is encoded tiles
}

}  // namespace
}  // namespace milepost
