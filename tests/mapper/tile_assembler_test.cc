#include "mapper/tiles/tile_assembler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace milepost {
namespace {

Tracklet tracklet_from(double from_m, double to_m) {
  Tracklet tracklet;
  tracklet.along = {from_m, to_m};
  return tracklet;
}

TEST(TileAssembler, ATrackletLiesInTheTileWhereItBegins) {
  TileAssembler assembler("s", ScaleModel::scale, 20);
  assembler.add(tracklet_from(39.9, 80));
  assembler.add(tracklet_from(0, 25));
  assembler.add(tracklet_from(20, 30));
  const std::vector<TrackletTile> tiles = assembler.take_all();
  ASSERT_EQ(tiles.size(), 2U);
  EXPECT_EQ(tiles[0].index, 0U);
  EXPECT_EQ(tiles[0].segment, "s");
  EXPECT_EQ(tiles[0].model, ScaleModel::scale);
  EXPECT_EQ(tiles[0].tracklets.size(), 1U);
  EXPECT_EQ(tiles[1].index, 1U);
  ASSERT_EQ(tiles[1].tracklets.size(), 2U);
  EXPECT_EQ(tiles[1].tracklets[0].along.from_m, 20);  // sorted by where they begin
  EXPECT_EQ(tiles[1].along().to_m, 80);
}

TEST(TileAssembler, LetsGoOfATileOnlyOnceNothingCanBeginInIt) {
  TileAssembler assembler("s", ScaleModel::scale, 20);
  assembler.add(tracklet_from(5, 10));
  assembler.add(tracklet_from(25, 30));
  EXPECT_THAT(assembler.take_complete(19.9), testing::IsEmpty());
  EXPECT_EQ(assembler.take_complete(20).size(), 1U);
  EXPECT_THAT(assembler.take_complete(39), testing::IsEmpty());
  EXPECT_EQ(assembler.take_all().size(), 1U);
  EXPECT_THAT(assembler.take_all(), testing::IsEmpty());
}

}  // namespace
}  // namespace milepost
