#include "mapper/pipeline/layer_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "schema/tile/codec.h"

namespace milepost {
namespace {

constexpr double kLayerEnd = std::numeric_limits<double>::infinity();

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

RouteLine straight_line() {
  return RouteLine::from_vertices({{49, 8.4, 110}, {49.001, 8.4, 110}}).value();
}

// A segment `s` in tiles of 20 m.
std::unique_ptr<LayerBuilder> builder_of(const Layer& layer) {
  static const RouteLine line = straight_line();
  static const PcaProjection projection = PcaProjection::trained({}, 0.02);
  static const std::vector<SegmentCut> segments = {{"s", {0, line.length_m()}, line}};
  static const StretchContext context{{}, segments, projection, 20};
  return make_layer_builder(layer, context);
}

TEST(LayerBuilder, TheLaboratorysLayersHoldTheSameTracklets) {
  const RegressionSettings published = {ScaleModel::scale, 0.8};
  const auto averaged = builder_of({"a", LayerItems::tracklets, published, {}, {}});
  const auto observed = builder_of({"o", LayerItems::observations, published, {}, {}});
  std::vector<Track> tracks = {approached_feature(80, 22, 4), approached_feature(60, 20, 6)};
  tracks.push_back(approached_feature(60, 20, 3));
  tracks.back()[1].feature.scale_px = 90;  // no line fits: in neither layer
  for (const auto& builder : {averaged.get(), observed.get()}) builder->add_tracks(tracks);

  const auto of_averaged = averaged->take_complete(kLayerEnd);
  const auto of_observed = observed->take_complete(kLayerEnd);
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
  EXPECT_EQ(tracklets->segment, "s");
  EXPECT_EQ(observations->segment, "s");
  EXPECT_EQ(tracklets->model, ScaleModel::scale);
  EXPECT_EQ(observations->model, ScaleModel::scale);
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

TEST(LayerBuilder, FramesKeepWhatTheirLayerIsFor) {
  ExtractedFrame frame;
  frame.features.features.push_back({10, 20, 3});
  frame.features.descriptors.resize(1);
  frame.image[7] = 0.5F;
  const auto features = builder_of({"f", LayerItems::frames, {}, {.features = true}, {}});
  const auto images = builder_of({"w", LayerItems::frames, {}, {.image = true}, {}});
  for (const auto& builder : {features.get(), images.get()}) {
    for (const double along_m : {0.0, 19.0, 21.0}) builder->add_frame({}, frame, along_m);
  }
  const auto of_features = features->take_complete(20);
  ASSERT_TRUE(of_features.ok());
  ASSERT_EQ(of_features->size(), 1U);
  EXPECT_EQ(of_features->front().items, 2U);
  EXPECT_EQ(of_features->front().along.to_m, 19);
  const auto featured = decode_frames(of_features->front().frame);
  ASSERT_TRUE(featured.ok());
  EXPECT_EQ(featured->segment, "s");
  EXPECT_EQ(featured->frames[1].along_m, 19);
  EXPECT_EQ(featured->frames[1].features.features[0].scale_px, 3);
  EXPECT_FALSE(featured->frames[1].image.has_value());
  const auto of_images = images->take_complete(kLayerEnd);
  ASSERT_TRUE(of_images.ok());
  ASSERT_EQ(of_images->size(), 2U);
  const auto imaged = decode_frames(of_images->at(1).frame);
  ASSERT_TRUE(imaged.ok());
  EXPECT_EQ(imaged->frames[0].image, frame.image);
  EXPECT_EQ(imaged->frames[0].features.size(), 0U);
}

TEST(LayerBuilder, RefusesATileThatNoReaderWouldTake) {
  const auto builder = builder_of({"o", LayerItems::observations, {}, {}, {}});
  builder->add_tracks(
      std::vector<Track>(4000, approached_feature(300, 0, 40)));  // 20 MB of descriptors
  const auto tiles = builder->take_complete(kLayerEnd);
  ASSERT_FALSE(tiles.ok());
  EXPECT_EQ(tiles.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(tiles.error().line(), ::testing::HasSubstr("16 MiB"));
  EXPECT_THAT(tiles.error().line(), ::testing::HasSubstr("--tile-length-m"));
}

}  // namespace
}  // namespace milepost
