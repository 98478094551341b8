#include "client/evaluate/baselines/matching.h"

#include <gtest/gtest.h>

#include <random>

#include "schema/tile/codec.h"
#include "tests/client/fetch/held_segment.h"

namespace milepost {
namespace {

constexpr AlongRange kRoad = {0, 100};

// A feature of fixed size at 40 m, observed from 10, 12, ... 20 m: scale = 90 / distance. Each
// observation has its own descriptor, at some distance from the next one's.
ObservedTracklet approached(std::mt19937& random) {
  std::uniform_int_distribution<int> byte(40, 200);
  Descriptor descriptor;
  for (auto& value : descriptor) value = static_cast<std::uint8_t>(byte(random));
  ObservedTracklet t;
  for (int m = 0; m < 6; ++m) {
    const double along_m = 10 + 2 * m;
    for (auto& value : descriptor) value = static_cast<std::uint8_t>(value + byte(random) % 9 - 4);
    t.track.push_back({{100, 100, static_cast<float>(90 / (40 - along_m))}, descriptor, along_m});
  }
  set_from_track(t.track, t.tracklet);
  t.tracklet.offset_m = 40;
  t.tracklet.slope = 90;
  t.tracklet.r_squared = 1;
  return t;
}

class Matching : public ::testing::Test {
 protected:
  Matching() {
    std::mt19937 random(5);
    ObservationTile observed{"s", 0, ScaleModel::inverse_scale, {}};
    TrackletTile averaged{"s", 0, ScaleModel::inverse_scale, {}};
    for (int i = 0; i < 20; ++i) {
      observed.tracklets.push_back(approached(random));
      averaged.tracklets.push_back(observed.tracklets.back().tracklet);
    }
    tracks_ = observed.tracklets;
    observed_ = window_of(*decode_tile_of(LayerItems::observations, encode_observations(observed)));
    averaged_ = window_of(*decode_tile_of(LayerItems::tracklets, encode_tile(averaged)));
  }

  static std::unique_ptr<TrackletWindow> window_of(DecodedTile tile) {
    const SegmentKey key = {{}, "s"};
    const auto line = *RouteLine::from_vertices({{49, 8.4, 0}, {49.001, 8.4, 0}});
    const std::vector<testing::IndexedTile> tiles = {{{10, 20}, std::move(tile)}};
    const HeldMap held = testing::held_map(testing::layer_of(key, line, {}, tiles), tiles);
    auto window = std::make_unique<TrackletWindow>(key, WindowSettings{});
    EXPECT_TRUE(window->cover(held, kRoad).complete);
    return window;
  }

  // Tracklet 7's feature as observed from `along_m`, with the descriptor of an observation.
  FeatureSet observe(double along_m, std::size_t observation) const {
    FeatureSet query;
    query.features.push_back({100, 100, static_cast<float>(90 / (40 - along_m))});
    query.descriptors.push_back(tracks_[7].track[observation].descriptor);
    return query;
  }

  std::vector<ObservedTracklet> tracks_;
  std::unique_ptr<TrackletWindow> observed_;
  std::unique_ptr<TrackletWindow> averaged_;
};

TEST_F(Matching, RegressesBetweenTheFrames) {  // Eq. 3
  for (const TrackletWindow* window : {averaged_.get(), observed_.get()}) {
    const auto matches = match_tracklets(observe(13.3, 2), 1, 600, *window, kRoad, {});
    ASSERT_EQ(matches.size(), 1U);
    EXPECT_EQ(matches[0].tracklet, 7U);
    EXPECT_NEAR(matches[0].estimate.along_m, 13.3, 1e-4);
  }
}

TEST_F(Matching, TheClosestObservationIsWhereItsFrameWas) {  // section 5.2, comparative method 3
  MatchSettings settings;
  settings.estimation = Estimation::closest_observation;
  settings.neighbours = 20;
  for (const auto& [along_m, frame_m] : {std::pair(13.3, 14), std::pair(12.7, 12), {19.4, 20}}) {
    const auto matches = match_tracklets(observe(along_m, 2), 1, 600, *observed_, kRoad, settings);
    ASSERT_EQ(matches.size(), 1U) << along_m;
    EXPECT_NEAR(matches[0].estimate.along_m, frame_m, 1e-4);
    EXPECT_NEAR(matches[0].estimate.sigma_m, 2, 1e-4);  // the spacing of the frames
  }
}

TEST_F(Matching, DescriptorsOfOneTrackletDoNotCompete) {
  FeatureSet query = observe(13, 2);
  for (std::size_t k = 0; k < 64; ++k) {  // half from one observation, half from the next one
    query.descriptors[0][k] = tracks_[7].track[3].descriptor[k];
  }
  MatchSettings settings;
  settings.neighbours = 20;  // more than the tracklet has
  EXPECT_EQ(match_tracklets(query, 1, 600, *observed_, kRoad, settings).size(), 1U);
  settings.neighbours = 2;  // others that were not examined may be as near as the second
  EXPECT_TRUE(match_tracklets(query, 1, 600, *observed_, kRoad, settings).empty());
}

TEST_F(Matching, AScaleOutsideTheTrackletsRangeIsNoMatch) {  // section 4.2.2
  EXPECT_TRUE(match_tracklets(observe(25, 2), 1, 600, *averaged_, kRoad, {}).empty());
  EXPECT_EQ(match_tracklets(observe(25, 2), 0.7, 600, *averaged_, kRoad, {}).size(), 1U);
}

TEST_F(Matching, ATrackletElsewhereIsNoMatch) {
  EXPECT_TRUE(match_tracklets(observe(13, 2), 1, 600, *averaged_, {30, 60}, {}).empty());
}

}  // namespace
}  // namespace milepost
