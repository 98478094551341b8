#include "mapper/landmarks/selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "tests/mapper/made_up_street.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using testing::MadeUpStreet;

// A straight line of 200 m to the north.
RouteLine line_north() {
  std::vector<GeoPoint> vertices;
  for (int i = 0; i <= 100; ++i) vertices.push_back(MadeUpStreet::geo_of({0, 2.0 * i, 1.5}));
  return RouteLine::from_vertices(std::move(vertices)).value();
}

// Visible over 20 m of road from `from_m`, and nine metres ahead of that.
MappedLandmark landmark_at(double right_m, double from_m, double ahead_m = 29) {
  MappedLandmark landmark;
  landmark.position = MadeUpStreet::geo_of({right_m, from_m + ahead_m, 3});
  landmark.depth_m = ahead_m;
  landmark.depth_sigma_m = 0.1;
  landmark.along = {from_m, from_m + 20};
  landmark.observations = 10;
  return landmark;
}

TEST(LandmarkSelector, NearAndRepeatedLandmarksComeFirst) {
  const LandmarkSelector selector({});
  MappedLandmark rare = landmark_at(5, 40);
  rare.observations = 3;
  MappedLandmark uncertain = landmark_at(5, 40);
  uncertain.depth_sigma_m = 10;
  const MappedLandmark far = landmark_at(5, 40, 120);
  const MappedLandmark good = landmark_at(5, 40);
  for (const MappedLandmark& worse : {rare, uncertain, far}) {
    EXPECT_THAT(selector.ranked({worse, good}, line_north()), ElementsAre(1, 0));
    EXPECT_THAT(selector.ranked({good, worse}, line_north()), ElementsAre(0, 1));
  }
}

//   1 .    . 0,2,3    three on the right at one bearing, one on the left
//       |
TEST(LandmarkSelector, AnotherBearingBeatsTheSameAgain) {
  const LandmarkSelector selector({});
  const std::vector<std::size_t> order = selector.ranked(
      {landmark_at(6, 40), landmark_at(-6.5, 40), landmark_at(6.01, 40), landmark_at(6.02, 40)},
      line_north());
  EXPECT_EQ(std::find(order.begin(), order.end(), 1U) - order.begin(), 1);
}

TEST(LandmarkSelector, RoadWithoutLandmarksComesBeforeRoadThatHasSome) {
  const LandmarkSelector selector({});
  const MappedLandmark elsewhere = landmark_at(7, 100);  // adds a little less information by itself
  const std::vector<std::size_t> order = selector.ranked(
      {landmark_at(6, 40), landmark_at(6.1, 40), landmark_at(-6, 40), elsewhere}, line_north());
  EXPECT_LE(std::find(order.begin(), order.end(), 3U) - order.begin(), 1);
}

TEST(LandmarkSelector, WhatWasChosenLowersWhatItsLikeSay) {
  LandmarkSelector selector({});
  const std::vector<MappedLandmark> landmarks = {landmark_at(6, 40), landmark_at(7, 100)};
  EXPECT_THAT(selector.ranked(landmarks, line_north()), ElementsAre(0, 1));
  selector.choose(landmark_at(6.1, 42), line_north());
  EXPECT_THAT(selector.ranked(landmarks, line_north()), ElementsAre(1, 0));
}

TEST(LandmarkSelector, RanksAllEachOnceAndAlikeInTheirOrder) {
  const LandmarkSelector selector({});
  std::vector<MappedLandmark> landmarks;
  for (int i = 0; i < 60; ++i) landmarks.push_back(landmark_at(4 + i % 7, 2.0 * (i % 11)));
  const std::vector<std::size_t> order = selector.ranked(landmarks, line_north());
  EXPECT_EQ(selector.ranked(landmarks, line_north()), order);
  std::vector<std::size_t> all(landmarks.size());
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_THAT(order, ::testing::UnorderedElementsAreArray(all));
  const MappedLandmark one = landmark_at(5, 40);
  EXPECT_THAT(selector.ranked({one, one, one}, line_north()), ElementsAre(0, 1, 2));
  EXPECT_TRUE(selector.ranked({}, line_north()).empty());
}

}  // namespace
}  // namespace milepost
