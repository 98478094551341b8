#include "client/localize/gnss_likelihood.h"

#include <gtest/gtest.h>

namespace milepost {
namespace {

constexpr GnssLikelihoodSettings kSettings;
constexpr GeoPoint kPlace = {49.0, 8.4, 110};
constexpr double kMetresOfADegree = 111229;  // of latitude, at 49 degrees
constexpr double kSigmaM = 5;

GnssFix reading(double off_m, double timestamp_s) {
  return {timestamp_s,
          {kPlace.latitude_deg + off_m / kMetresOfADegree, kPlace.longitude_deg, 0},
          kSigmaM};
}

// A first fix without delay.
double first(double off_m) {
  GnssLikelihood evidence(kSettings);
  return evidence.log_bayes_factor(reading(off_m, 10), kPlace, 10);
}

TEST(GnssLikelihood, SpeaksForWhereItIsAndAgainstWhereItIsNot) {
  EXPECT_GT(first(0), 1);
  EXPECT_NEAR(first(kSettings.elsewhere_sigmas * kSigmaM), 0, 1e-3);
  EXPECT_LT(first(30), -3);
  EXPECT_LT(first(100), first(30));
}

TEST(GnssLikelihood, AReadingFarOffIsNotTheEnd) {
  EXPECT_GT(first(100), -15);  // a normal density would give -200
}

TEST(GnssLikelihood, AReadingCountsOnce) {
  GnssLikelihood evidence(kSettings);
  EXPECT_LT(evidence.log_bayes_factor(reading(30, 10), kPlace, 10), 0);
  EXPECT_EQ(evidence.log_bayes_factor(reading(30, 10), kPlace, 10.1), 0);
  // Nor when the vehicle has driven on since.
  const GeoPoint ahead = reading(8, 10.5).position;
  EXPECT_EQ(evidence.log_bayes_factor(reading(30, 10), ahead, 10.5), 0);
}

// Errors are correlated: two fixes within a second are hardly independent.
TEST(GnssLikelihood, ReadingsCountAsFarAsTheyAreIndependent) {
  GnssLikelihood evidence(kSettings);
  const double once = evidence.log_bayes_factor(reading(30, 10), kPlace, 10);
  const double tenth = kSettings.correlation_s / 10;
  EXPECT_NEAR(evidence.log_bayes_factor(reading(30, 10 + tenth), kPlace, 10 + tenth), once / 10,
              1e-9);
  EXPECT_NEAR(evidence.log_bayes_factor(reading(30, 100), kPlace, 100), once, 1e-9);
}

TEST(GnssLikelihood, AnOldReadingSaysLess) {
  GnssLikelihood evidence(kSettings);
  EXPECT_GT(evidence.log_bayes_factor(reading(30, 10), kPlace, 12), first(30));
}

}  // namespace
}  // namespace milepost
