#include "client/fetch/held_map.h"

#include <gtest/gtest.h>

#include "tests/client/fetch/held_segment.h"

namespace milepost {
namespace {

const MapVersion kHeldTown = {"town", "build"};

RouteLine line_at(double east_m) {
  const LocalFrame frame({49, 8.4, 0});
  return *RouteLine::from_vertices(
      {frame.geo_from_enu({east_m, 0, 0}), frame.geo_from_enu({east_m, 200, 0})});
}

GeoPoint at(double east_m, double north_m) {
  return LocalFrame({49, 8.4, 0}).geo_from_enu({east_m, north_m, 0});
}

// The road "a" at 0 m east and "b" at 30 m, as listed around a position 10 m east and 50 m north.
HeldMap two_roads() {
  HeldMap held = testing::held_map(testing::layer_of({kHeldTown, "a"}, line_at(0), {}, {}), {});
  held.segments.merge(
      testing::held_map(testing::layer_of({kHeldTown, "b"}, line_at(30), {}, {}), {}).segments);
  held.around = {{kHeldTown, "a", 50, 10, 200}, {kHeldTown, "b", 50, 20, 200}};
  held.known_around = {at(10, 50), 100};
  return held;
}

TEST(HeldMap, FindsSegmentsNearByTheirLines) {
  const auto near = two_roads().segments_near({at(25, 80), 40});
  ASSERT_TRUE(near);
  ASSERT_EQ(near->size(), 2U);
  EXPECT_EQ(near->front().segment, "b");
  EXPECT_NEAR(near->front().along_m, 80, 0.01);
  EXPECT_NEAR(near->front().distance_m, 5, 0.01);
  EXPECT_NEAR(near->back().distance_m, 25, 0.01);
}

TEST(HeldMap, LeavesOutWhatIsFartherThanAsked) {
  const auto near = two_roads().segments_near({at(25, 80), 10});
  ASSERT_TRUE(near);
  ASSERT_EQ(near->size(), 1U);
  EXPECT_EQ(near->front().segment, "b");
}

TEST(HeldMap, DoesNotKnowWhatLiesBeyondItsSurroundings) {
  EXPECT_TRUE(two_roads().segments_near({at(10, 100), 50}));
  EXPECT_FALSE(two_roads().segments_near({at(10, 100), 51}));
  EXPECT_FALSE(HeldMap().segments_near({at(10, 100), 1}));
}

// 34 m from where it was listed at 20 m: at least 14 m away.
TEST(HeldMap, OfASegmentWithoutItsLineKnowsHowNearItMayBe) {
  HeldMap held = two_roads();
  held.segments[{kHeldTown, "b"}] = std::make_shared<const HeldSegment>();
  const auto near = held.segments_near({at(25, 80), 40});
  ASSERT_TRUE(near);
  ASSERT_EQ(near->size(), 2U);
  EXPECT_EQ(near->front().segment, "b");
  EXPECT_NEAR(near->front().distance_m, 13.5, 0.1);
}

TEST(DecodeTileOf, RefusesWhatIsNoTile) {
  const Bytes bytes(20, 7);
  for (const LayerItems items : {LayerItems::landmarks, LayerItems::observations,
                                 LayerItems::frames, LayerItems::tracklets}) {
    const auto tile = decode_tile_of(items, bytes);
    ASSERT_FALSE(tile.ok());
    EXPECT_EQ(tile.error().code, ErrorCode::corrupt);
  }
}

}  // namespace
}  // namespace milepost
