#include "client/evaluate/baselines/scale_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace milepost {
namespace {

FeatureSet random_features(std::size_t count) {
  std::mt19937 random(9);
  FeatureSet set;
  for (std::size_t i = 0; i < count; ++i) {
    set.features.push_back({static_cast<float>(random() % 600), static_cast<float>(random() % 500),
                            2 + static_cast<float>(random() % 100) / 10});
    Descriptor descriptor;
    for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random() % 200);
    set.descriptors.push_back(descriptor);
  }
  return set;
}

// The same features, with half of their scales multiplied by `grown` and the others divided by it.
FeatureSet changed(FeatureSet set, float grown) {
  for (std::size_t i = 0; i < set.size(); ++i) {
    set.features[i].scale_px *= i % 2 == 0 ? grown : 1 / grown;
  }
  return set;
}

class ScaleChangeOf : public ::testing::Test {
 protected:
  const DatabaseFrame stored_{40, random_features(50), std::nullopt};
  const IndexedFrame map_frame_{stored_, IndexSettings{}};
};

TEST_F(ScaleChangeOf, IsNothingAtTheSamePlace) {
  const auto change = scale_change(stored_.features, 1, 600, map_frame_, {});
  ASSERT_TRUE(change.has_value());
  EXPECT_EQ(change->mean, 0);
  EXPECT_EQ(change->matches, 50);
}

TEST_F(ScaleChangeOf, IsTheMeanOfBothDirections) {
  const auto change = scale_change(changed(stored_.features, 1.2F), 1, 600, map_frame_, {});
  ASSERT_TRUE(change.has_value());
  EXPECT_NEAR(change->mean, std::log(1.2), 1e-5);
}

TEST_F(ScaleChangeOf, AnotherCamerasScalesAreBroughtToTheMaps) {
  FeatureSet query = stored_.features;
  for (Feature& feature : query.features) feature.scale_px *= 2;
  EXPECT_NEAR(scale_change(query, 0.5, 600, map_frame_, {})->mean, 0, 1e-6);
}

TEST_F(ScaleChangeOf, AFeatureFarAcrossTheImageIsNoMatch) {
  FeatureSet query = stored_.features;
  for (std::size_t i = 0; i < 20; ++i) query.features[i].x_px += 200;
  EXPECT_EQ(scale_change(query, 1, 600, map_frame_, {})->matches, 30);
}

TEST_F(ScaleChangeOf, TooFewMatchesSayNothing) {
  FeatureSet query = stored_.features;
  query.features.resize(4);
  query.descriptors.resize(4);
  EXPECT_FALSE(scale_change(query, 1, 600, map_frame_, {}).has_value());
  EXPECT_FALSE(scale_change({}, 1, 600, map_frame_, {}).has_value());
}

}  // namespace
}  // namespace milepost
