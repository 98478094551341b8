#include "mapper/fusion/merging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/mapper/fusion/made_up_landmarks.h"

namespace milepost {
namespace {

using testing::MadeUpLandmarks;
using testing::MadeUpStreet;

constexpr double kAll = std::numeric_limits<double>::infinity();

std::vector<MappedLandmark> merged(std::vector<PassLandmark> landmarks, std::size_t passes) {
  std::ranges::stable_sort(landmarks, {},
                           [](const PassLandmark& each) { return each.landmark.along.from_m; });
  LandmarkMerger merger(LocalFrame(MadeUpStreet::geo_of(Eigen::Vector3d::Zero())), passes, {});
  for (const PassLandmark& landmark : landmarks) merger.add(landmark);
  return merger.take_before(kAll);
}

std::vector<PassLandmark> both(std::vector<PassLandmark> a, const std::vector<PassLandmark>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(LandmarkMerger, AFeatureThatThreeDrivesSawIsOneLandmark) {
  MadeUpLandmarks road(60);
  const auto seen =
      both(both(road.mapped(0, {0, 0, 0}), road.mapped(1, {0, 0, 0})), road.mapped(2, {0, 0, 0}));
  const auto landmarks = merged(seen, 3);
  ASSERT_EQ(landmarks.size(), 60U);
  double off_m = 0;
  for (const MappedLandmark& landmark : landmarks) {
    EXPECT_EQ(landmark.passes, 3U);
    EXPECT_EQ(landmark.passes_there, 3U);
    EXPECT_EQ(landmark.observations, 15U);
    const Eigen::Vector3d at = MadeUpStreet::enu_of(landmark.position);
    const auto nearest = std::ranges::min(
        road.features(), {}, [&](const auto& feature) { return (feature.enu_m - at).norm(); });
    off_m += (nearest.enu_m - at).norm() / 60;
    EXPECT_NEAR(landmark.size_m, nearest.size_m, 1e-6);
  }
  EXPECT_LT(off_m, 0.7 * 0.02 * 1.6);  // of one drive: about 1.6 times 0.02 m
}

TEST(LandmarkMerger, AnotherDescriptorAnotherLandmark) {
  MadeUpLandmarks road(60);
  const auto landmarks =
      merged(both(road.mapped(0, {0, 0, 0}), road.mapped(1, {0, 0, 0}, 0.02, 1000)), 2);
  EXPECT_EQ(landmarks.size(), 120U);
  for (const MappedLandmark& landmark : landmarks) EXPECT_EQ(landmark.passes, 1U);
}

TEST(LandmarkMerger, AnotherPlaceOrSizeAnotherLandmark) {
  MadeUpLandmarks road(60);
  EXPECT_EQ(merged(both(road.mapped(0, {0, 0, 0}), road.mapped(1, {1, 0, 0})), 2).size(), 120U);
  auto larger = road.mapped(1, {0, 0, 0});
  for (PassLandmark& each : larger) each.landmark.size_m *= 2;
  EXPECT_EQ(merged(both(road.mapped(0, {0, 0, 0}), larger), 2).size(), 120U);
}

TEST(LandmarkMerger, WhatOneDriveSawTwiceStaysTwo) {
  MadeUpLandmarks road(60);
  EXPECT_EQ(merged(both(road.mapped(0, {0, 0, 0}), road.mapped(0, {0, 0, 0})), 1).size(), 120U);
}

TEST(LandmarkMerger, ALandmarkOfOneDriveStaysAsItWasMapped) {
  MadeUpLandmarks road(1);
  const PassLandmark seen = road.mapped(0, {0.3, 0, 0}).front();
  const MappedLandmark landmark = merged({seen}, 2).front();
  EXPECT_EQ(landmark.position, seen.landmark.position);
  EXPECT_EQ(landmark.descriptor, seen.landmark.descriptor);
  EXPECT_EQ(landmark.depth_sigma_m, seen.landmark.depth_sigma_m);
}

TEST(LandmarkMerger, EachIsTakenOnceInTheOrderOfBegins) {
  MadeUpLandmarks road(60, 100);
  auto landmarks = road.mapped(0, {0, 0, 0});
  std::ranges::sort(landmarks, {}, [](const auto& each) { return each.landmark.along.from_m; });
  LandmarkMerger merger(LocalFrame(MadeUpStreet::geo_of(Eigen::Vector3d::Zero())), 1, {});
  for (const PassLandmark& landmark : landmarks) merger.add(landmark);
  std::vector<MappedLandmark> taken = merger.take_before(50);
  EXPECT_GT(taken.size(), 10U);
  EXPECT_LT(taken.back().along.from_m, 50);
  for (const MappedLandmark& later : merger.take_before(kAll)) taken.push_back(later);
  EXPECT_EQ(taken.size(), 60U);
  EXPECT_TRUE(std::ranges::is_sorted(
      taken, {}, [](const MappedLandmark& landmark) { return landmark.along.from_m; }));
}

}  // namespace
}  // namespace milepost
