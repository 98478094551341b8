// The localizer on straight roads whose images change slowly from one to the next: with
// contradicting GNSS fixes, without measurements, at the end of the road, and with a failing
// source.
#include "client/localize/localizer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "client/evaluate/baselines/methods.h"
#include "schema/tile/codec.h"
#include "tests/client/fetch/memory_source.h"
#include "tests/client/localize/landmark_road.h"

namespace milepost {
namespace {

constexpr double kSpacingM = 2;
constexpr double kLengthM = 400;
constexpr GeoPoint kLineStart = {49.0, 8.4, 110};
constexpr GeoPoint kEnd = {49.0 + kLengthM / 111229, 8.4, 110};  // metres in a degree of latitude
constexpr double kGnssSigmaM = 5;                                // of the receiver

ImageDescriptor image_from(double along_m) {
  ImageDescriptor image{};
  image[0] = static_cast<float>(std::cos(along_m / 100));
  image[1] = static_cast<float>(std::sin(along_m / 100));
  return image;
}

// Resembles no position on the road.
ImageDescriptor image_beside(double along_m) {
  ImageDescriptor image{};
  image[2] = static_cast<float>(std::cos(along_m / 100));
  image[3] = static_cast<float>(std::sin(along_m / 100));
  return image;
}

// Of the two branches beyond a junction.
template <int kFirst>
ImageDescriptor image_of_branch(double along_m) {
  ImageDescriptor image{};
  image[kFirst] = static_cast<float>(std::cos(along_m / 100));
  image[kFirst + 1] = static_cast<float>(std::sin(along_m / 100));
  return image;
}

// Frames a little beyond the end of the line, in tiles of 50 m.
std::vector<testing::MemorySource::Tile> tiles_of_a_road(ImageDescriptor (*image_of)(double)) {
  constexpr double kTileM = 50;
  std::vector<testing::MemorySource::Tile> tiles;
  for (double from_m = 0; from_m <= kLengthM; from_m += kTileM) {
    ImageDescriptorTile tile{"road", static_cast<std::uint32_t>(tiles.size()), {}};
    for (double along_m = from_m; along_m < from_m + kTileM; along_m += kSpacingM) {
      tile.frames.push_back({along_m, {}, image_of(along_m)});
    }
    tiles.push_back({{from_m, from_m + kTileM - kSpacingM}, encode_frames(tile)});
  }
  return tiles;
}

std::string build_of_map(char digit) { return std::string(32, digit); }

SegmentDescription straight(const std::string& segment) {
  return {segment, kLengthM, {kLineStart, kEnd}, {}};
}

std::shared_ptr<testing::MemorySource> one_road() {
  auto map = std::make_shared<testing::MemorySource>(
      MapVersion{"map", build_of_map('1')}, "wisurf",
      nlohmann::json{{"items", "frames"}, {"focal_px", {400, 400}}});
  map->add(straight("road"), tiles_of_a_road(image_from));
  return map;
}

// The road parts into two others at its end.
std::shared_ptr<testing::MemorySource> a_junction() {
  const auto branch = [](const char* id, double to_longitude_deg) {
    const GeoPoint to = {kEnd.latitude_deg + kLengthM / 111229, to_longitude_deg, 110};
    const std::vector<GeoPoint> vertices = {kEnd, to};
    return SegmentDescription{id, RouteLine::from_vertices(vertices)->length_m(), vertices, {}};
  };
  auto map = std::make_shared<testing::MemorySource>(
      MapVersion{"map", build_of_map('1')}, "wisurf",
      nlohmann::json{{"items", "frames"}, {"focal_px", {400, 400}}});
  SegmentDescription road = straight("road");
  road.successors = {{"left", "map"}, {"right", "map"}};
  map->add(road, tiles_of_a_road(image_from));
  map->add(branch("left", kEnd.longitude_deg - 0.001), tiles_of_a_road(image_of_branch<4>));
  map->add(branch("right", kEnd.longitude_deg + 0.001), tiles_of_a_road(image_of_branch<6>));
  return map;
}

class LocalizerAndReceiver : public ::testing::Test {
 protected:
  // The fix of the next frame, taken at `along_m`, with a GNSS fix at `receiver_m` from `age_s`
  // ago.
  Fix fix_at(double along_m, double receiver_m, double age_s = 0) {
    observe(receiver_m, age_s);
    return fix_of(image_from(along_m));
  }

  // Drives up to `along_m` until the hypothesis is accepted.
  void track_to(double along_m) {
    FixStatus status = FixStatus::initializing;
    for (int i = 3; i >= 0; --i) status = fix_at(along_m - i * kSpacingM, along_m).status;
    ASSERT_EQ(status, FixStatus::tracking);
  }

  // A GNSS fix for the next frame.
  void observe(double receiver_m, double age_s = 0) {
    localizer_.observe({time_s_ + kStepS - age_s, road_->point_at(receiver_m), kGnssSigmaM});
  }

  // The fix of the next frame without a GNSS fix; nothing is visible without an image.
  Fix fix_of(const std::optional<ImageDescriptor>& image) {
    time_s_ += kStepS;
    QueryFrame frame{time_s_, {}, {}};
    if (image) frame.image = [&image]() -> const ImageDescriptor& { return *image; };
    testing::wait_for_tiles(localizer_, time_s_);
    const auto fix = localizer_.localize(frame);
    EXPECT_TRUE(fix.ok()) << fix.error().line();
    return *fix;
  }

  // Frames without a measurement, until the fix is no longer predicted.
  Fix fix_after_seeing_nothing() {
    for (int frame = 0; frame < LocalizerSettings().max_predicted_frames; ++frame) {
      EXPECT_EQ(fix_of(std::nullopt).status, FixStatus::predicted) << frame;
    }
    return fix_of(std::nullopt);
  }

  std::shared_ptr<testing::MemorySource> map_ = one_road();
  Result<RouteLine> road_ = RouteLine::from_vertices({kLineStart, kEnd});

 private:
  static constexpr double kStepS = 0.2;

 protected:
  static LocalizerSettings settings() {
    LocalizerSettings settings;
    settings.method = *method_named("wisurf");
    settings.prefetch_m = 0;
    settings.method_settings.reach = {0, 10};
    settings.provider.surroundings_margin_m = 0;
    settings.provider.kept_m = 0;
    settings.provider.backoff.first_s = 0.001;
    return settings;
  }

  Localizer localizer_{map_, {600, 400, 400, 400}, settings()};

 private:
  double time_s_ = 10;
};

TEST_F(LocalizerAndReceiver, TracksWhileTheyAgree) {
  track_to(50);
  for (double along_m = 52; along_m < 100; along_m += kSpacingM) {
    const Fix fix = fix_at(along_m, along_m - 9);
    EXPECT_EQ(fix.status, FixStatus::tracking);
    EXPECT_NEAR(*fix.along_m, along_m, kSpacingM);
  }
}

TEST_F(LocalizerAndReceiver, StartsAnewWhereTheReceiverContradictsForLong) {
  track_to(52);
  Fix fix;
  int frames = 0;
  do {  // same images, but the vehicle is elsewhere
    fix = fix_at(52, 200);
  } while (fix.status == FixStatus::tracking && ++frames < 100);
  EXPECT_GT(frames, 5);   // a second
  EXPECT_LT(frames, 50);  // ten seconds
  for (frames = 0; fix.along_m.value_or(0) < 100 && frames < 20; ++frames) fix = fix_at(200, 200);
  EXPECT_NEAR(fix.along_m.value_or(0), 200, kSpacingM);
}

TEST_F(LocalizerAndReceiver, OneWrongPositionOfTheReceiverChangesNothing) {
  track_to(52);
  const Fix fix = fix_at(54, 200);
  EXPECT_NEAR(*fix.along_m, 54, kSpacingM);
  EXPECT_EQ(fix_at(56, 56).status, FixStatus::tracking);
}

TEST_F(LocalizerAndReceiver, AForgottenPositionContradictsNothing) {
  track_to(52);
  for (int frame = 0; frame < 30; ++frame) {
    ASSERT_EQ(fix_at(52, 200, 4).status, FixStatus::tracking) << frame;
  }
}

TEST_F(LocalizerAndReceiver, WaitsForAFreshPosition) {
  const Fix waiting = fix_at(50, 50, 4);
  EXPECT_EQ(waiting.status, FixStatus::initializing);
  EXPECT_FALSE(waiting.along_m.has_value());
  EXPECT_TRUE(fix_at(50, 50).along_m.has_value());
}

TEST_F(LocalizerAndReceiver, IsOffTheMapWhereNoSegmentIsNear) {
  road_ = RouteLine::from_vertices({{48, 8.4, 110}, {48.01, 8.4, 110}});
  EXPECT_EQ(fix_at(50, 50).status, FixStatus::off_map);
}

TEST_F(LocalizerAndReceiver, OfTwoRoadsBelievesTheOneThatLooksAlike) {
  map_->add(straight("beside"), tiles_of_a_road(image_beside));
  observe(50);
  EXPECT_EQ(fix_of(image_beside(50)).segment, "beside");
  Localizer again(map_, {600, 400, 400, 400}, settings());
  std::swap(localizer_, again);
  observe(50);
  EXPECT_EQ(fix_of(image_from(50)).segment, "road");
}

TEST_F(LocalizerAndReceiver, IsLostAfterTooManyFramesWithoutAnythingToSee) {
  track_to(50);
  EXPECT_EQ(fix_after_seeing_nothing().status, FixStatus::lost);
}

TEST_F(LocalizerAndReceiver, WhatIsSeenBetweenKeepsItFromBeingLost) {
  track_to(50);
  for (int turn = 0; turn < 3; ++turn) {
    for (int frame = 0; frame < LocalizerSettings().max_predicted_frames; ++frame) {
      EXPECT_EQ(fix_of(std::nullopt).status, FixStatus::predicted);
    }
    EXPECT_EQ(fix_of(image_from(52)).status, FixStatus::tracking);
  }
}

TEST_F(LocalizerAndReceiver, LostItStartsAgainWhereItWasWithoutTheReceiver) {
  track_to(50);
  for (int frame = 0; frame < 20; ++frame) fix_of(image_from(52));  // the GNSS fix grows old
  ASSERT_EQ(fix_after_seeing_nothing().status, FixStatus::lost);
  const Fix again = fix_of(image_from(52));
  EXPECT_NEAR(again.along_m.value_or(0), 52, kSpacingM);
  ASSERT_EQ(fix_of(image_from(52)).status, FixStatus::tracking);
  EXPECT_EQ(fix_after_seeing_nothing().status, FixStatus::lost);  // again after as many frames
}

TEST_F(LocalizerAndReceiver, BeyondTheEndOfTheRoadItIsOffTheMap) {
  fix_at(396, 396);
  for (const double along_m : {398.0, 400.0, 402.0, 404.0, 406.0}) {
    const Fix fix = fix_at(along_m, along_m);
    EXPECT_EQ(fix.status, FixStatus::tracking);
    EXPECT_LE(*fix.along_m, road_->length_m());
  }
  road_ = RouteLine::from_vertices({{48, 8.4, 110}, {48.01, 8.4, 110}});  // GNSS moves on
  EXPECT_EQ(fix_at(408, 50).status, FixStatus::off_map);
  EXPECT_EQ(fix_at(408, 50, 4).status, FixStatus::off_map);  // it was not lost
}

TEST_F(LocalizerAndReceiver, BeyondTheEndOfTheRoadItStartsOnTheNext) {
  fix_at(396, 396);
  for (const double along_m : {398.0, 400.0, 402.0, 404.0, 406.0}) fix_at(along_m, along_m);
  map_->add(straight("beside"), tiles_of_a_road(image_beside));
  observe(200);
  const Fix next = fix_of(image_beside(200));
  EXPECT_EQ(next.status, FixStatus::initializing);
  EXPECT_EQ(next.segment, "beside");
  EXPECT_NEAR(next.along_m.value_or(0), 200, kSpacingM);
}

// The images are the same there as beyond the end, but nothing drives 200 m in 0.2 s.
TEST_F(LocalizerAndReceiver, BeyondTheEndOfTheRoadItIsNotAtOnceFarBack) {
  fix_at(396, 396);
  for (const double along_m : {398.0, 400.0, 402.0, 404.0, 406.0}) fix_at(along_m, along_m);
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_EQ(fix_at(200 + frame * kSpacingM, 200).status, FixStatus::off_map) << frame;
  }
}

// The held data of the replaced build is used; the road of the new build is another hypothesis
// until it is accepted.
TEST_F(LocalizerAndReceiver, ABuildThatIsGoneIsLookedUpAnew) {
  track_to(50);
  map_->build_anew(build_of_map('2'));
  Fix fix;
  double along_m = 52;
  for (; along_m < 200; along_m += kSpacingM) {
    fix = fix_at(along_m, along_m);
    EXPECT_NEAR(fix.along_m.value_or(along_m), along_m, 2 * kSpacingM);
    if (fix.version.build == build_of_map('2') && fix.status == FixStatus::tracking) break;
  }
  EXPECT_LT(along_m, 200);
  EXPECT_GT(along_m, 60);  // it kept using the data held
}

TEST_F(LocalizerAndReceiver, WhileSeveralHypothesesAreTestedAFailingSourceIsRecordedToo) {
  fix_at(40, 40);
  map_->be_unavailable();
  const Fix fix = fix_at(42, 85);  // also searched beyond 100 m
  EXPECT_NEAR(fix.along_m.value_or(0), 42, kSpacingM);
  ASSERT_TRUE(localizer_.last_error().has_value());
  EXPECT_EQ(localizer_.last_error()->code, ErrorCode::unavailable);
}

TEST_F(LocalizerAndReceiver, AFailingSourceIsRecordedAndLocalizationContinues) {
  track_to(50);
  map_->be_unavailable();
  Fix fix;
  double along_m = 52;
  for (; along_m < 200 && !localizer_.last_error(); along_m += kSpacingM) {
    fix = fix_at(along_m, along_m);
    EXPECT_EQ(fix.status, FixStatus::tracking);
  }
  ASSERT_TRUE(localizer_.last_error().has_value());
  EXPECT_EQ(localizer_.last_error()->code, ErrorCode::unavailable);
  // What is held is used to its end.
  for (; along_m < 140 && fix.status == FixStatus::tracking; along_m += kSpacingM) {
    fix = fix_at(along_m, along_m);
  }
  EXPECT_GT(along_m, 96);
  EXPECT_LT(along_m, 140);
}

// The only position of a receiver was at the start.
TEST_F(LocalizerAndReceiver, WhereNeitherBranchAgreesItTellsNoneUntilOneDoes) {
  map_ = a_junction();
  localizer_ = Localizer(map_, {600, 400, 400, 400}, settings());
  track_to(360);
  double along_m = 362;
  for (; along_m < kLengthM; along_m += kSpacingM) fix_of(image_from(along_m));
  Fix fix;
  for (int frame = 0; frame < 20; ++frame) fix = fix_of(image_beside(100));
  EXPECT_FALSE(fix.along_m) << name_of(fix.status);
  for (int frame = 0; frame < 5; ++frame) fix = fix_of(image_of_branch<6>(10));
  EXPECT_EQ(fix.segment, "right");
  EXPECT_NEAR(fix.along_m.value_or(0), 10, kSpacingM);
}

}  // namespace
}  // namespace milepost
