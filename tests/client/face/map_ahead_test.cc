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
