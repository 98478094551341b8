// Tiles of walls: the assignment of walls to cells, and tables that each violate one paragraph of
// FORMAT.md.
#include "schema/tile/wall.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "schema/tile/codec.h"
#include "schema/tile/columns.h"
#include "schema/tile/table.h"
#include "schema/tile/wall_tile_generated.h"
#include "schema/tile/zstd_frame.h"
#include "tests/schema/tile/hostile_table.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::uint32_t kCell = GridCell::at(49.0012, 8.4031).number();

// The arrays of a valid table of two walls.
struct Table {
  std::uint32_t cell = kCell;
  std::vector<std::int32_t> begin_north = {120'000, -3'000};
  std::vector<std::int32_t> begin_east = {310'000, 500'000};
  std::vector<std::int32_t> way_north = {10'000, 4'000};
  std::vector<std::int32_t> way_east = {-20'000, 0};
  std::vector<std::uint16_t> sigma_cm = {50, 65535};
};

Bytes bytes_of(const Table& t, const char* identifier = "MPW1") {
  flatbuffers::FlatBufferBuilder builder;
  const auto root = fbs::CreateWallTileDirect(builder, t.cell, &t.begin_north, &t.begin_east,
                                              &t.way_north, &t.way_east, &t.sigma_cm);
  return testing::content_of(builder, root, identifier);
}

std::string message(const Bytes& content) { return testing::message_of(content, decode_walls); }

TEST(WallTable, TheSoundOneIsTaken) {
  const auto tile = decode_walls(compress_frame(bytes_of({})));
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_EQ(tile->cell, kCell);
  ASSERT_EQ(tile->walls.size(), 2U);
  EXPECT_DOUBLE_EQ(tile->walls[0].begin.latitude_deg, 49.0012);
  EXPECT_DOUBLE_EQ(tile->walls[0].begin.longitude_deg, 8.4031);
  EXPECT_DOUBLE_EQ(tile->walls[0].end.latitude_deg, 49.0013);
  EXPECT_DOUBLE_EQ(tile->walls[0].end.longitude_deg, 8.4029);
  EXPECT_DOUBLE_EQ(tile->walls[0].sigma_m, 0.5);
  EXPECT_DOUBLE_EQ(tile->walls[1].sigma_m, 655.35);
}

TEST(WallTable, OneWithoutWallsIsTaken) {
  const auto tile = decode_walls(encode_walls({kCell, {}}));
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_TRUE(tile->walls.empty());
}

using TableViolation = testing::Violation<Table>;
class WallTableViolation : public ::testing::TestWithParam<TableViolation> {};

TEST_P(WallTableViolation, IsRefused) {
  Table table;
  GetParam().make(table);
  EXPECT_THAT(message(bytes_of(table)), HasSubstr(GetParam().message));
}

const std::vector<TableViolation> kViolations = {
    {"Cell", [](Table& t) { t.cell = kCellRows * kCellColumns; }, "no such cell (FORMAT.md 6.1)"},
    {"BeginEast", [](Table& t) { t.begin_east.push_back(1); }, "begin_east"},
    {"WayNorth", [](Table& t) { t.way_north.pop_back(); }, "way_north"},
    {"WayEast", [](Table& t) { t.way_east.clear(); }, "way_east"},
    {"SigmaLength", [](Table& t) { t.sigma_cm.push_back(1); }, "sigma_cm"},
    {"Long", [](Table& t) { t.way_north[1] = 10'000'001; },
     "wall 1: the wall spans more than 0.1 degrees (FORMAT.md 6.4)"},
    {"LongBackwards", [](Table& t) { t.way_east[1] = std::numeric_limits<std::int32_t>::min(); },
     "wall 1: the wall spans more than 0.1 degrees (FORMAT.md 6.4)"},
    {"Outside", [](Table& t) { t.begin_north[1] = -4'001; },
     "wall 1: the wall lies outside its cell (FORMAT.md 6.4)"},
    {"Pole",
     [](Table& t) {
       t.cell = kCellRows * kCellColumns - 1;
       t.begin_north = {490'000, 499'000};
       t.begin_east = {0, 0};
     },
     "wall 1: a latitude or longitude is out of range (FORMAT.md 6.4)"},
    {"Sigma", [](Table& t) { t.sigma_cm[0] = 0; }, "wall 0: the sigma is 0 (FORMAT.md 6.5)"},
};

INSTANTIATE_TEST_SUITE_P(Each, WallTableViolation, ::testing::ValuesIn(kViolations),
                         testing::name_of<Table>);

TEST(WallTable, AnotherIdentifierIsRefused) {
  EXPECT_THAT(message(bytes_of({}, "MPL1")), HasSubstr("MPW1 (FORMAT.md 6.3)"));
}

TEST(WallTable, MoreThan65536WallsAreRefused) {
  Table table;
  for (auto* array : {&table.begin_north, &table.begin_east, &table.way_north, &table.way_east}) {
    array->assign(65537, 1);
  }
  table.sigma_cm.assign(65537, 1);
  EXPECT_THAT(message(bytes_of(table)), HasSubstr("more than 65536 walls (FORMAT.md 6.4)"));
}

TEST(WallTable, TruncatedAndDamagedOnesDoNoHarm) {
  testing::expect_truncations_refused(bytes_of({}), walls_from_table);
  testing::expect_damage_harmless(bytes_of({}), walls_from_table, table_from_walls);
}

// North-east of kCell's south-west corner, in thousandths of a degree; the border is at 5.
Wall wall(double north, double east, double end_north, double end_east) {
  return {
      {49 + north / 1000, 8.4 + east / 1000}, {49 + end_north / 1000, 8.4 + end_east / 1000}, 0.25};
}

TEST(Walls, LieWholeInEveryCellThatTheyMeet) {
  const Wall inside = wall(1, 1, 1, 2);
  const Wall across = wall(4.9, 4.9, 5.1, 5.1);
  const std::vector<WallTile> tiles = tiles_of({across, inside, inside});
  ASSERT_EQ(tiles.size(), 4U);
  EXPECT_EQ(tiles[0].cell, kCell);
  EXPECT_EQ(tiles[1].cell, kCell + 1);
  EXPECT_EQ(tiles[2].cell, kCell + kCellColumns);
  EXPECT_EQ(tiles[3].cell, kCell + kCellColumns + 1);
  EXPECT_THAT(tiles[0].walls, ElementsAre(quantized(inside), quantized(across)));
  for (int i = 1; i < 4; ++i) EXPECT_THAT(tiles[i].walls, ElementsAre(quantized(across)));
}

TEST(Walls, WithoutLengthAreInNoTile) {
  const Wall shorter_than_a_step{{49.001, 8.401}, {49.001000001, 8.401000001}, 0.25};
  EXPECT_TRUE(tiles_of({wall(1, 1, 1, 1), shorter_than_a_step}).empty());
}

TEST(Walls, ComeOutOfTheirTilesOnceEach) {
  const std::vector<Wall> walls = {wall(4.98765432, 4.9, 5.1, 5.1), wall(0.3, 0.1, 7.2, 0.4)};
  std::vector<WallTile> decoded;
  for (const WallTile& tile : tiles_of(walls)) {
    const auto again = decode_walls(encode_walls(tile));
    ASSERT_TRUE(again.ok()) << again.error().line();
    decoded.push_back(*again);
  }
  EXPECT_THAT(walls_of(decoded), ElementsAre(quantized(walls[1]), quantized(walls[0])));
}

TEST(Walls, KeepTheirEndsToAMillimetreAndTheirSigmaToACentimetre) {
  const Wall exact{{-33.868812345678, -151.209398765432}, {-33.8687, -151.2093}, 0.237};
  const Wall kept = quantized(exact);
  EXPECT_NEAR(kept.begin.latitude_deg, exact.begin.latitude_deg, 0.51e-8);
  EXPECT_NEAR(kept.begin.longitude_deg, exact.begin.longitude_deg, 0.51e-8);
  EXPECT_NEAR(kept.end.latitude_deg, exact.end.latitude_deg, 0.51e-8);
  EXPECT_NEAR(kept.end.longitude_deg, exact.end.longitude_deg, 0.51e-8);
  EXPECT_DOUBLE_EQ(kept.sigma_m, 0.24);
  EXPECT_EQ(quantized(kept), kept);
  Wall surely = exact;
  surely.sigma_m = 0;
  EXPECT_DOUBLE_EQ(quantized(surely).sigma_m, 0.01);
}

}  // namespace
}  // namespace milepost
