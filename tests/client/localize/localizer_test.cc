// The localizer against the receiver, on a straight road whose images turn slowly from one to the
// next.
#include "client/localize/localizer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "client/fetch/nearby.h"
#include "schema/tile/codec.h"
#include "tests/client/localize/layer_of_tiles.h"

namespace milepost {
namespace {

constexpr double kSpacingM = 2;
constexpr double kLengthM = 400;
constexpr GeoPoint kStart = {49.0, 8.4, 110};
constexpr GeoPoint kEnd = {49.0 + kLengthM / 111229, 8.4, 110};  // metres in a degree of latitude
constexpr double kSigmaM = 5;  // of the receiver: 4 sigmas and 10 m are 30 m

ImageDescriptor image_from(double along_m) {
  ImageDescriptor image{};
  image[0] = static_cast<float>(std::cos(along_m / 100));
  image[1] = static_cast<float>(std::sin(along_m / 100));
  return image;
}

Bytes tile_of_the_road() {
  FrameTile tile{"road", 0, {}};
  for (double along_m = 0; along_m <= kLengthM; along_m += kSpacingM) {
    tile.frames.push_back({along_m, {}, image_from(along_m)});
  }
  return encode_frames(tile);
}

// A map of the one road.
class OneRoad : public testing::LayerOfTiles {
 public:
  OneRoad() : LayerOfTiles({{{0, kLengthM}, tile_of_the_road()}}) {
    add_line(kVersion, description(), lines_);
  }

  Result<std::vector<NearbySegment>> segments_near(const GeoPoint& position,
                                                   double radius_m) override {
    return lines_near(lines_, position, radius_m);
  }
  Result<MapDescription> describe(const MapVersion& version) override {
    return MapDescription{version,
                          {{"wisurf", R"({"items": "frames", "focal_px": [400, 400]})"}},
                          to_json(FeatureParameters())};
  }
  Result<SegmentDescription> segment(const MapVersion& /*version*/,
                                     const std::string& /*segment*/) override {
    return description();
  }

 private:
  static SegmentDescription description() { return {"road", kLengthM, {kStart, kEnd}, {}}; }
  inline static const MapVersion kVersion = {"map", "0123456789abcdef0123456789abcdef"};

  std::vector<KnownLine> lines_;
};

class LocalizerAndReceiver : public ::testing::Test {
 protected:
  LocalizerAndReceiver() : localizer_(std::make_shared<OneRoad>(), {600, 400, 400}, settings()) {}

  // The fix of the next frame, taken at `along_m`, with the receiver at `receiver_m` a while ago.
  Fix fix_at(double along_m, double receiver_m, double age_s = 0) {
    time_s_ += 0.2;
    localizer_.observe({time_s_ - age_s, road_->point_at(receiver_m), kSigmaM});
    image_ = image_from(along_m);
    const auto fix =
        localizer_.localize({time_s_, {}, [this]() -> const ImageDescriptor& { return image_; }});
    EXPECT_TRUE(fix.ok()) << fix.error().line();
    return *fix;
  }

 private:
  static LocalizerSettings settings() {
    LocalizerSettings settings;
    settings.method = *method_named("wisurf");
    return settings;
  }

  Result<RouteLine> road_ = RouteLine::from_vertices({kStart, kEnd});
  Localizer localizer_;
  ImageDescriptor image_{};
  double time_s_ = 10;
};

TEST_F(LocalizerAndReceiver, FollowsWhileTheyAgree) {
  fix_at(50, 60);
  for (double along_m = 52; along_m < 100; along_m += kSpacingM) {
    const Fix fix = fix_at(along_m, along_m - 29);
    EXPECT_EQ(fix.status, FixStatus::tracking);
    EXPECT_NEAR(*fix.along_m, along_m, kSpacingM);
  }
}

TEST_F(LocalizerAndReceiver, StartsAnewWhereTheReceiverContradictsForLong) {
  fix_at(50, 50);
  ASSERT_EQ(fix_at(52, 52).status, FixStatus::tracking);
  for (int frame = 0; frame < LocalizerSettings().max_predicted_frames; ++frame) {
    const Fix fix = fix_at(52, 200);  // it looks as before, but the vehicle is elsewhere
    EXPECT_EQ(fix.status, FixStatus::predicted);
    EXPECT_NEAR(*fix.along_m, 52, kSpacingM);
  }
  const Fix again = fix_at(200, 200);
  EXPECT_EQ(again.status, FixStatus::initializing);
  EXPECT_NEAR(*again.along_m, 200, kSpacingM);
}

TEST_F(LocalizerAndReceiver, OneWrongPositionOfTheReceiverChangesNothing) {
  fix_at(50, 50);
  ASSERT_EQ(fix_at(52, 52).status, FixStatus::tracking);
  EXPECT_EQ(fix_at(54, 200).status, FixStatus::predicted);
  EXPECT_EQ(fix_at(56, 56).status, FixStatus::tracking);
}

TEST_F(LocalizerAndReceiver, AnOldPositionContradictsLess) {
  fix_at(52, 52);
  EXPECT_EQ(fix_at(52, 20).status, FixStatus::predicted);  // 32 m off
  EXPECT_EQ(fix_at(52, 20, 1).status, FixStatus::tracking);
}

}  // namespace
}  // namespace milepost
