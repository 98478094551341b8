#include "client/localize/landmark_matching.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/client/localize/landmark_road.h"
#include "tests/client/localize/landmark_scene.h"

namespace milepost {

bool operator==(const LandmarkMatch& a, const LandmarkMatch& b) {
  return a.feature == b.feature && a.landmark == b.landmark;
}

namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::kSceneCamera;

constexpr double kStep = 0.01;

// Eight dissimilar descriptors, and a codebook that removes nothing of them.
const std::vector<Descriptor>& unlike() {
  static const auto descriptors = testing::unlike_descriptors(8, 5);
  return descriptors;
}

const PcaProjection& projection() {
  static const PcaProjection trained = PcaProjection::trained(unlike(), kStep);
  return trained;
}

// A descriptor between unlike()[a] and unlike()[b].
Descriptor between(std::size_t a, std::size_t b, double part) {
  Descriptor mixed{};
  for (std::size_t d = 0; d < mixed.size(); ++d) {
    mixed[d] =
        static_cast<std::uint8_t>(std::lround((1 - part) * unlike()[a][d] + part * unlike()[b][d]));
  }
  return mixed;
}

double distance(const Descriptor& a, const Descriptor& b) {
  return kStep * std::sqrt(distance_squared(projection().compact(a), projection().compact(b)));
}

// At equal distances from unlike()[0] and unlike()[1].
Descriptor halfway() {
  double part = 0;
  const auto nearer_to_first = [&] {
    const Descriptor mixed = between(0, 1, part);
    return distance(mixed, unlike()[0]) < distance(mixed, unlike()[1]);
  };
  while (nearer_to_first()) part += 0.005;
  return between(0, 1, part);
}

// A descriptor at this distance from unlike()[0].
Descriptor at_distance(double wanted) {
  double part = 0;
  while (distance(between(0, 1, part), unlike()[0]) < wanted) part += 0.001;
  return between(0, 1, part);
}

LocalLandmark landmark(const Descriptor& descriptor, const Eigen::Vector3d& enu_m,
                       const AlongRange& along = {0, 10}) {
  LocalLandmark landmark = testing::landmark_at(enu_m);
  landmark.descriptor = projection().compact(descriptor);
  landmark.along = along;
  return landmark;
}

class MatchGlobal : public ::testing::Test {
 protected:
  std::vector<LandmarkMatch> matches(const std::vector<Descriptor>& seen,
                                     const AlongRange& region = {0, 10}) const {
    const FeatureSet set{std::vector<Feature>(seen.size(), Feature{100, 100, 10}), seen};
    const CompactFrame frame(set, projection());
    return match_global(frame, projection().quantization_step(), landmarks_, region, {});
  }

  std::vector<LocalLandmark> landmarks_;
};

TEST_F(MatchGlobal, EachFeatureIsTheNearestLandmark) {
  for (std::size_t i = 0; i < 4; ++i) {
    landmarks_.push_back(landmark(unlike()[i], {10.0 * static_cast<double>(i), 20, 0}));
  }
  EXPECT_THAT(matches({unlike()[2], between(0, 5, 0.1), unlike()[3], unlike()[2]}),
              ElementsAre(LandmarkMatch{0, 2}, LandmarkMatch{1, 0}, LandmarkMatch{2, 3},
                          LandmarkMatch{3, 2}));
}

TEST_F(MatchGlobal, WhatIsUnlikeAllIsNone) {
  landmarks_ = {landmark(unlike()[0], {0, 20, 0})};
  ASSERT_GT(distance(unlike()[1], unlike()[0]), LandmarkMatchSettings().max_distance);
  EXPECT_THAT(matches({unlike()[1]}), IsEmpty());
  EXPECT_THAT(matches({unlike()[0]}), ElementsAre(LandmarkMatch{0, 0}));
}

TEST_F(MatchGlobal, WhatResemblesTwoPlacesIsNeither) {
  landmarks_ = {landmark(unlike()[0], {0, 20, 0}), landmark(unlike()[1], {5, 20, 0})};
  EXPECT_THAT(matches({halfway()}), IsEmpty());
  EXPECT_THAT(matches({between(0, 1, 0.1)}), ElementsAre(LandmarkMatch{0, 0}));
  EXPECT_THAT(matches({between(0, 1, 0.9)}), ElementsAre(LandmarkMatch{0, 1}));
}

TEST_F(MatchGlobal, TheNearestMustBeNearerByTheRatio) {
  const LandmarkMatchSettings settings;
  const double second = 0.8 * settings.max_distance;
  for (const double off : {-0.03, 0.03}) {
    const double nearest = (settings.max_distance_ratio + off) * second;
    landmarks_ = {landmark(at_distance(nearest), {0, 20, 0}),
                  landmark(at_distance(second), {5, 20, 0})};
    EXPECT_EQ(matches({unlike()[0]}).size(), off < 0 ? 1U : 0U) << off;
  }
}

TEST_F(MatchGlobal, LandmarksAtOnePlaceDoNotCountAgainstEachOther) {
  const double same_place_m = LandmarkMatchSettings().same_place_m;
  landmarks_ = {landmark(unlike()[0], {0, 20, 0}),
                landmark(unlike()[1], {0.9 * same_place_m, 20, 0})};
  EXPECT_EQ(matches({halfway()}).size(), 1U);
  landmarks_[1].enu_m.x() = 1.1 * same_place_m;
  EXPECT_EQ(matches({halfway()}).size(), 0U);
}

// The farther of two landmarks at one place is beyond the distance threshold, whichever comes
// first.
TEST_F(MatchGlobal, NorDoesOneThatIsTooFar) {
  const double max_distance = LandmarkMatchSettings().max_distance;
  const auto way_to = [&](double wanted) {  // the position between 1 and 0 at a distance from 0
    double part = 0;
    while (distance(between(1, 0, part), unlike()[0]) > wanted) part += 0.002;
    return between(1, 0, part);
  };
  landmarks_ = {landmark(way_to(1.03 * max_distance), {0, 20, 0}),
                landmark(way_to(0.98 * max_distance), {0.5, 20, 0})};
  EXPECT_THAT(matches({unlike()[0]}), ElementsAre(LandmarkMatch{0, 1}));
  std::swap(landmarks_[0], landmarks_[1]);
  EXPECT_THAT(matches({unlike()[0]}), ElementsAre(LandmarkMatch{0, 0}));
  landmarks_[1].enu_m.x() += 5;  // another place
  EXPECT_THAT(matches({unlike()[0]}), IsEmpty());
}

TEST_F(MatchGlobal, OnlyWhatWasMappedInTheRegion) {
  landmarks_ = {landmark(unlike()[0], {0, 20, 0}, {0, 10}),
                landmark(unlike()[0], {90, 20, 0}, {100, 110})};
  EXPECT_THAT(matches({unlike()[0]}, {104, 106}), ElementsAre(LandmarkMatch{0, 1}));
  const double margin_m = LandmarkMatchSettings().along_margin_m;
  EXPECT_THAT(matches({unlike()[0]}, {9.9 + margin_m, 20}), ElementsAre(LandmarkMatch{0, 0}));
  EXPECT_THAT(matches({unlike()[0]}, {10.1 + margin_m, 20}), IsEmpty());
}

// A camera at the origin that looks to the north, known to 1 cm.
class MatchGuided : public ::testing::Test {
 protected:
  static constexpr double kDepthM = 20;
  static constexpr double kScalePx = 0.2 * 510 / kDepthM;  // of a landmark of landmark_at()

  MatchGuided() { know_position_to(0.01); }

  void know_position_to(double sigma_m) {
    belief_.P.setZero();
    belief_.P.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() * sigma_m * sigma_m;
  }

  // A feature to the right of the middle of the image.
  void see(const Descriptor& descriptor, double right_px, double log_scale = 0) {
    set_.features.push_back({static_cast<float>(kSceneCamera.principal_x_px + right_px),
                             static_cast<float>(kSceneCamera.principal_y_px),
                             static_cast<float>(kScalePx * std::exp(log_scale))});
    set_.descriptors.push_back(descriptor);
  }

  // Observes nothing else.
  std::size_t matches_of(const Descriptor& descriptor, double right_px, double log_scale = 0) {
    set_ = {};
    see(descriptor, right_px, log_scale);
    return matches().size();
  }

  std::vector<LandmarkMatch> matches(const AlongRange& region = {0, 10}) const {
    const CompactFrame frame(set_, projection());
    return match_guided(frame, projection().quantization_step(), landmarks_, region, belief_,
                        kSceneCamera, settings_);
  }

  const Descriptor& it_ = unlike()[0];
  std::vector<LocalLandmark> landmarks_ = {landmark(it_, {0, kDepthM, 0})};
  PoseBelief belief_;
  LandmarkMatchSettings settings_;
  FeatureSet set_;
};

TEST_F(MatchGuided, InItsPlaceAsWellAsThatIsKnown) {
  EXPECT_EQ(matches_of(it_, settings_.min_gate_px - 1), 1U);
  EXPECT_EQ(matches_of(it_, settings_.min_gate_px + 1), 0U);
  know_position_to(0.2);  // in two directions, 5.2 px each: sqrt(2) * 3 * 5.1 px are 21.6
  EXPECT_EQ(matches_of(it_, 21), 1U);
  EXPECT_EQ(matches_of(it_, 22.5), 0U);
  know_position_to(10);
  EXPECT_EQ(matches_of(it_, settings_.max_gate_px - 1), 1U);
  EXPECT_EQ(matches_of(it_, settings_.max_gate_px + 1), 0U);
}

TEST_F(MatchGuided, AngleAndDepthWidenTheGate) {
  belief_.P(kHeading, kHeading) = std::pow(0.01, 2);  // 5.1 px
  EXPECT_EQ(matches_of(it_, 15), 1U);
  EXPECT_EQ(matches_of(it_, 16), 0U);
  belief_.P(kHeading, kHeading) = 0;
  landmarks_[0].depth_sigma_m = 0.2;  // along the mapping ray, where it has no effect
  EXPECT_EQ(matches_of(it_, 15), 0U);
  landmarks_[0].mapping_ray = {1, 0, 0};
  EXPECT_EQ(matches_of(it_, 15), 1U);
}

TEST_F(MatchGuided, AtItsScale) {
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(matches_of(it_, 0, sign * (settings_.max_log_scale - 0.02)), 1U);
    EXPECT_EQ(matches_of(it_, 0, sign * (settings_.max_log_scale + 0.02)), 0U);
  }
}

TEST_F(MatchGuided, OnlyWhatIsAlike) {
  EXPECT_EQ(matches_of(unlike()[1], 0), 0U);
  EXPECT_EQ(matches_of(between(0, 1, 0.1), 0), 1U);
}

TEST_F(MatchGuided, EachFeatureGoesToTheLandmarkThatIsMostAlike) {
  landmarks_ = {landmark(between(0, 1, 0.2), {0.05, kDepthM, 0}), landmark(it_, {0, kDepthM, 0}),
                landmark(between(0, 1, 0.1), {0, kDepthM, 0.05})};
  see(it_, 0);
  EXPECT_THAT(matches(), ElementsAre(LandmarkMatch{0, 1}));
}

TEST_F(MatchGuided, WhatMayBeEitherOfTwoFeaturesIsNeither) {
  know_position_to(0.2);
  see(between(0, 1, 0.10), -5);
  see(between(0, 1, 0.11), 5);
  EXPECT_THAT(matches(), IsEmpty());
  set_ = {};
  see(between(0, 1, 0.11), 0);  // both orientations of one point
  see(between(0, 1, 0.10), 1);
  EXPECT_THAT(matches(), ElementsAre(LandmarkMatch{1, 0}));
}

TEST_F(MatchGuided, TheNearestMustBeNearerByTheRatio) {
  know_position_to(0.2);
  const double second = 0.8 * settings_.max_distance;
  for (const double off : {-0.03, 0.03}) {
    set_ = {};
    see(at_distance((settings_.max_guided_ratio + off) * second), -5);
    see(at_distance(second), 5);
    EXPECT_EQ(matches().size(), off < 0 ? 1U : 0U) << off;
  }
}

TEST_F(MatchGuided, NothingIsExpectedBehindTheCamera) {
  landmarks_ = {landmark(it_, {0, -kDepthM, 0}), landmark(it_, {0, 0.2, 0})};
  know_position_to(10);
  EXPECT_EQ(matches_of(it_, 0), 0U);
}

TEST_F(MatchGuided, OnlyWhatWasMappedInTheRegion) {
  see(it_, 0);
  EXPECT_THAT(matches({9.9 + settings_.along_margin_m, 30}), ElementsAre(LandmarkMatch{0, 0}));
  EXPECT_THAT(matches({10.1 + settings_.along_margin_m, 30}), IsEmpty());
}

}  // namespace
}  // namespace milepost
