// Tables built by hand: well-formed FlatBuffers that each violate one paragraph of FORMAT.md.
#include "schema/tile/table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "schema/tile/codec.h"
#include "schema/tile/tile_generated.h"
#include "schema/tile/zstd_frame.h"
#include "tests/schema/tile/example_tile.h"
#include "tests/schema/tile/hostile_table.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

using testing::kInfinity;
using testing::kNan;

// The arrays of a valid table of two tracklets.
struct Table {
  std::string segment = "s";
  int model = 1;
  double origin_m = 50;
  std::uint16_t descriptor_bytes = 128;
  std::vector<std::uint8_t> descriptors = std::vector<std::uint8_t>(256, 7);
  std::vector<float> offset_m = {30, 40};
  std::vector<float> slope = {100, 200};
  std::vector<float> scale_min_px = {2, 3};
  std::vector<float> scale_max_px = {4, 6};
  std::vector<float> along_begin_m = {0, 1};
  std::vector<float> along_end_m = {8, 9};
  std::vector<std::uint16_t> x_min_px = {10, 20};
  std::vector<std::uint16_t> x_max_px = {11, 22};
  std::vector<std::uint16_t> y_min_px = {30, 40};
  std::vector<std::uint16_t> y_max_px = {33, 44};
  std::vector<float> r_squared = {0.9F, 1};
  std::vector<float> residual_sigma_m = {0, 0.1F};
  std::vector<std::uint16_t> observations = {3, 9};
};

Bytes bytes_of(const Table& t, const char* identifier = "MPT1") {
  flatbuffers::FlatBufferBuilder builder;
  const auto root = fbs::CreateTrackletTileDirect(
      builder, t.segment.c_str(), 12, static_cast<fbs::ScaleModel>(t.model), t.origin_m,
      t.descriptor_bytes, &t.descriptors, &t.offset_m, &t.slope, &t.scale_min_px, &t.scale_max_px,
      &t.along_begin_m, &t.along_end_m, &t.x_min_px, &t.x_max_px, &t.y_min_px, &t.y_max_px,
      &t.r_squared, &t.residual_sigma_m, &t.observations);
  return testing::content_of(builder, root, identifier);
}

std::string message(const Bytes& content) { return testing::message_of(content, decode_tile); }

TEST(Table, TheSoundOneIsTaken) {
  const auto tile = decode_tile(compress_frame(bytes_of({})));
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_EQ(tile->segment, "s");
  EXPECT_EQ(tile->index, 12U);
  ASSERT_EQ(tile->tracklets.size(), 2U);
  EXPECT_EQ(tile->tracklets[1].offset_m, 90);
  EXPECT_EQ(tile->tracklets[1].along.to_m, 59);
  EXPECT_EQ(tile->tracklets[1].pixels.y_max_px, 44);
}

using Violation = testing::Violation<Table>;

class TableViolation : public ::testing::TestWithParam<Violation> {};

TEST_P(TableViolation, IsNamedWithItsParagraph) {
  Table table;
  GetParam().make(table);
  EXPECT_THAT(message(bytes_of(table)), HasSubstr(GetParam().message));
}

const char* const kSlope =
    "tile s/12, tracklet 1: the slope is not finite and above 0 (FORMAT.md 3.6)";
const char* const kOffset = "tile s/12, tracklet 1: the offset is not finite (FORMAT.md 3.6)";
const char* const kScaleMin = "tracklet 0: the smallest scale is not above 0 (FORMAT.md 3.7)";
const char* const kScaleMax =
    "tracklet 0: the largest scale is not finite and at least the smallest (FORMAT.md 3.7)";
const char* const kAlong = "tracklet 1: the along range is out of range (FORMAT.md 3.8)";
const char* const kAlongOrder = "the along range ends before it begins (FORMAT.md 3.8)";
const char* const kPixels = "the pixel range ends before it begins (FORMAT.md 3.9)";
const char* const kRSquared = "tracklet 0: R squared is not in [0, 1] (FORMAT.md 3.10)";
const char* const kSigma = "the residual sigma is not finite and at least 0 (FORMAT.md 3.10)";

const std::vector<Violation> kViolations = testing::with_broken_heads<Table>({
    {"UnknownModel", [](Table& t) { t.model = 2; }, "the scale model is unknown (FORMAT.md 3.4)"},
    {"DescriptorBytes", [](Table& t) { t.descriptor_bytes = 64; },
     "tile s/12: a descriptor does not have 128 bytes (FORMAT.md 3.5)"},
    {"ShortDescriptors", [](Table& t) { t.descriptors.pop_back(); },
     "the length of descriptors is not 128 times that of slope (FORMAT.md 3.5)"},
    {"LongDescriptors", [](Table& t) { t.descriptors.push_back(0); },
     "the length of descriptors is not 128 times that of slope (FORMAT.md 3.5)"},
    {"ShortSlope", [](Table& t) { t.slope.pop_back(); },
     "the length of offset_m is not that of slope (FORMAT.md 3.5)"},
    {"ShortScaleMin", [](Table& t) { t.scale_min_px.pop_back(); },
     "the length of scale_min_px is not"},
    {"ShortScaleMax", [](Table& t) { t.scale_max_px.pop_back(); },
     "the length of scale_max_px is not"},
    {"ShortAlongBegin", [](Table& t) { t.along_begin_m.pop_back(); },
     "the length of along_begin_m is not"},
    {"LongAlongEnd", [](Table& t) { t.along_end_m.push_back(9); },
     "the length of along_end_m is not"},
    {"ShortXMin", [](Table& t) { t.x_min_px.pop_back(); }, "the length of x_min_px is not"},
    {"ShortXMax", [](Table& t) { t.x_max_px.pop_back(); }, "the length of x_max_px is not"},
    {"ShortYMin", [](Table& t) { t.y_min_px.pop_back(); }, "the length of y_min_px is not"},
    {"ShortYMax", [](Table& t) { t.y_max_px.pop_back(); }, "the length of y_max_px is not"},
    {"EmptyRSquared", [](Table& t) { t.r_squared.clear(); }, "the length of r_squared is not"},
    {"ShortSigma", [](Table& t) { t.residual_sigma_m.pop_back(); },
     "the length of residual_sigma_m is not"},
    {"ShortObservations", [](Table& t) { t.observations.pop_back(); },
     "the length of observations is not"},
    {"NanOffset", [](Table& t) { t.offset_m[1] = kNan; }, kOffset},
    {"InfiniteOffset", [](Table& t) { t.offset_m[1] = -kInfinity; }, kOffset},
    {"ZeroSlope", [](Table& t) { t.slope[1] = 0; }, kSlope},
    {"NegativeSlope", [](Table& t) { t.slope[1] = -1; }, kSlope},
    {"NanSlope", [](Table& t) { t.slope[1] = kNan; }, kSlope},
    {"InfiniteSlope", [](Table& t) { t.slope[1] = kInfinity; }, kSlope},
    {"ZeroScale", [](Table& t) { t.scale_min_px[0] = 0; }, kScaleMin},
    {"NanScale", [](Table& t) { t.scale_min_px[0] = kNan; }, kScaleMin},
    {"ScaleOrder", [](Table& t) { t.scale_max_px[0] = 1; }, kScaleMax},
    {"InfiniteScale", [](Table& t) { t.scale_max_px[0] = kInfinity; }, kScaleMax},
    {"NanScaleMax", [](Table& t) { t.scale_max_px[0] = kNan; }, kScaleMax},
    {"NanBegin", [](Table& t) { t.along_begin_m[1] = kNan; }, kAlong},
    {"NanEnd", [](Table& t) { t.along_end_m[1] = kNan; }, kAlong},
    {"InfiniteEnd", [](Table& t) { t.along_end_m[1] = kInfinity; }, kAlong},
    {"FarBegin", [](Table& t) { t.along_begin_m[1] = -2e8F; }, kAlong},
    {"AlongOrder", [](Table& t) { t.along_end_m[1] = 0.5F; }, kAlongOrder},
    {"XOrder", [](Table& t) { t.x_max_px[0] = 9; }, kPixels},
    {"YOrder", [](Table& t) { t.y_max_px[0] = 29; }, kPixels},
    {"SmallRSquared", [](Table& t) { t.r_squared[0] = -0.01F; }, kRSquared},
    {"LargeRSquared", [](Table& t) { t.r_squared[0] = 1.01F; }, kRSquared},
    {"NanRSquared", [](Table& t) { t.r_squared[0] = kNan; }, kRSquared},
    {"NegativeSigma", [](Table& t) { t.residual_sigma_m[0] = -0.1F; }, kSigma},
    {"NanSigma", [](Table& t) { t.residual_sigma_m[0] = kNan; }, kSigma},
    {"InfiniteSigma", [](Table& t) { t.residual_sigma_m[0] = kInfinity; }, kSigma},
    {"Observations", [](Table& t) { t.observations[1] = 2; },
     "fewer than 3 observations (FORMAT.md 3.10)"},
});

INSTANTIATE_TEST_SUITE_P(Each, TableViolation, ::testing::ValuesIn(kViolations),
                         testing::name_of<Table>);

TEST(Table, HoldsAtMost65536Tracklets) {
  constexpr std::size_t kMore = kMaxTrackletsPerTile + 1;
  Table table;
  table.slope.assign(kMore, 1);
  EXPECT_THAT(message(bytes_of(table)), HasSubstr("more than 65536 tracklets (FORMAT.md 3.5)"));
}

TEST(Table, AnotherIdentifierIsRefused) {
  EXPECT_THAT(message(bytes_of({}, "MPT2")), HasSubstr("identifier MPT1 (FORMAT.md 3.3)"));
}

TEST(Table, AMissingArrayIsRefused) {
  flatbuffers::FlatBufferBuilder builder;
  const flatbuffers::Offset<fbs::TrackletTile> root(builder.EndTable(builder.StartTable()));
  EXPECT_THAT(message(testing::content_of(builder, root, "MPT1")), HasSubstr("(FORMAT.md 3.3)"));
}

TEST(Table, NoContentIsRefused) { EXPECT_THAT(message({}), HasSubstr("(FORMAT.md 3.3)")); }

TEST(Table, EveryTruncationIsRefused) {
  testing::expect_truncations_refused(table_from_tile(testing::example_tile()), tile_from_table);
}

TEST(Table, DamagedBytesNeverDoHarm) {
  testing::expect_damage_harmless(table_from_tile(testing::example_tile()), tile_from_table,
                                  table_from_tile);
}

}  // namespace
}  // namespace milepost
