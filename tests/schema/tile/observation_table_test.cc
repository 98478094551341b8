// Tiles of observations: the round trip, and tables that each violate one paragraph of FORMAT.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "schema/tile/codec.h"
#include "schema/tile/observation_tile_generated.h"
#include "schema/tile/table.h"
#include "schema/tile/zstd_frame.h"
#include "tests/schema/tile/hostile_table.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

using testing::kInfinity;
using testing::kNan;

// The arrays of a valid table of two tracklets, with three and with four observations.
struct Table {
  std::string segment = "s";
  int model = 0;
  double origin_m = 50;
  std::uint16_t descriptor_bytes = 128;
  std::vector<float> offset_m = {30, 40};
  std::vector<float> slope = {100, 200};
  std::vector<float> r_squared = {0.9F, 1};
  std::vector<float> residual_sigma_m = {0, 0.1F};
  std::vector<std::uint16_t> observations = {3, 4};
  std::vector<std::uint8_t> descriptors = std::vector<std::uint8_t>(7 * 128, 7);
  std::vector<float> along_m = {0, 2, 4, 1, 3, 5, 7};
  std::vector<float> scale_px = {2, 3, 4, 3, 4, 5, 6};
  std::vector<std::uint16_t> x_px = {10, 11, 12, 20, 21, 22, 23};
  std::vector<std::uint16_t> y_px = {30, 31, 32, 40, 41, 42, 43};
};

Bytes bytes_of(const Table& t, const char* identifier = "MPO1") {
  flatbuffers::FlatBufferBuilder builder;
  const auto root = fbs::CreateObservationTileDirect(
      builder, t.segment.c_str(), 12, static_cast<fbs::ScaleModel>(t.model), t.origin_m,
      t.descriptor_bytes, &t.offset_m, &t.slope, &t.r_squared, &t.residual_sigma_m, &t.observations,
      &t.descriptors, &t.along_m, &t.scale_px, &t.x_px, &t.y_px);
  return testing::content_of(builder, root, identifier);
}

std::string message(const Bytes& content) {
  return testing::message_of(content, decode_observations);
}

TEST(ObservationTable, TheSoundOneIsTaken) {
  const auto tile = decode_observations(compress_frame(bytes_of({})));
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_EQ(tile->segment, "s");
  EXPECT_EQ(tile->index, 12U);
  EXPECT_EQ(tile->model, ScaleModel::scale);
  ASSERT_EQ(tile->tracklets.size(), 2U);
  const ObservedTracklet& second = tile->tracklets[1];
  ASSERT_EQ(second.track.size(), 4U);
  EXPECT_EQ(second.track[0].along_m, 51);
  EXPECT_EQ(second.track[3].feature.x_px, 23);
  EXPECT_EQ(second.tracklet.offset_m, 90);
  EXPECT_EQ(second.tracklet.observations, 4);
  EXPECT_EQ(second.tracklet.along.to_m, 57);
  EXPECT_EQ(second.tracklet.scale_max_px, 6);
  EXPECT_EQ(second.tracklet.pixels.y_min_px, 40);
}

ObservationTile random_tile(double from_m) {
  std::mt19937 random(7);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  ObservationTile tile{"a-long-road", 9, ScaleModel::inverse_scale, {}};
  for (int i = 0; i < 40; ++i) {
    ObservedTracklet t;
    t.tracklet.offset_m = from_m + uniform(50, 800);
    t.tracklet.slope = uniform(5, 3000);
    t.tracklet.r_squared = static_cast<float>(uniform(0.8, 1));
    t.tracklet.residual_sigma_m = static_cast<float>(uniform(0, 0.3));
    double along_m = from_m + uniform(0, 20);
    for (int m = 0; m < 3 + i % 5; ++m) {
      Observation o;
      o.along_m = along_m += uniform(0.5, 3);
      o.feature = {static_cast<float>(uniform(0, 600)), static_cast<float>(uniform(0, 500)),
                   static_cast<float>(uniform(1.5, 10))};
      for (auto& byte : o.descriptor) byte = static_cast<std::uint8_t>(uniform(0, 255));
      t.track.push_back(o);
    }
    set_from_track(t.track, t.tracklet);
    tile.tracklets.push_back(std::move(t));
  }
  return tile;
}

TEST(ObservationTable, KeepsEveryObservation) {
  const ObservationTile tile = random_tile(100000.123456789);
  const auto decoded = decode_observations(encode_observations(tile));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_EQ(decoded->model, tile.model);
  ASSERT_EQ(decoded->tracklets.size(), tile.tracklets.size());
  for (std::size_t i = 0; i < tile.tracklets.size(); ++i) {
    const ObservedTracklet& was = tile.tracklets[i];
    const ObservedTracklet& is = decoded->tracklets[i];
    EXPECT_EQ(is.tracklet.descriptor, was.tracklet.descriptor);
    EXPECT_EQ(is.tracklet.r_squared, was.tracklet.r_squared);
    EXPECT_EQ(is.tracklet.residual_sigma_m, was.tracklet.residual_sigma_m);
    EXPECT_NEAR(is.tracklet.along_estimate_m(tile.model, 4),
                was.tracklet.along_estimate_m(tile.model, 4), 1e-3);
    ASSERT_EQ(is.track.size(), was.track.size());
    for (std::size_t m = 0; m < was.track.size(); ++m) {
      EXPECT_EQ(is.track[m].descriptor, was.track[m].descriptor);
      EXPECT_EQ(is.track[m].feature.scale_px, was.track[m].feature.scale_px);
      EXPECT_NEAR(is.track[m].feature.x_px, was.track[m].feature.x_px, 0.5);
      EXPECT_NEAR(is.track[m].feature.y_px, was.track[m].feature.y_px, 0.5);
      EXPECT_NEAR(is.track[m].along_m, was.track[m].along_m, 1e-5);
    }
  }
  EXPECT_EQ(encode_observations(tile), encode_observations(tile));
}

TEST(ObservationTable, TakesATileWithoutTracklets) {
  const auto decoded = decode_observations(encode_observations({"s", 4, ScaleModel::scale, {}}));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_TRUE(decoded->tracklets.empty());
}

using Violation = testing::Violation<Table>;

class ObservationViolation : public ::testing::TestWithParam<Violation> {};

TEST_P(ObservationViolation, IsNamedWithItsParagraph) {
  Table table;
  GetParam().make(table);
  EXPECT_THAT(message(bytes_of(table)), HasSubstr(GetParam().message));
}

const char* const kSum = "the length of scale_px is not the sum of observations (FORMAT.md 4.4)";
const char* const kDescriptors =
    "the length of descriptors is not 128 times that of scale_px (FORMAT.md 4.4)";
const char* const kScale = "tracklet 1: a scale is not finite and above 0 (FORMAT.md 4.5)";
const char* const kAlong = "tracklet 1: along_m of an observation is out of range (FORMAT.md 4.5)";

const std::vector<Violation> kViolations = testing::with_broken_heads<Table>({
    {"UnknownModel", [](Table& t) { t.model = 2; }, "the scale model is unknown (FORMAT.md 3.4)"},
    {"ShortOffset", [](Table& t) { t.offset_m.pop_back(); },
     "tile s/12: the length of offset_m is not that of slope (FORMAT.md 4.3)"},
    {"ShortRSquared", [](Table& t) { t.r_squared.pop_back(); }, "the length of r_squared is not"},
    {"ShortSigma", [](Table& t) { t.residual_sigma_m.pop_back(); },
     "the length of residual_sigma_m is not"},
    {"ShortCounts", [](Table& t) { t.observations.pop_back(); },
     "the length of observations is not that of slope (FORMAT.md 4.3)"},
    {"DescriptorBytes", [](Table& t) { t.descriptor_bytes = 64; },
     "a descriptor does not have 128 bytes (FORMAT.md 4.4)"},
    {"TooManyCounted", [](Table& t) { t.observations[0] = 4; }, kSum},
    {"TooFewCounted", [](Table& t) { t.observations[1] = 3; }, kSum},
    {"ShortScale", [](Table& t) { t.scale_px.pop_back(); }, kSum},
    {"ShortDescriptors", [](Table& t) { t.descriptors.pop_back(); }, kDescriptors},
    {"LongDescriptors", [](Table& t) { t.descriptors.push_back(0); }, kDescriptors},
    {"ShortAlong", [](Table& t) { t.along_m.pop_back(); },
     "the length of along_m is not that of scale_px (FORMAT.md 4.4)"},
    {"ShortX", [](Table& t) { t.x_px.pop_back(); }, "the length of x_px is not"},
    {"LongY", [](Table& t) { t.y_px.push_back(1); }, "the length of y_px is not"},
    {"TwoObservations",
     [](Table& t) {
       t.observations = {2, 5};
     },
     "tracklet 0: fewer than 3 observations (FORMAT.md 4.3)"},
    {"ZeroScale", [](Table& t) { t.scale_px[4] = 0; }, kScale},
    {"NanScale", [](Table& t) { t.scale_px[4] = kNan; }, kScale},
    {"InfiniteScale", [](Table& t) { t.scale_px[4] = kInfinity; }, kScale},
    {"NanAlong", [](Table& t) { t.along_m[4] = kNan; }, kAlong},
    {"FarAlong", [](Table& t) { t.along_m[6] = 2e8F; }, kAlong},
    {"AlongOrder", [](Table& t) { t.along_m[4] = 1; },
     "tracklet 1: along_m of the observations does not ascend (FORMAT.md 4.5)"},
    {"NanOffset", [](Table& t) { t.offset_m[1] = kNan; }, "(FORMAT.md 3.6)"},
    {"ZeroSlope", [](Table& t) { t.slope[1] = 0; }, "(FORMAT.md 3.6)"},
    {"LargeRSquared", [](Table& t) { t.r_squared[0] = 1.01F; }, "(FORMAT.md 3.10)"},
    {"NegativeSigma", [](Table& t) { t.residual_sigma_m[0] = -0.1F; }, "(FORMAT.md 3.10)"},
});

INSTANTIATE_TEST_SUITE_P(Each, ObservationViolation, ::testing::ValuesIn(kViolations),
                         testing::name_of<Table>);

TEST(ObservationTable, HoldsAtMost65536Tracklets) {
  Table table;
  table.slope.assign(kMaxTrackletsPerTile + 1, 1);
  EXPECT_THAT(message(bytes_of(table)), HasSubstr("more than 65536 tracklets (FORMAT.md 4.3)"));
}

TEST(ObservationTable, ATileOfTrackletsIsNone) {
  EXPECT_THAT(message(bytes_of({}, "MPT1")), HasSubstr("identifier MPO1 (FORMAT.md 4.2)"));
}

TEST(ObservationTable, EveryTruncationIsRefused) {
  testing::expect_truncations_refused(bytes_of({}), observations_from_table);
}

TEST(ObservationTable, DamagedBytesNeverDoHarm) {
  testing::expect_damage_harmless(bytes_of({}), observations_from_table, table_from_observations);
}

}  // namespace
}  // namespace milepost
