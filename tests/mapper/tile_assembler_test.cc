#include "mapper/tracklets/tile_assembler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace milepost {
namespace {

constexpr double kRoadEnd = std::numeric_limits<double>::infinity();

Tracklet tracklet_from(double from_m, double to_m) {
  Tracklet tracklet;
  tracklet.along = {from_m, to_m};
  return tracklet;
}

TEST(TileAssembler, ATrackletLiesInTheTileWhereItBegins) {
  TileAssembler<Tracklet> assembler(20);
  assembler.add(tracklet_from(39.9, 80));
  assembler.add(tracklet_from(0, 25));
  assembler.add(tracklet_from(20, 30));
  const auto tiles = assembler.take_complete(kRoadEnd);
  ASSERT_EQ(tiles.size(), 2U);
  EXPECT_EQ(tiles[0].index, 0U);
  EXPECT_EQ(tiles[0].items.size(), 1U);
  EXPECT_EQ(tiles[0].along.from_m, 0);
  EXPECT_EQ(tiles[0].along.to_m, 25);
  EXPECT_EQ(tiles[1].index, 1U);
  ASSERT_EQ(tiles[1].items.size(), 2U);
  EXPECT_EQ(tiles[1].items[0].along.from_m, 20);  // sorted by begin
  EXPECT_EQ(tiles[1].along.from_m, 20);
  EXPECT_EQ(tiles[1].along.to_m, 80);
}

TEST(TileAssembler, ReleasesATileOnlyOnceNothingCanBeginInIt) {
  TileAssembler<Tracklet> assembler(20);
  assembler.add(tracklet_from(5, 10));
  assembler.add(tracklet_from(25, 30));
  EXPECT_THAT(assembler.take_complete(19.9), ::testing::IsEmpty());
  EXPECT_EQ(assembler.take_complete(20).size(), 1U);
  EXPECT_THAT(assembler.take_complete(39), ::testing::IsEmpty());
  EXPECT_EQ(assembler.take_complete(kRoadEnd).size(), 1U);
  EXPECT_THAT(assembler.take_complete(kRoadEnd), ::testing::IsEmpty());
}

}  // namespace
}  // namespace milepost
