#include "mapper/tracklets/on_segment.h"

#include <gtest/gtest.h>

#include <limits>

namespace milepost {
namespace {

constexpr AlongRange kSegment = {100, 150};

Track track_over(double from_m, double to_m) {
  Track track;
  for (double along_m = from_m; along_m <= to_m; along_m += 2) track.push_back({{}, {}, along_m});
  return track;
}

MappedLandmark landmark_over(double from_m, double to_m) {
  MappedLandmark landmark;
  landmark.along = {from_m, to_m};
  return landmark;
}

TEST(OnSegment, ATrackKeepsItsObservationsFromTheBeginOnAlsoBeyondTheEnd) {
  const auto part = track_on(track_over(96, 160), kSegment, 3);
  ASSERT_TRUE(part.has_value());
  EXPECT_EQ(part->front().along_m, 0);
  EXPECT_EQ(part->back().along_m, 60);
}

TEST(OnSegment, ATrackWithTooFewObservationsLeftIsNone) {
  EXPECT_TRUE(track_on(track_over(90, 104), kSegment, 3).has_value());
  EXPECT_FALSE(track_on(track_over(90, 103), kSegment, 3).has_value());
  EXPECT_FALSE(track_on(track_over(150, 160), kSegment, 3).has_value());
}

TEST(OnSegment, ALandmarkBelongsToEachSegmentThatItWasSeenFrom) {
  const auto before = landmark_on(landmark_over(90, 110), kSegment);
  ASSERT_TRUE(before.has_value());
  EXPECT_EQ(before->along.from_m, 0);
  EXPECT_EQ(before->along.to_m, 10);
  const auto beyond = landmark_on(landmark_over(140, 170), kSegment);
  ASSERT_TRUE(beyond.has_value());
  EXPECT_EQ(beyond->along.from_m, 40);
  EXPECT_EQ(beyond->along.to_m, 70);
  EXPECT_FALSE(landmark_on(landmark_over(80, 100), kSegment).has_value());
  EXPECT_FALSE(landmark_on(landmark_over(150, 170), kSegment).has_value());
}

TEST(OnSegment, ASegmentIsCompleteOnceTheStretchIsBeyondIt) {
  EXPECT_EQ(complete_on(120, kSegment), 20);
  EXPECT_LT(complete_on(90, kSegment), 0);
  EXPECT_EQ(complete_on(150, kSegment), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace milepost
