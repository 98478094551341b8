// Hypotheses tested against each other, and relocalization checks of the tracked one.
#include "client/localize/hypothesis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "client/localize/relocalization_check.h"
#include "tests/client/fetch/held_segment.h"
#include "tests/client/localize/standing_tracker.h"

namespace milepost {
namespace {

using testing::Standing;

constexpr double kMetresPerDegree = 111229;  // of latitude, at 49 degrees

RouteLine northwards() {
  std::vector<GeoPoint> vertices;
  for (int i = 0; i <= 10; ++i) vertices.push_back({49.0 + 10 * i / kMetresPerDegree, 8.4, 110});
  return *RouteLine::from_vertices(vertices);
}

class Hypotheses : public ::testing::Test {
 protected:
  Hypothesis hypothesis(double along_m, int matches, double log_bayes_factor,
                        double odds = 0) const {
    Hypothesis hypothesis{{.odds = LogOdds(LogOddsSettings()),
                           .receiver = GnssLikelihood(GnssLikelihoodSettings()),
                           .timestamp_s = 10,
                           .measured = true,
                           .log_bayes_factor = log_bayes_factor,
                           .matches = matches},
                          std::make_unique<Standing>(layer_, TrackedPose{along_m, 0.1})};
    hypothesis.odds.add(odds);
    return hypothesis;
  }

  RelocalizationCandidate candidate(double along_m, int matches) const {
    return {std::make_unique<Standing>(layer_, TrackedPose{along_m, 0.1}), matches, 5};
  }

  static double along_m(const Hypothesis& hypothesis) { return hypothesis.tracker->pose().along_m; }

  template <class... Each>
  static std::vector<Hypothesis> hypotheses(Each... each) {
    std::vector<Hypothesis> all;
    (all.push_back(std::move(each)), ...);
    return all;
  }

  std::shared_ptr<const SegmentLayer> layer_ = testing::layer_of({{}, "s"}, northwards(), {}, {});
};

TEST_F(Hypotheses, OfEqualOnesThePoseWithMostInliersStays) {
  auto all =
      hypotheses(hypothesis(20.4, 90, 9, 3), hypothesis(20, 150, 5), hypothesis(60, 80, 4, 1));
  weigh(all, std::nullopt, 5);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(along_m(all[0]), 20);
  EXPECT_GT(all[0].odds.log(), 3);  // those of the more likely one
  EXPECT_EQ(all[0].log_bayes_factor, 9);
  EXPECT_EQ(along_m(all[1]), 60);
}

TEST_F(Hypotheses, APoseWithAlmostAsManyInliersMakesItUncertain) {
  auto all = hypotheses(hypothesis(21.5, 100, 5), hypothesis(20, 150, 5));
  weigh(all, std::nullopt, 5);
  EXPECT_NEAR(all.front().apart_m, 1.5, 0.01);
  all = hypotheses(hypothesis(21.5, 80, 5), hypothesis(20, 150, 5));
  weigh(all, std::nullopt, 5);
  EXPECT_EQ(all.front().apart_m, 0);
}

TEST_F(Hypotheses, UnlikelyOnesAndTooManyAreDropped) {
  auto all = hypotheses(hypothesis(10, 9, 2, 1), hypothesis(30, 9, 2, 3), hypothesis(50, 9, 2, 2),
                        hypothesis(70, 9, 0, -8));
  weigh(all, std::nullopt, 5);
  ASSERT_EQ(all.size(), 3U);
  weigh(all, std::nullopt, 2);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(along_m(all[0]), 30);
  EXPECT_EQ(along_m(all[1]), 50);
}

TEST_F(Hypotheses, TheFirstIsTestedAgainstTheOthersAndElsewhere) {
  auto all = hypotheses(hypothesis(10, 9, 0, 8));
  const double alone = log_odds_of_first(all);
  EXPECT_NEAR(alone, all.front().odds.log(), 1e-12);
  all.push_back(hypothesis(50, 9, 0, 8));
  EXPECT_NEAR(log_odds_of_first(all), -std::log(1 + std::exp(-alone)), 1e-9);
}

TEST_F(Hypotheses, BehindWhereOneWasLeftIsUnlikelySoonAfter) {
  const Hypothesis left = hypothesis(100, 90, 5);
  Hypothesis ahead = hypothesis(100.3, 90, 5);
  Hypothesis behind = hypothesis(97, 90, 5);
  ahead.timestamp_s = behind.timestamp_s = 10.2;
  EXPECT_GT(log_bayes_factor_after(left, ahead), -1);
  EXPECT_LT(log_bayes_factor_after(left, behind), -8);
  behind.timestamp_s = 13;  // it may have turned around
  EXPECT_GT(log_bayes_factor_after(left, behind), -1);
}

// On another road, where the motion since the map was left says where the vehicle is.
TEST_F(Hypotheses, WhereTheMotionLeadsIsLikely) {
  const auto other = testing::layer_of({{}, "other"}, northwards(), {}, {});
  const auto at = [](const std::shared_ptr<const SegmentLayer>& layer, double east_m,
                     double heading_deg, double sigma_m) {
    GeoCameraPose camera;
    camera.position = LocalFrame({49.0, 8.4, 110}).geo_from_enu({east_m, 50, 0});
    camera.heading_deg = heading_deg;
    for (const std::size_t axis : {0, 1, 2}) camera.covariance.at(7 * axis) = sigma_m * sigma_m;
    camera.covariance[21] = 1;  // square degrees
    return Hypothesis{
        {.odds = LogOdds(LogOddsSettings()),
         .receiver = GnssLikelihood(GnssLikelihoodSettings()),
         .timestamp_s = 10},
        std::make_unique<Standing>(layer, TrackedPose{50, 0.1, FullPose{0, 0.1, camera}})};
  };
  const Hypothesis left = at(layer_, 0, 359.8, 2);
  const double there = log_bayes_factor_after(left, at(other, 1, 0.2, 0.1));
  EXPECT_GT(there, 1.5);
  EXPECT_LT(there, 3);  // not enough for a claim by one frame
  EXPECT_NEAR(log_bayes_factor_after(left, at(other, 4, 359.8, 0.1)), 0, 0.1);  // two sigmas
  EXPECT_LT(log_bayes_factor_after(left, at(other, 1, 21, 0.1)), -4);
  EXPECT_EQ(log_bayes_factor_after(left, at(other, 300, 359.8, 0.1)), -4.6);
  EXPECT_EQ(log_bayes_factor_after(left, hypothesis(50, 90, 5)), -0.0);  // the same segment
}

TEST_F(Hypotheses, ACheckThatAgreesChangesNothing) {
  RelocalizationCheck check;
  Hypothesis result = hypothesis(20, 100, 5);
  // The same pose; one with fewer inliers; one of another hypothesis.
  for (const auto& [seen_m, matches] : {std::pair{20.3, 130}, {22.0, 85}, {26.0, 130}}) {
    for (int turn = 0; turn < 2; ++turn) {
      std::vector<RelocalizationCandidate> seen;
      seen.push_back(candidate(seen_m, matches));
      check.compare(result, std::move(seen));
      EXPECT_EQ(result.apart_m, 0) << seen_m;
    }
  }
  check.compare(result, {});
  EXPECT_EQ(along_m(result), 20);
}

TEST_F(Hypotheses, TwoConsecutiveContradictionsReplaceTheBelief) {
  RelocalizationCheck check;
  Hypothesis result = hypothesis(20, 100, 5);
  const auto against = [&] {
    std::vector<RelocalizationCandidate> seen;
    seen.push_back(candidate(21.4, 130));
    result.apart_m = 0;
    check.compare(result, std::move(seen));
  };
  against();
  EXPECT_NEAR(result.apart_m, 1.4, 0.01);
  check.compare(result, {});               // not consecutive ...
  EXPECT_NEAR(result.apart_m, 1.4, 0.01);  // ... but uncertain for a while
  against();
  EXPECT_EQ(along_m(result), 20);
  against();
  EXPECT_EQ(along_m(result), 21.4);
  EXPECT_EQ(result.matches, 130);
  for (const double apart_m : {1.4, 1.4, 0.0}) {
    EXPECT_NEAR(result.apart_m, 1.4, 0.01);  // still uncertain
    check.compare(result, {});
    EXPECT_NEAR(result.apart_m, apart_m, 0.01);
  }
}

TEST_F(Hypotheses, AboutAsManyInliersMakeItUncertainButKeepIt) {
  RelocalizationCheck check;
  Hypothesis result = hypothesis(20, 100, 5);
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<RelocalizationCandidate> seen;
    seen.push_back(candidate(22, 105));
    check.compare(result, std::move(seen));
    EXPECT_NEAR(result.apart_m, 2, 0.01);
  }
  EXPECT_EQ(along_m(result), 20);
}

TEST_F(Hypotheses, ChecksAreFrequentAtFirst) {
  RelocalizationCheck check;
  Hypothesis result = hypothesis(20, 100, 5);
  for (int frame = 0; frame < 10; ++frame) {
    EXPECT_TRUE(check.is_due(20)) << frame;
    check.compare(result, {});
  }
  EXPECT_FALSE(check.is_due(24.9));
  EXPECT_TRUE(check.is_due(25));
  std::vector<RelocalizationCandidate> against;
  against.push_back(candidate(22, 130));
  check.compare(result, std::move(against));
  EXPECT_TRUE(check.is_due(20.1));
}

// A calibration estimated by a belief that may have slipped must not be used to check it.
TEST_F(Hypotheses, ChecksUseTheCalibrationOnceThePoseIsCertain) {
  RelocalizationCheck check;
  Hypothesis result = hypothesis(20, 100, 5);
  for (int frame = 0; frame < 10; ++frame) {
    EXPECT_FALSE(check.camera(result)) << frame;
    check.compare(result, {});
  }
  ASSERT_TRUE(check.camera(result));
  EXPECT_EQ(check.camera(result)->mean[0], 0.05);
  std::vector<RelocalizationCandidate> alternative;
  alternative.push_back(candidate(22, 105));
  check.compare(result, std::move(alternative));
  EXPECT_FALSE(check.camera(result));
  for (int calm = 0; calm < 3; ++calm) check.compare(result, {});
  EXPECT_TRUE(check.camera(result));
}

}  // namespace
}  // namespace milepost
