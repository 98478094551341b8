// What a fix says of the world and of the map.
#include "client/localize/hypothesis_fix.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/client/fetch/held_segment.h"
#include "tests/client/localize/standing_tracker.h"

namespace milepost {
namespace {

constexpr double kMapSigmaM = 0.12;
constexpr double kAlongSigmaM = 0.03;
constexpr double kLateralSigmaM = 0.04;

RouteLine northwards_line() {
  const LocalFrame local({49, 8.4, 110});
  return *RouteLine::from_vertices(
      {local.geo_from_enu({0, 0, 0}), local.geo_from_enu({0, 100, 0})});
}

Hypothesis hypothesis(std::optional<double> map_sigma_m) {
  SegmentLayer layer = *testing::layer_of({{}, "s"}, northwards_line(), {}, {});
  layer.position_error.sigma_m = map_sigma_m;
  GeoCameraPose camera;
  camera.position = LocalFrame({49, 8.4, 110}).geo_from_enu({0, 50, 0});
  camera.covariance[0] = kLateralSigmaM * kLateralSigmaM;
  camera.covariance[7] = kAlongSigmaM * kAlongSigmaM;
  return {{.odds = LogOdds(LogOddsSettings()),
           .receiver = GnssLikelihood(GnssLikelihoodSettings()),
           .timestamp_s = 10},
          std::make_unique<testing::Standing>(
              std::make_shared<const SegmentLayer>(std::move(layer)),
              TrackedPose{50, kAlongSigmaM, FullPose{0, kLateralSigmaM, camera}})};
}

TEST(HypothesisFix, HoldsInTheWorldAndAgainstTheMap) {
  const Fix fix = fix_of(hypothesis(kMapSigmaM), FixStatus::tracking);
  EXPECT_DOUBLE_EQ(fix.sigma_map_m, kAlongSigmaM);
  EXPECT_DOUBLE_EQ(fix.sigma_m, std::hypot(kAlongSigmaM, kMapSigmaM));
  EXPECT_DOUBLE_EQ(*fix.lateral_sigma_m, std::hypot(kLateralSigmaM, kMapSigmaM));
  EXPECT_NEAR(std::sqrt(fix.camera->covariance[0]), *fix.lateral_sigma_m, 1e-12);
  EXPECT_NEAR(std::sqrt(fix.camera->covariance[7]), fix.sigma_m, 1e-12);
}

TEST(HypothesisFix, OfAMapThatDoesNotKnowItsErrorBothAreTheSame) {
  const Fix fix = fix_of(hypothesis({}), FixStatus::tracking);
  EXPECT_DOUBLE_EQ(fix.sigma_m, kAlongSigmaM);
  EXPECT_DOUBLE_EQ(fix.sigma_map_m, kAlongSigmaM);
  EXPECT_DOUBLE_EQ(*fix.lateral_sigma_m, kLateralSigmaM);
}

TEST(HypothesisFix, DoubtWidensBoth) {
  const Hypothesis doubted = hypothesis(kMapSigmaM);
  Fix fix = fix_of(doubted, FixStatus::initializing);
  widen(fix, 0, doubted, {}, std::nullopt);
  EXPECT_GT(fix.sigma_map_m, 10);
  EXPECT_GT(fix.sigma_m, fix.sigma_map_m);
}

TEST(HypothesisFix, OffTheMapTheMotionStartsFromItsError) {
  Fix fix = unlocated(10, FixStatus::off_map);
  carry_on(fix, hypothesis(kMapSigmaM), 10);
  EXPECT_DOUBLE_EQ(fix.sigma_map_m, std::hypot(kAlongSigmaM, kLateralSigmaM));
  EXPECT_NEAR(fix.sigma_m, std::hypot(fix.sigma_map_m, kMapSigmaM * std::sqrt(2)), 1e-12);
  EXPECT_TRUE(fix.position);
}

// A receiver that knows the world to a centimetre does not contradict a map that is 0.3 m off.
TEST(HypothesisFix, AReceiverIsHeldAgainstAMapWithAnError) {
  const auto odds_after = [](std::optional<double> map_sigma_m) {
    Hypothesis there = hypothesis(map_sigma_m);
    const GeoPoint beside = LocalFrame(there.position()).geo_from_enu({0.3, 0, 0});
    const double before = there.odds.log();
    there.weigh(0, GnssFix{10, beside, 0.01});
    return there.odds.log() - before;
  };
  EXPECT_GT(odds_after(0.15), odds_after({}) + 3);
}

}  // namespace
}  // namespace milepost
