#include "client/localize/landmark_support.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/client/localize/landmark_road.h"
#include "tests/client/localize/landmark_scene.h"

namespace milepost {
namespace {

using testing::kSceneCamera;
using testing::LandmarkScene;

constexpr Camera kImage = {620, 380, kSceneCamera};
constexpr AlongRange kMapped = {0, 10};  // where all landmarks were seen from
constexpr double kAlongM = 5;

// Matches with a share of wrong ones, the others with residuals of this standard deviation.
LandmarkSupport support(double expected, double found, double sigmas, double wrong = 0) {
  constexpr double kCutoff = 4;
  LandmarkSupport made{.expected = expected, .found = found};
  const auto within = [&](double up_to) {
    const auto rayleigh = [&](double r) { return 1 - std::exp(-r * r / (2 * sigmas * sigmas)); };
    return (1 - wrong) * rayleigh(up_to) / rayleigh(kCutoff) +
           wrong * up_to * up_to / (kCutoff * kCutoff);
  };
  const double bin = kCutoff / static_cast<double>(made.by_residual.size());
  for (std::size_t i = 0; i < made.by_residual.size(); ++i) {
    const double from = static_cast<double>(i) * bin;
    made.by_residual[i] = found * (within(from + bin) - within(from));
  }
  return made;
}

TEST(LogBayesFactor, NothingExpectedIsNeutral) {
  EXPECT_NEAR(log_bayes_factor(support(0, 0, 1)), 0, 1e-9);
}

TEST(LogBayesFactor, MostFoundInTheirPlacesIsInFavour) {
  EXPECT_GT(log_bayes_factor(support(30, 25, 0.4)), 15);
  EXPECT_GT(log_bayes_factor(support(30, 12, 1)), 1);  // out of focus
}

// In other light a part of the matches is wrong, and the others are as exact as ever.
TEST(LogBayesFactor, WrongMatchesAmongExactOnesDoNotSpeakAgainst) {
  EXPECT_GT(log_bayes_factor(support(38, 18, 0.5, 0.4)), 4);
  EXPECT_LT(log_bayes_factor(support(38, 18, 1, 0.6)), log_bayes_factor(support(38, 18, 0.5, 0.4)));
}

TEST(LogBayesFactor, FewFoundIsAgainst) {
  EXPECT_LT(log_bayes_factor(support(30, 1.2, 2)), -2);
  EXPECT_LT(log_bayes_factor(support(30, 0, 1)), -3);
}

TEST(LogBayesFactor, FoundWithLargeResidualsIsAgainst) {
  EXPECT_GT(log_bayes_factor(support(30, 8, 0.5)), 1);
  EXPECT_LT(log_bayes_factor(support(30, 8, 2, 0.5)), -1);
}

TEST(LogBayesFactor, MoreCellsCountMore) {
  EXPECT_GT(log_bayes_factor(support(40, 32, 0.4)), 2 * log_bayes_factor(support(10, 8, 0.4)));
}

class SupportOf : public ::testing::Test {
 protected:
  SupportOf() {
    for (LocalLandmark& landmark : scene_.landmarks) landmark.along = kMapped;
    for (std::size_t i = 0; i < scene_.features.size(); ++i) {
      const Feature& feature = scene_.features[i];
      const bool inside = feature.x_px > 10 && feature.x_px < kImage.width_px - 10 &&
                          feature.y_px > 10 && feature.y_px < kImage.height_px - 10;
      if (inside) inside_.push_back({i, i});
    }
  }

  // The support of the given matches in a frame with the features of the scene.
  LandmarkSupport support(const std::vector<LandmarkMatch>& found, double along_m = kAlongM) const {
    const FeatureSet set{scene_.features, std::vector<Descriptor>(scene_.features.size())};
    const CompactFrame frame(set, projection_);
    const PoseSolver solver(kSceneCamera, frame.features, scene_.landmarks, {});
    const PoseEstimate estimate{LandmarkScene::belief(scene_.state(), 0.1, 0.1), found};
    return support_of(estimate, along_m, frame, scene_.landmarks, solver, kImage, {});
  }

  LandmarkScene scene_{200};
  std::vector<LandmarkMatch> inside_;  // of the image
  PcaProjection projection_ = PcaProjection::trained(testing::unlike_descriptors(100, 1), 0.02);
};

TEST_F(SupportOf, AllFoundInTheirPlaces) {
  const LandmarkSupport all = support(inside_);
  EXPECT_NEAR(all.landmarks_expected, static_cast<double>(inside_.size()), 10);  // at the border
  EXPECT_GT(all.landmarks_found, 0.95 * all.landmarks_expected);
  EXPECT_GT(all.found, 0.95 * all.expected);
  EXPECT_GT(all.expected, 20);
  EXPECT_LT(all.expected, 100);  // cells, not landmarks
  EXPECT_NEAR(all.by_residual.front(), all.found, 1e-9);
}

TEST_F(SupportOf, NothingFound) {
  const LandmarkSupport none = support({});
  EXPECT_GT(none.expected, 20);
  EXPECT_EQ(none.found, 0);
  EXPECT_THAT(none.by_residual, ::testing::Each(0));
}

TEST_F(SupportOf, HalfOfThemFound) {
  std::vector<LandmarkMatch> half;
  for (std::size_t i = 0; i < inside_.size(); i += 2) half.push_back(inside_[i]);
  const LandmarkSupport found = support(half);
  EXPECT_NEAR(found.found / found.expected, 0.5, 0.15);
}

TEST_F(SupportOf, OnlyLandmarksMappedHereAreExpected) {
  EXPECT_EQ(support(inside_, 50).expected, 0);
}

TEST_F(SupportOf, LandmarksOfOneFacadeCountAsOne) {
  for (LocalLandmark& landmark : scene_.landmarks) landmark = scene_.landmarks[inside_[0].landmark];
  const LandmarkSupport crowded = support({inside_[0]});
  EXPECT_EQ(crowded.landmarks_expected, 200);
  EXPECT_EQ(crowded.expected, 1);
  EXPECT_DOUBLE_EQ(crowded.found, 1.0 / 200);
}

TEST_F(SupportOf, WithoutTextureNothingIsMissed) {
  scene_.features.clear();
  EXPECT_EQ(support({}).expected, 0);
}

}  // namespace
}  // namespace milepost
