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
  EXPECT_THAT(open_error(), HasSubstr("town.map: this is a map of format version 1, not 2"));
}

TEST_F(MapDamageTest, AMissingTableIsNamed) {
  change("DROP TABLE successors");
  EXPECT_THAT(open_error(), HasSubstr("town.map: no such table: successors"));
}

TEST_F(MapDamageTest, AMissingKeyIsNamed) {
  for (const std::string key :
       {"build", "feature", "west_deg", "south_deg", "east_deg", "north_deg"}) {
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
  EXPECT_THAT(segment_error("UPDATE segments SET length_m = 0"),
              HasSubstr("town.map, segment east: the length is not above 0"));
  EXPECT_THAT(segment_error("UPDATE successors SET successor = CAST(x'73ff' AS TEXT)"),
              HasSubstr("town.map, segment east: a successor's name is malformed"));
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
  const auto entries = reader->tiles_in("east", "tracklets", {20, 21});
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

const std::vector<Change> kChanges = {
    {"Feature", "UPDATE meta SET value = '{}' WHERE key = 'feature'", kOtherBuild},
    {"Build", "UPDATE meta SET value = '0123456789abcdef0123456789abcdef' WHERE key = 'build'",
     kOtherBuild},
    {"Layer", "UPDATE layers SET parameters = '[]' WHERE name = 'walls'", kOtherBuild},
    {"Length", "UPDATE segments SET length_m = 12 WHERE id = 'west'", kOtherBuild},
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
    {"Bounds", "UPDATE meta SET value = 1.0 WHERE key = 'west_deg'",
     "the bounds are not those of the vertices"},
    {"MissingBytes", "DELETE FROM frames WHERE id = 5",
     "tile 5: the tile's bytes do not match its digest"},
    {"TileContent", "UPDATE frames SET frame = x'00' WHERE id = 5",
     "tile 5: the tile's bytes do not match its digest"},
    {"Bytes", "UPDATE tiles SET bytes = 1 WHERE number = 5",
     "tile 5: the tile's bytes do not match its digest"},
    {"Span", "UPDATE spans SET longest_m = 49 WHERE segment = 'east' AND layer = 'tracklets'",
     "segment east, layer tracklets: a tile is longer than the longest one"},
    {"MissingSpan", "DELETE FROM spans WHERE layer = 'walls'",
     "segment east, layer walls: a tile is longer than the longest one"},
};

INSTANTIATE_TEST_SUITE_P(Each, MapChange, ::testing::ValuesIn(kChanges),
                         [](const auto& test) { return std::string(test.param.name); });

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
