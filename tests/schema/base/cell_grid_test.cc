#include "schema/base/cell_grid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace milepost {
namespace {

TEST(CellGrid, ACellIsNumberedByRowAndColumn) {
  const GridCell cell = GridCell::at(49.0012, 8.4031);
  EXPECT_EQ(cell.row, 27800U);
  EXPECT_EQ(cell.column, 37680U);
  EXPECT_EQ(cell.number(), 27800U * 72000U + 37680U);
  const GridCell again = GridCell::numbered(cell.number());
  EXPECT_EQ(again.row, cell.row);
  EXPECT_EQ(again.column, cell.column);
}

TEST(CellGrid, ItsBoundsHoldWhatIsInIt) {
  const Bounds bounds = GridCell::at(-33.8688, -151.2093).bounds();
  EXPECT_DOUBLE_EQ(bounds.south_deg, -33.87);
  EXPECT_DOUBLE_EQ(bounds.north_deg, -33.865);
  EXPECT_DOUBLE_EQ(bounds.west_deg, -151.21);
  EXPECT_DOUBLE_EQ(bounds.east_deg, -151.205);
}

TEST(CellGrid, ABorderBelongsToTheCellNorthOrEastOfIt) {
  for (std::uint32_t i = 0; i < kCellRows; ++i) {
    const GridCell cell{i, i};
    const Bounds bounds = cell.bounds();
    ASSERT_EQ(GridCell::at(bounds.south_deg, bounds.west_deg).number(), cell.number());
  }
  EXPECT_EQ(GridCell::at(49.105, 8.5).bounds().south_deg, 49.105);
}

TEST(CellGrid, TheEndsOfTheWorldBelongToTheLastCells) {
  EXPECT_EQ(GridCell::at(-90, -180).number(), 0U);
  EXPECT_EQ(GridCell::at(90, 180).number(), kCellRows * kCellColumns - 1);
  EXPECT_TRUE(is_cell(kCellRows * kCellColumns - 1));
  EXPECT_FALSE(is_cell(kCellRows * kCellColumns));
}

TEST(CellGrid, BoxesMeetAtTheirBorders) {
  const Bounds box{8, 49, 9, 50};
  EXPECT_TRUE(box.meets({9, 50, 10, 51}));
  EXPECT_TRUE(box.meets({8.4, 49.4, 8.5, 49.5}));
  EXPECT_FALSE(box.meets({9.001, 49, 10, 50}));
  EXPECT_FALSE(box.meets({8, 50.001, 9, 51}));
  const Bounds both = box.joined({7, 49.5, 8.5, 51});
  EXPECT_EQ(both.west_deg, 7);
  EXPECT_EQ(both.south_deg, 49);
  EXPECT_EQ(both.east_deg, 9);
  EXPECT_EQ(both.north_deg, 51);
}

TEST(CellGrid, BoxesMeetAcrossLongitude180) {
  const Bounds across{179, 0, -179, 1};
  EXPECT_TRUE(across.crosses_180());
  for (const Bounds& other : {Bounds{178, 0, 179, 1}, Bounds{-179, 0, -178, 1},
                              Bounds{-180, 0, 180, 1}, Bounds{179.5, 1, 179.6, 2}, across}) {
    EXPECT_TRUE(across.meets(other)) << other.west_deg;
    EXPECT_TRUE(other.meets(across)) << other.west_deg;
  }
  for (const Bounds& other :
       {Bounds{-178.9, 0, 178.9, 1}, Bounds{179.5, 1.1, 179.6, 2}, Bounds{179, -1, -179, -0.1}}) {
    EXPECT_FALSE(across.meets(other)) << other.west_deg;
    EXPECT_FALSE(other.meets(across)) << other.west_deg;
  }
  EXPECT_FALSE((Bounds{179, 0, 180, 1}.meets({-180, 0, -179, 1})));
}

TEST(CellGrid, ABoxIsOfDegreesOnTheEarth) {
  const double nan = std::nan("");
  EXPECT_TRUE((Bounds{-180, -90, 180, 90}.is_valid()));
  EXPECT_TRUE((Bounds{179, 1, -179, 1}.is_valid()));
  EXPECT_FALSE((Bounds{8, 50, 9, 49}.is_valid()));
  EXPECT_FALSE((Bounds{-180.1, 49, 9, 50}.is_valid()));
  EXPECT_FALSE((Bounds{8, 49, 180.1, 50}.is_valid()));
  EXPECT_FALSE((Bounds{8, -90.1, 9, 50}.is_valid()));
  EXPECT_FALSE((Bounds{8, 49, 9, 90.1}.is_valid()));
  for (const Bounds& box : {Bounds{nan, 49, 9, 50}, Bounds{8, nan, 9, 50}, Bounds{8, 49, nan, 50},
                            Bounds{8, 49, 9, nan}}) {
    EXPECT_FALSE(box.is_valid());
  }
}

}  // namespace
}  // namespace milepost
