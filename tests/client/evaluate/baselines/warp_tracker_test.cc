// Tracking by whole frames on a straight road whose images change slowly from one to the next.
#include <gtest/gtest.h>

#include <cmath>

#include "client/evaluate/baselines/methods.h"
#include "client/localize/segment_tracker.h"
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
  ImageDescriptorTile tile{"road", 0, {}};
  for (double along_m = 0; along_m <= kLengthM; along_m += kSpacingM) {
    tile.frames.push_back({along_m, {}, image_from(along_m)});
  }
  GeoPoint end = kStart;
  end.latitude_deg += kLengthM / 111229;  // metres per degree of latitude there
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

class WarpTracking : public ::testing::Test {
 protected:
  WarpTracking() {
    auto made = method_named("wisurf")->make_relocalizer(road_.layer, {600, 400, 400, 400}, {});
    scout_ = std::move(*made);
  }

  // A frame taken at `along_m`, until the next one.
  SharedFrame& frame(double along_m) {
    image_ = image_from(along_m);
    time_s_ += 0.2;
    frame_ = {time_s_, {}, [this]() -> const ImageDescriptor& { return image_; }};
    return seen_.emplace(frame_, road_.held);
  }

  void start_at(double along_m) {
    Relocalization seen =
        scout_->relocalize(frame(along_m), AlongRange{along_m - 20, along_m + 20}, std::nullopt);
    ASSERT_EQ(seen.candidates.size(), 1U);
    tracker_ = std::move(seen.candidates.front().tracker);
  }

  Road road_ = straight_road();
  ImageDescriptor image_{};
  double time_s_ = 10;
  QueryFrame frame_;
  std::optional<SharedFrame> seen_;
  std::unique_ptr<Relocalizer> scout_;
  std::unique_ptr<SegmentTracker> tracker_;
};

TEST_F(WarpTracking, TakesTheNearestFrameOfTheMap) {
  start_at(31.3);
  double along_m = 31.3;
  for (const double step_m : {1.7, 2.9, 0.0, 0.0, 3.3, 7.0, 7.0, 2.0, 1.1}) {
    along_m += step_m;
    EXPECT_TRUE(tracker_->track(frame(along_m)).measured);
    EXPECT_NEAR(tracker_->pose().along_m, along_m, kSpacingM / 2 + 1e-6);
    EXPECT_GE(tracker_->pose().sigma_m, kSpacingM / std::sqrt(12.0) - 1e-6);
  }
  EXPECT_LT(tracker_->pose().sigma_m, 3 * kSpacingM);
}

// The images move on by 2 m per frame, but the road ends.
TEST_F(WarpTracking, StaysAtTheEndOfTheRoad) {
  start_at(194);
  for (double along_m = 196; along_m < 206; along_m += 2) {
    (void)tracker_->track(frame(along_m));
  }
  EXPECT_EQ(tracker_->pose().along_m, kLengthM);
}

TEST_F(WarpTracking, NothingIsFoundWhereTheMapHasNoFrames) {
  EXPECT_TRUE(scout_->relocalize(frame(50), AlongRange{300, 340}, std::nullopt).candidates.empty());
}

TEST(MakeRelocalizer, RefusesALayerOfOtherItems) {
  const Road road = straight_road(LayerItems::tracklets);
  const auto made = method_named("wisurf")->make_relocalizer(road.layer, {600, 400, 400, 400}, {});
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::corrupt);
  EXPECT_NE(made.error().line().find("layer 'layer': the method cannot use its tracklets"),
            std::string::npos)
      << made.error().line();
}

}  // namespace
}  // namespace milepost
