#include "client/localize/landmark_window.h"

#include <gtest/gtest.h>

#include "tests/client/fetch/held_segment.h"

namespace milepost {
namespace {

constexpr GeoPoint kWindowStart = {49, 8.4, 110};
constexpr double kHalfStepM = 0.006;  // of the tiles' positions, and what the ellipsoid adds

void expect_near(const Eigen::Vector3d& enu_m, const EnuPoint& expected) {
  EXPECT_NEAR(enu_m.x(), expected.east_m, kHalfStepM);
  EXPECT_NEAR(enu_m.y(), expected.north_m, kHalfStepM);
  EXPECT_NEAR(enu_m.z(), expected.up_m, kHalfStepM);
}

// 400 m to the north-east, uphill.
RouteLine hill() {
  const LocalFrame frame(kWindowStart);
  return *RouteLine::from_vertices(
      {frame.geo_from_enu({0, 0, 0}), frame.geo_from_enu({240, 320, 20})});
}

class LandmarksOnAHill : public ::testing::Test {
 protected:
  // A tile whose origin is `origin_m`, with one landmark at a point of the frame at the start.
  DecodedTile tile(std::uint32_t index, double origin_m, const EnuPoint& from_start) const {
    Landmark landmark;
    landmark.descriptor[0] = static_cast<std::int8_t>(index);
    landmark.position = LocalFrame(line_.point_at(origin_m))
                            .enu_from_geo(LocalFrame(kWindowStart).geo_from_enu(from_start));
    landmark.depth_sigma_m = 0.5F;
    landmark.size_m = 0.25F;
    landmark.size_sigma = 0.1F;
    landmark.along = {origin_m, origin_m + 20};
    landmark.observations = 5;
    return LandmarkTile{"hill", index, origin_m, {landmark}};
  }

  // The held map.
  LandmarkWindow window(const std::vector<testing::IndexedTile>& tiles) {
    held_ = testing::held_map(testing::layer_of(kHill, line_, {}, tiles), tiles);
    layer_ = held_.segments.at(kHill)->layer;
    return {{5, 5}, line_.point_at(0)};
  }

  // The hill is the only segment.
  Covered cover(LandmarkWindow& window, const AlongRange& range) {
    return window.cover(held_, {{layer_}}, range);
  }

  inline static const SegmentKey kHill = {{"town", "build"}, "hill"};
  RouteLine line_ = hill();
  std::shared_ptr<const SegmentLayer> layer_;
  HeldMap held_;
};

TEST_F(LandmarksOnAHill, PlacesOfTwoTilesAgreeInOneFrame) {
  const EnuPoint corner = {100, 130, 12};  // mapped twice
  auto window = this->window({{{40, 60}, tile(2, 40, corner)}, {{60, 80}, tile(3, 60, corner)}});
  ASSERT_TRUE(cover(window, {50, 70}).complete);
  ASSERT_EQ(window.landmarks().size(), 2U);
  for (const LocalLandmark& landmark : window.landmarks()) expect_near(landmark.enu_m, corner);
  const LocalLandmark& second = window.landmarks()[1];
  EXPECT_EQ(second.descriptor[0], 3);
  EXPECT_NEAR(second.depth_sigma_m, 0.5, 0.02);
  EXPECT_NEAR(second.size_m, 0.25, 0.01);
  EXPECT_NEAR(second.size_sigma, 0.1, 0.004);
  EXPECT_EQ(second.along.from_m, 60);
  EXPECT_EQ(second.along.to_m, 80);
}

// From the line in the middle of the mapped range: 70 m of 400.
TEST_F(LandmarksOnAHill, RaysLeadFromWhereItWasMapped) {
  auto window = this->window({{{60, 80}, tile(3, 60, {42 + 16, 56 - 12, 3.5})}});
  ASSERT_TRUE(cover(window, {60, 70}).complete);
  const Eigen::Vector3d& ray = window.landmarks().at(0).mapping_ray;
  EXPECT_NEAR(ray.x(), 0.8, 1e-3);  // 20 m to the right
  EXPECT_NEAR(ray.y(), -0.6, 1e-3);
  EXPECT_NEAR(ray.z(), 0, 1e-3);
}

TEST_F(LandmarksOnAHill, RaysOfAnotherLaneLeadFromThere) {
  DecodedTile beside = tile(3, 60, {42 + 16, 56 - 12, 3.5});
  std::get<LandmarkTile>(beside).landmarks[0].right_m = 10;  // halfway
  auto window = this->window({{{60, 80}, beside}});
  ASSERT_TRUE(cover(window, {60, 70}).complete);
  const LocalLandmark& landmark = window.landmarks().at(0);
  const Eigen::Vector3d from = landmark.enu_m - 10 * landmark.mapping_ray;
  expect_near(from, {42 + 8, 56 - 6, 3.5});
  EXPECT_NEAR(landmark.mapped_ahead_m, 0, 0.01);
}

TEST_F(LandmarksOnAHill, ANewOriginMovesThem) {
  const EnuPoint corner = {100, 130, 12};
  auto window = this->window({{{40, 60}, tile(2, 40, corner)}});
  ASSERT_TRUE(cover(window, {50, 55}).complete);
  window.set_origin(LocalFrame(kWindowStart).geo_from_enu({60, 80, 5}));
  ASSERT_EQ(window.landmarks().size(), 1U);
  expect_near(window.landmarks()[0].enu_m + Eigen::Vector3d(60, 80, 5), corner);
  EXPECT_NEAR(window.frame().enu_from_geo(kWindowStart).north_m, -80, 1e-2);
}

TEST_F(LandmarksOnAHill, DiscardsWhatLiesBehind) {
  auto window = this->window({{{40, 60}, tile(2, 40, {})}, {{100, 120}, tile(5, 100, {})}});
  ASSERT_TRUE(cover(window, {50, 55}).complete);
  ASSERT_TRUE(cover(window, {90, 105}).complete);
  ASSERT_EQ(window.landmarks().size(), 1U);
  EXPECT_EQ(window.landmarks()[0].descriptor[0], 5);
}

TEST_F(LandmarksOnAHill, UsesWhatIsHeldWhereATileIsMissing) {
  const EnuPoint corner = {100, 130, 12};
  const Error refused = {ErrorCode::unavailable, "tile 1", "was refused", ""};
  auto window = this->window({{{40, 60}, tile(2, 40, corner)}, {{70, 90}, std::nullopt, refused}});
  const Covered covered = cover(window, {50, 75});
  EXPECT_FALSE(covered.complete);
  ASSERT_TRUE(covered.failure);
  EXPECT_EQ(covered.failure->where, "tile 1");
  ASSERT_EQ(window.landmarks().size(), 1U);
  expect_near(window.landmarks()[0].enu_m, corner);
  EXPECT_TRUE(cover(window, {50, 60}).complete);  // nothing is missing there
}

TEST_F(LandmarksOnAHill, TakesATileWhenItArrives) {
  auto window = this->window({{{40, 60}, tile(0, 40, {})}, {{60, 80}, std::nullopt}});
  const Covered before = cover(window, {50, 70});
  EXPECT_FALSE(before.complete);
  EXPECT_FALSE(before.failure);  // it may still arrive
  this->window({{{40, 60}, tile(0, 40, {})}, {{60, 80}, tile(1, 60, {})}});
  EXPECT_TRUE(cover(window, {50, 70}).changed);
  EXPECT_EQ(window.landmarks().size(), 2U);
  held_ = {};
  EXPECT_TRUE(cover(window, {52, 68}).complete);  // loaded tiles stay
  EXPECT_EQ(window.landmarks().size(), 2U);
}

// Two segments, the second of which continues the first: its arc length begins at 400 m.
TEST_F(LandmarksOnAHill, TakesWhatLiesAheadAndBehindOnTheUnrolledRoad) {
  const EnuPoint corner = {100, 130, 12};
  auto window = this->window({{{40, 60}, tile(2, 40, corner)}});
  const SegmentKey next = {{"town", "build"}, "next"};
  const std::vector<testing::IndexedTile> tiles = {{{40, 60}, tile(3, 40, corner)},
                                                   {{40, 60}, tile(2, 40, corner)}};
  const HeldMap beyond = testing::held_map(testing::layer_of(next, line_, {}, tiles), tiles);
  held_.segments[next] = beyond.segments.at(next);
  const auto layer = held_.segments.at(next)->layer;
  const std::vector<UnrolledSegment> road = {{layer_}, {layer, 10, RoadSide::ahead, 1, false}};
  ASSERT_TRUE(window.cover(held_, road, {50, 70}).complete);
  ASSERT_EQ(window.landmarks().size(), 2U);  // the same track of both segments is taken once
  EXPECT_TRUE(window.landmarks()[0].is_of_this_way);
  EXPECT_FALSE(window.landmarks()[1].is_of_this_way);
  EXPECT_EQ(window.landmarks()[1].descriptor[0], 3);
  EXPECT_EQ(window.landmarks()[1].along.from_m, 50);
  EXPECT_NEAR(window.landmarks()[1].mapped_at_m, 60, 1e-9);

  ASSERT_TRUE(
      window.cover(held_, {{layer}, {layer_, -400, RoadSide::behind, 1, true}}, {50, 70}).changed);
  EXPECT_EQ(window.landmarks().size(), 2U);  // what lies behind does not reach here
}

}  // namespace
}  // namespace milepost
