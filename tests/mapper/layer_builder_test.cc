#include "mapper/build/layer_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "schema/tile/codec.h"

namespace milepost {
namespace {

constexpr double kEnd = std::numeric_limits<double>::infinity();

// A feature of fixed size, approached from `start_m`: s = 120 / distance.
Track approached_feature(double feature_along_m, double start_m, std::size_t frames) {
  Track track;
  for (std::size_t m = 0; m < frames; ++m) {
    Observation o;
    o.along_m = start_m + 2 * static_cast<double>(m);
    o.feature = {static_cast<float>(300 + m), 200,
                 static_cast<float>(120 / (feature_along_m - o.along_m))};
    o.descriptor.fill(static_cast<std::uint8_t>(10 * (m + 1)));
    track.push_back(o);
  }
  return track;
}

TEST(LayerBuilder, TheLaboratorysLayersHoldTheSameTracklets) {
  const RegressionSettings published = {ScaleModel::scale, 0.8};
  const auto averaged = make_layer_builder({"a", LayerItems::tracklets, published}, "s", 20);
  const auto observed = make_layer_builder({"o", LayerItems::observations, published}, "s", 20);
  std::vector<Track> tracks = {approached_feature(80, 22, 4), approached_feature(60, 20, 6)};
  tracks.push_back(approached_feature(60, 20, 3));
  tracks.back()[1].feature.scale_px = 90;  // no line fits: in neither layer
  for (const auto& builder : {averaged.get(), observed.get()}) builder->add(tracks);

  const auto of_averaged = averaged->take_complete(kEnd);
  const auto of_observed = observed->take_complete(kEnd);
  ASSERT_TRUE(of_averaged.ok() && of_observed.ok());
  ASSERT_EQ(of_averaged->size(), 1U);
  ASSERT_EQ(of_observed->size(), 1U);
  EXPECT_EQ(of_observed->front().index, 1U);
  EXPECT_EQ(of_observed->front().items, 2U);
  EXPECT_EQ(of_observed->front().along.from_m, of_averaged->front().along.from_m);
  EXPECT_EQ(of_observed->front().along.to_m, of_averaged->front().along.to_m);
  const auto tracklets = decode_tile(of_averaged->front().frame);
  const auto observations = decode_observations(of_observed->front().frame);
  ASSERT_TRUE(tracklets.ok() && observations.ok());
  ASSERT_EQ(observations->tracklets.size(), tracklets->tracklets.size());
  for (std::size_t i = 0; i < tracklets->tracklets.size(); ++i) {
    const Tracklet& a = tracklets->tracklets[i];
    const Tracklet& o = observations->tracklets[i].tracklet;
    EXPECT_EQ(o.descriptor, a.descriptor);
    EXPECT_EQ(o.offset_m, a.offset_m);
    EXPECT_EQ(o.slope, a.slope);
    EXPECT_EQ(o.along.to_m, a.along.to_m);
    EXPECT_EQ(o.scale_max_px, a.scale_max_px);
    EXPECT_EQ(observations->tracklets[i].track.size(), a.observations);
  }
}

TEST(LayerBuilder, RefusesATileThatNoReaderWouldTake) {
  const auto builder = make_layer_builder({"o", LayerItems::observations, {}}, "s", 20);
  builder->add(std::vector<Track>(4000, approached_feature(300, 0, 40)));  // 20 MB of descriptors
  const auto tiles = builder->take_complete(kEnd);
  ASSERT_FALSE(tiles.ok());
  EXPECT_EQ(tiles.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(tiles.error().line(), testing::HasSubstr("16 MiB"));
  EXPECT_THAT(tiles.error().line(), testing::HasSubstr("--tile-length-m"));
}

}  // namespace
}  // namespace milepost
