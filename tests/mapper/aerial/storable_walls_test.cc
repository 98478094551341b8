#include "mapper/aerial/storable_walls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "schema/geo/geodesy.h"
#include "schema/tile/table.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<Wall> storable(const std::vector<Wall>& walls) {
  Result<std::vector<Wall>> pieces = storable_walls(walls);
  EXPECT_TRUE(pieces.ok());
  return pieces.ok() ? *pieces : std::vector<Wall>();
}

double length_m(const Wall& wall) {
  return geodesic_distance_m({wall.begin.latitude_deg, wall.begin.longitude_deg, 0},
                             {wall.end.latitude_deg, wall.end.longitude_deg, 0});
}

double length_m(const std::vector<Wall>& walls) {
  double sum_m = 0;
  for (const Wall& wall : walls) sum_m += length_m(wall);
  return sum_m;
}

TEST(StorableWalls, OrdinaryOnesKeepTheirEnds) {
  const std::vector<Wall> walls = {{{49, 8.4}, {49.0001, 8.4001}, 0.5},
                                   {{49, 8.41}, {49.0001, 8.41}, 0.4}};
  EXPECT_EQ(storable({walls[1], walls[0], walls[1]}), walls);
}

TEST(StorableWalls, ThoseAcross180AreCutThere) {
  const Wall eastward{{-16.5, 179.9999}, {-16.4999, -179.9997}, 0.5};
  const std::vector<Wall> pieces = storable({eastward});
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_EQ(pieces[0].begin, eastward.begin);
  EXPECT_EQ(pieces[0].end.longitude_deg, 180);
  EXPECT_NEAR(pieces[0].end.latitude_deg, -16.499975, 1e-7);
  EXPECT_EQ(pieces[1].begin.longitude_deg, -180);
  EXPECT_EQ(pieces[1].begin.latitude_deg, pieces[0].end.latitude_deg);
  EXPECT_EQ(pieces[1].end, eastward.end);
  const std::vector<Wall> back = storable({{eastward.end, eastward.begin, 0.5}});
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0].begin.longitude_deg, 180);
  EXPECT_EQ(back[1].end.longitude_deg, -180);
}

TEST(StorableWalls, OneThatEndsOn180StaysWhole) {
  const Wall until{{10, 179.9999}, {10.0001, -180}, 0.5};
  EXPECT_THAT(storable({until}), ElementsAre(Wall{until.begin, {10.0001, 180}, 0.5}));
  const Wall from{{10, 180}, {10.0001, -179.9999}, 0.5};
  EXPECT_THAT(storable({from}), ElementsAre(Wall{{10, -180}, from.end, 0.5}));
  const Wall along{{10, 180}, {10.0001, -180}, 0.5};
  EXPECT_THAT(storable({along}), ElementsAre(Wall{{10, 180}, {10.0001, 180}, 0.5}));
}

TEST(StorableWalls, NearAPoleTheyAreCutIntoPieces) {
  const Wall wall{{-89.999, 20}, {-89.9991, 35}, 0.5};
  const std::vector<Wall> pieces = storable({wall});
  EXPECT_GT(pieces.size(), 100U);
  EXPECT_NEAR(length_m(pieces), length_m(wall), 0.01);
  for (const Wall& piece : pieces) {
    EXPECT_LE(std::abs(piece.end.longitude_deg - piece.begin.longitude_deg), 0.1);
    EXPECT_LT(std::abs(length_m({wall.begin, piece.begin, 0}) +
                       length_m({piece.begin, wall.end, 0}) - length_m(wall)),
              0.01);
  }
}

TEST(StorableWalls, OverAPoleOnlyTheMetreAboutItIsLost) {
  for (const double past_m : {0.0, 1e-9, 3e-6}) {
    const Wall wall{{89.9999, 10}, {89.9999, -170 + past_m}, 0.5};
    EXPECT_NEAR(length_m(storable({wall})), length_m(wall), 2) << past_m;
  }
}

TEST(StorableWalls, ThoseWithoutLengthAreLeftOut) {
  EXPECT_THAT(storable({{{49, 8}, {49, 8}, 0.5},
                        {{49, 8}, {49.000000001, 8.000000001}, 0.5},
                        {{49, 180}, {49, -180}, 0.5},
                        {{90, 0}, {90, 120}, 0.5}}),
              IsEmpty());
}

TEST(StorableWalls, EndsThatAreNoPlacesAreRefused) {
  for (const WallEnd& end :
       {WallEnd{std::numeric_limits<double>::quiet_NaN(), 8}, WallEnd{91, 8}, WallEnd{49, 180.5}}) {
    const Result<std::vector<Wall>> walls = storable_walls({{{49, 8}, end, 0.5}});
    ASSERT_FALSE(walls.ok());
    EXPECT_THAT(walls.error().line(), HasSubstr("not a position on the Earth"));
  }
}

TEST(StorableWalls, TheNumberOfPiecesIsBounded) {
  const std::vector<Wall> walls(1000, {{89.999, 10}, {89.999, -171}, 0.5});
  const Result<std::vector<Wall>> pieces = storable_walls(walls);
  ASSERT_FALSE(pieces.ok());
  EXPECT_THAT(pieces.error().line(), HasSubstr("more than a million pieces"));
}

// All that is written can be read: walls of up to 300 m all over the Earth, most of them near a
// pole or longitude 180, and steps that round to just above 0.1 degrees.
TEST(StorableWalls, OurReadersTakeThemAll) {
  std::mt19937 random(5);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  std::vector<Wall> walls = {{{0, -0.5e-8}, {0, 0.1 - 0.5e-8}, 0.5}};
  for (int i = 0; i < 300; ++i) {
    const double to_pole_deg = std::pow(10, uniform(-5, 2));
    const double latitude_deg = (i % 2 == 0 ? 1 : -1) * std::max(0.0, 90 - to_pole_deg);
    const GeoPoint begin{
        latitude_deg,
        i % 3 == 0 ? uniform(-180, 180) : std::remainder(180 + uniform(-1e-3, 1e-3), 360.0), 0};
    const GeoPoint end =
        LocalFrame(begin).geo_from_enu({uniform(-300, 300), uniform(-300, 300), 0});
    walls.push_back(
        {{begin.latitude_deg, begin.longitude_deg}, {end.latitude_deg, end.longitude_deg}, 0.5});
  }
  for (const WallTile& tile : tiles_of(storable(walls))) {
    const Result<WallTile> again = walls_from_table(table_from_walls(tile));
    ASSERT_TRUE(again.ok()) << again.error().line();
    EXPECT_EQ(again->walls, tile.walls);
  }
}

}  // namespace
}  // namespace milepost
