#include "mapper/tracklets/regression.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace milepost {
namespace {

using ::testing::DoubleNear;
using ::testing::FloatNear;

// A feature of fixed size at `feature_along_m`, approached at constant speed: s = k / Z.
Track approached_feature(double k, double feature_along_m, double start_m, double step_m,
                         int frames) {
  Track track;
  for (int m = 0; m < frames; ++m) {
    const double along_m = start_m + m * step_m;
    Observation observation;
    observation.along_m = along_m;
    observation.feature = {static_cast<float>(300 + m), static_cast<float>(200 - m),
                           static_cast<float>(k / (feature_along_m - along_m))};
    observation.descriptor.fill(static_cast<std::uint8_t>(10 * (m + 1)));
    track.push_back(observation);
  }
  return track;
}

TEST(Regression, InverseScaleIsExactForAFeatureOfFixedSize) {
  const Track track = approached_feature(120, 1040, 1000, 2, 8);
  const auto tracklet = tracklet_from_track(track, {ScaleModel::inverse_scale, 0.8});
  ASSERT_TRUE(tracklet.has_value());
  EXPECT_NEAR(tracklet->r_squared, 1.0, 1e-6);
  EXPECT_NEAR(tracklet->offset_m, 1040, 1e-3);  // where the feature is
  EXPECT_NEAR(tracklet->slope, 120, 1e-3);      // k
  EXPECT_NEAR(tracklet->residual_sigma_m, 0, 1e-4);
  // Exact between the map's frames too, Eq. 3.
  for (double along_m = 1000.5; along_m < 1014; along_m += 1.7) {
    const double scale_px = 120 / (1040 - along_m);
    EXPECT_NEAR(tracklet->along_estimate_m(ScaleModel::inverse_scale, scale_px), along_m, 1e-3);
  }
}

TEST(Regression, ScaleModelIsBiasedForTheSameFeature) {
  const Track track = approached_feature(120, 1040, 1000, 2, 8);
  const auto tracklet = tracklet_from_track(track, {ScaleModel::scale, 0.8});
  ASSERT_TRUE(tracklet.has_value());
  EXPECT_LT(tracklet->r_squared, 0.995);
  const double middle_scale_px = 120 / (1040 - 1007.0);
  EXPECT_GT(std::abs(tracklet->along_estimate_m(ScaleModel::scale, middle_scale_px) - 1007), 0.3);
}

// Five points by hand: s = 1..5, l = 2, 4, 5, 4, 5. Theta = (2.2, 0.6), SS_res = 2.4, SS_tot = 6.
TEST(Regression, LeastSquaresAndDeterminationByHand) {
  const double along_m[] = {2, 4, 5, 4, 5};
  Track track;
  for (int m = 0; m < 5; ++m) {
    Observation observation;
    observation.along_m = along_m[m];
    observation.feature.scale_px = static_cast<float>(m + 1);
    track.push_back(observation);
  }
  const auto tracklet = tracklet_from_track(track, {ScaleModel::scale, 0.5});
  ASSERT_TRUE(tracklet.has_value());
  EXPECT_THAT(tracklet->offset_m, DoubleNear(2.2, 1e-9));
  EXPECT_THAT(tracklet->slope, DoubleNear(0.6, 1e-9));
  EXPECT_THAT(tracklet->r_squared, FloatNear(0.6F, 1e-6F));
  EXPECT_THAT(tracklet->residual_sigma_m, FloatNear(std::sqrt(2.4F / 3), 1e-6F));
  EXPECT_FALSE(tracklet_from_track(track, {ScaleModel::scale, 0.61}).has_value());
}

TEST(Regression, KeepsMeanDescriptorAndRanges) {
  const auto tracklet = tracklet_from_track(approached_feature(60, 30, 0, 2, 4), {});
  ASSERT_TRUE(tracklet.has_value());
  EXPECT_THAT(tracklet->descriptor, ::testing::Each(25));  // of 10, 20, 30, 40, Eq. 15
  EXPECT_EQ(tracklet->observations, 4);
  EXPECT_EQ(tracklet->along.from_m, 0);
  EXPECT_EQ(tracklet->along.to_m, 6);
  EXPECT_FLOAT_EQ(tracklet->scale_min_px, 2);
  EXPECT_FLOAT_EQ(tracklet->scale_max_px, 2.5);
  EXPECT_FLOAT_EQ(tracklet->pixels.x_min_px, 300);
  EXPECT_FLOAT_EQ(tracklet->pixels.x_max_px, 303);
  EXPECT_FLOAT_EQ(tracklet->pixels.y_min_px, 197);
  EXPECT_FLOAT_EQ(tracklet->pixels.y_max_px, 200);
}

TEST(Regression, RefusesTracksThatDoNotDeterminePosition) {
  Track constant = approached_feature(60, 30, 0, 2, 4);
  for (Observation& observation : constant) observation.feature.scale_px = 3;
  EXPECT_FALSE(tracklet_from_track(constant, {}).has_value());

  Track receding = approached_feature(60, 30, 0, 2, 4);
  std::swap(receding[0].feature, receding[3].feature);
  std::swap(receding[1].feature, receding[2].feature);
  EXPECT_FALSE(tracklet_from_track(receding, {}).has_value());

  Track standing = approached_feature(60, 30, 0, 2, 4);
  for (Observation& observation : standing) observation.along_m = 5;
  EXPECT_FALSE(tracklet_from_track(standing, {}).has_value());
}

}  // namespace
}  // namespace milepost
