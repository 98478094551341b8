#include "client/face/map_ahead.h"

#include <gtest/gtest.h>

#include "tests/client/fetch/held_segment.h"

namespace milepost::vehicle {
namespace {

const SegmentKey kRoad = {{"town", "build"}, "road"};

RouteLine line() {
  const LocalFrame frame({49, 8.4, 0});
  return *RouteLine::from_vertices(
      {frame.geo_from_enu({0, 0, 0}), frame.geo_from_enu({0, 100, 0})});
}

testing::IndexedTile tile(double from_m, double to_m) { return {{from_m, to_m}, LandmarkTile{}}; }

// A road of 100 m in five tiles; the fourth has failed and the fifth has not arrived yet.
HeldMap holed() {
  const std::vector<testing::IndexedTile> tiles = {
      tile(0, 20),
      tile(20, 40),
      tile(40, 60),
      {{60, 80},
       std::nullopt,
       milepost::Error{milepost::ErrorCode::unavailable, "tile 3", "no", ""}},
      {{80, 100}, std::nullopt}};
  return testing::held_map(testing::layer_of(kRoad, line(), {}, tiles), tiles);
}

TEST(MapAhead, SaysHowFarItIsHeldAndWhatIsMissing) {
  Wants wants;
  wants.tiles = {{kRoad, {30, 99}, 0}, {kRoad, {50, 99}, 1}};
  const MapAhead ahead = map_ahead_of(holed(), wants, OnSegment{kRoad, 25});
  EXPECT_NEAR(ahead.held_m, 35, 1e-9);
  ASSERT_EQ(ahead.missing.size(), 2U);
  EXPECT_EQ(ahead.missing[0].from_m, 60);
  ASSERT_TRUE(ahead.missing[0].why);
  EXPECT_EQ(ahead.missing[0].why->code, ErrorCode::unavailable);
  EXPECT_EQ(ahead.missing[0].why->where, "tile 3");
  EXPECT_EQ(ahead.missing[1].to_m, 100);
  EXPECT_FALSE(ahead.missing[1].why);
  EXPECT_FALSE(ahead.failure);
}

TEST(MapAhead, IsHeldToTheEndOfTheSegmentAtMost) {
  const std::vector<testing::IndexedTile> tiles = {tile(0, 130)};
  const HeldMap held = testing::held_map(testing::layer_of(kRoad, line(), {}, tiles), tiles);
  EXPECT_NEAR(map_ahead_of(held, {}, OnSegment{kRoad, 60}).held_m, 40, 0.01);
}

// The road of 100 m goes on as two branches of 60 m and 200 m, in tiles of 20 m.
HeldMap parting_road(int tiles_of_long_branch_held) {
  const LocalFrame frame({49, 8.4, 0});
  HeldMap held;
  const auto add = [&](const std::string& id, double from_m, double to_m, double bend,
                       const std::vector<std::string>& successors, int tiles_held) {
    std::vector<testing::IndexedTile> tiles;
    for (double at_m = 0; at_m < to_m - from_m; at_m += 20) tiles.push_back(tile(at_m, at_m + 20));
    SegmentLayer layer =
        *testing::layer_of({kRoad.version, id},
                           *RouteLine::from_vertices({frame.geo_from_enu({0, from_m, 0}),
                                                      frame.geo_from_enu({bend, to_m, 0})}),
                           {}, tiles);
    for (const std::string& next : successors) layer.successors.push_back({next, "town"});
    HeldSegment segment;
    segment.layer = std::make_shared<const SegmentLayer>(std::move(layer));
    for (int index = 0; index < tiles_held; ++index) {
      const auto at = static_cast<std::uint32_t>(index);
      segment.tiles[at] = std::make_shared<const DecodedTile>(LandmarkTile{});
    }
    held.segments[{kRoad.version, id}] = std::make_shared<const HeldSegment>(std::move(segment));
  };
  add("road", 0, 100, 0, {"short", "long"}, 5);
  add("short", 100, 160, 2, {}, 3);
  add("long", 100, 300, -2, {}, tiles_of_long_branch_held);
  return held;
}

TEST(MapAhead, IsHeldThroughAJunctionOnEveryBranch) {
  EXPECT_NEAR(map_ahead_of(parting_road(10), {}, OnSegment{kRoad, 60}).held_m, 240, 0.1);
  EXPECT_NEAR(map_ahead_of(parting_road(2), {}, OnSegment{kRoad, 60}).held_m, 80, 0.1);
  HeldMap unknown = parting_road(10);
  unknown.segments.erase({kRoad.version, "long"});
  EXPECT_NEAR(map_ahead_of(unknown, {}, OnSegment{kRoad, 60}).held_m, 40, 0.1);
}

// The road leads back to its begin: what lies behind the vehicle is not counted as held.
TEST(MapAhead, ALoopIsCountedOnce) {
  HeldMap held = parting_road(10);
  SegmentLayer back = *held.find({kRoad.version, "short"})->layer;
  back.successors = {{"road", "town"}};
  HeldSegment segment = *held.find({kRoad.version, "short"});
  segment.layer = std::make_shared<const SegmentLayer>(std::move(back));
  held.segments[{kRoad.version, "short"}] = std::make_shared<const HeldSegment>(std::move(segment));
  EXPECT_NEAR(map_ahead_of(held, {}, OnSegment{kRoad, 60}).held_m, 100, 0.1);
}

TEST(MapAhead, OfAPlaceThatIsNotKnownNothingIsHeld) {
  EXPECT_EQ(map_ahead_of(holed(), {}, std::nullopt).held_m, 0);
  EXPECT_EQ(map_ahead_of(HeldMap(), {}, OnSegment{kRoad, 60}).held_m, 0);
}

TEST(MapAhead, ASegmentWithoutDocumentsIsMissingAsAWhole) {
  Wants wants;
  wants.tiles = {{kRoad, {30, 99}, 0}};
  wants.around = Surroundings{{49, 8.4, 0}, 50};
  HeldMap held;
  held.around_failure = milepost::Error{milepost::ErrorCode::unavailable, "server", "is away", ""};
  const MapAhead ahead = map_ahead_of(held, wants, std::nullopt);
  ASSERT_EQ(ahead.missing.size(), 1U);
  EXPECT_EQ(ahead.missing[0].from_m, 30);
  ASSERT_TRUE(ahead.failure);
  EXPECT_EQ(ahead.failure->where, "server");
}

}  // namespace
}  // namespace milepost::vehicle
