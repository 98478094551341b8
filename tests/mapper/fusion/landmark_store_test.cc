#include "mapper/fusion/landmark_store.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/mapper/fusion/made_up_landmarks.h"

namespace milepost {
namespace {

TEST(LandmarkStore, GivesBackWhatWasAddedByBegin) {
  testing::MadeUpLandmarks road(30);
  auto store = LandmarkStore::create();
  ASSERT_TRUE(store.ok());
  auto landmarks = road.mapped(3, {0, 0, 0});
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    landmarks[i].landmark.right_m = landmarks[i].landmark.along.from_m / 4;
  for (const PassLandmark& landmark : landmarks) ASSERT_TRUE(store->add(7, 2, landmark).ok());
  const auto read = store->read(7, 2);
  ASSERT_TRUE(read.ok());
  std::ranges::stable_sort(landmarks, {},
                           [](const PassLandmark& each) { return each.landmark.along.from_m; });
  ASSERT_EQ(read->size(), landmarks.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const PassLandmark& is = (*read)[i];
    EXPECT_EQ(is.pass, 3U);
    EXPECT_EQ(is.stretch_m, landmarks[i].stretch_m);
    EXPECT_EQ(is.landmark.position, landmarks[i].landmark.position);
    EXPECT_EQ(is.landmark.descriptor, landmarks[i].landmark.descriptor);
    EXPECT_EQ(is.landmark.covariance_m2, landmarks[i].landmark.covariance_m2);
    EXPECT_EQ(is.landmark.along.to_m, landmarks[i].landmark.along.to_m);
    EXPECT_EQ(is.landmark.right_m, landmarks[i].landmark.right_m);
    EXPECT_EQ(is.landmark.size_m, landmarks[i].landmark.size_m);
    EXPECT_EQ(is.landmark.observations, 5U);
  }
}

TEST(LandmarkStore, KeepsTilesAndSegmentsApart) {
  testing::MadeUpLandmarks road(1);
  const PassLandmark landmark = road.mapped(0, {0, 0, 0}).front();
  auto store = LandmarkStore::create();
  ASSERT_TRUE(store.ok());
  ASSERT_TRUE(store->add(1, 2, landmark).ok());
  ASSERT_TRUE(store->add(1, 2, landmark).ok());
  ASSERT_TRUE(store->add(2, 1, landmark).ok());
  EXPECT_EQ(store->read(1, 2)->size(), 2U);
  EXPECT_EQ(store->read(2, 1)->size(), 1U);
  EXPECT_TRUE(store->read(1, 1)->empty());
}

}  // namespace
}  // namespace milepost
