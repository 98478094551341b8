// Following by whole frames on a straight road whose images turn slowly from one to the next.
#include <gtest/gtest.h>

#include <cmath>

#include "client/evaluate/baselines/methods.h"
#include "client/localize/follower.h"
#include "tests/client/fetch/held_segment.h"

namespace milepost {
namespace {

constexpr double kSpacingM = 2;
constexpr double kLengthM = 200;
constexpr GeoPoint kStart = {49.0, 8.4, 110};

ImageDescriptor image_from(double along_m) {
  ImageDescriptor image{};
  image[0] = static_cast<float>(std::cos(along_m / 30));
  image[1] = static_cast<float>(std::sin(along_m / 30));
  return image;
}

struct Road {
  std::shared_ptr<const SegmentLayer> layer;
  HeldMap held;
};

Road straight_road(LayerItems items = LayerItems::frames) {
  FrameTile tile{"road", 0, {}};
  for (double along_m = 0; along_m <= kLengthM; along_m += kSpacingM) {
    tile.frames.push_back({along_m, {}, image_from(along_m)});
  }
  GeoPoint end = kStart;
  end.latitude_deg += kLengthM / 111229;  // metres in a degree of latitude there
  LayerParameters parameters;
  parameters.items = items;
  parameters.focal_x_px = 400;
  parameters.focal_y_px = 400;
  const std::vector<testing::IndexedTile> tiles = {{{0, kLengthM}, tile}};
  Road road;
  road.layer = testing::layer_of({{"map", "build"}, "road"},
                                 *RouteLine::from_vertices({kStart, end}), parameters, tiles);
  road.held = testing::held_map(road.layer, tiles);
  return road;
}

class WarpFollowing : public ::testing::Test {
 protected:
  WarpFollowing() {
    auto made = method_named("wisurf")->make_scout(*road_.layer, {600, 400, 400, 400}, {});
    scout_ = std::move(*made);
  }

  // A frame taken at `along_m`, until the next one.
  SeenFrame& frame(double along_m) {
    image_ = image_from(along_m);
    time_s_ += 0.2;
    frame_ = {time_s_, {}, [this]() -> const ImageDescriptor& { return image_; }};
    return seen_.emplace(frame_, road_.held);
  }

  void start_at(double along_m) {
    Looked seen =
        scout_->look(frame(along_m), AlongRange{along_m - 20, along_m + 20}, std::nullopt);
    ASSERT_EQ(seen.sightings.size(), 1U);
    follower_ = std::move(seen.sightings.front().follower);
  }

  Road road_ = straight_road();
  ImageDescriptor image_{};
  double time_s_ = 10;
  QueryFrame frame_;
  std::optional<SeenFrame> seen_;
  std::unique_ptr<Scout> scout_;
  std::unique_ptr<Follower> follower_;
};

TEST_F(WarpFollowing, TakesTheNearestFrameOfTheMap) {
  start_at(31.3);
  double along_m = 31.3;
  for (const double step_m : {1.7, 2.9, 0.0, 0.0, 3.3, 7.0, 7.0, 2.0, 1.1}) {
    along_m += step_m;
    EXPECT_TRUE(follower_->follow(frame(along_m)).measured);
    EXPECT_NEAR(follower_->position().along_m, along_m, kSpacingM / 2 + 1e-6);
    EXPECT_GE(follower_->position().sigma_m, kSpacingM / std::sqrt(12.0) - 1e-6);
  }
  EXPECT_LT(follower_->position().sigma_m, 3 * kSpacingM);
}

// The images are those of 2 m farther with each frame, but the road ends.
TEST_F(WarpFollowing, StaysAtTheEndOfTheRoad) {
  start_at(194);
  for (double along_m = 196; along_m < 206; along_m += 2) {
    (void)follower_->follow(frame(along_m));
  }
  EXPECT_EQ(follower_->position().along_m, kLengthM);
}

TEST_F(WarpFollowing, NothingIsFoundWhereTheMapHasNoFrames) {
  EXPECT_TRUE(scout_->look(frame(50), AlongRange{300, 340}, std::nullopt).sightings.empty());
}

TEST(MakeScout, RefusesALayerOfOtherItems) {
  const Road road = straight_road(LayerItems::tracklets);
  const auto made = method_named("wisurf")->make_scout(*road.layer, {600, 400, 400, 400}, {});
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::corrupt);
  EXPECT_NE(made.error().line().find("layer 'layer': the method cannot use its tracklets"),
            std::string::npos)
      << made.error().line();
}

}  // namespace
}  // namespace milepost
