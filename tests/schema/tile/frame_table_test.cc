// Tiles of frames: the round trip, and tables that each violate one paragraph of FORMAT.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "schema/tile/codec.h"
#include "schema/tile/frame_tile_generated.h"
#include "schema/tile/table.h"
#include "schema/tile/zstd_frame.h"
#include "tests/schema/tile/hostile_table.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

using testing::kInfinity;
using testing::kNan;

// The arrays of a valid table of two frames, with two features and with one.
struct Table {
  std::string segment = "s";
  double origin_m = 50;
  std::uint16_t descriptor_bytes = 128;
  std::uint16_t image_values = 64;
  std::vector<float> along_m = {0, 2};
  std::vector<std::uint32_t> features = {2, 1};
  std::vector<float> image_descriptors = std::vector<float>(2 * 64, 0.125F);
  std::vector<std::uint8_t> descriptors = std::vector<std::uint8_t>(3 * 128, 7);
  std::vector<float> scale_px = {2, 3, 4};
  std::vector<std::uint16_t> x_px = {10, 11, 12};
  std::vector<std::uint16_t> y_px = {30, 31, 32};
};

Bytes bytes_of(const Table& t, const char* identifier = "MPF1") {
  flatbuffers::FlatBufferBuilder builder;
  const auto root = fbs::CreateImageDescriptorTileDirect(
      builder, t.segment.c_str(), 12, t.origin_m, t.descriptor_bytes, t.image_values, &t.along_m,
      &t.features, &t.image_descriptors, &t.descriptors, &t.scale_px, &t.x_px, &t.y_px);
  return testing::content_of(builder, root, identifier);
}

std::string message(const Bytes& content) { return testing::message_of(content, decode_frames); }

TEST(FrameTable, TheSoundOneIsTaken) {
  const auto tile = decode_frames(compress_frame(bytes_of({})));
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_EQ(tile->segment, "s");
  EXPECT_EQ(tile->index, 12U);
  ASSERT_EQ(tile->frames.size(), 2U);
  EXPECT_EQ(tile->frames[1].along_m, 52);
  ASSERT_EQ(tile->frames[1].features.size(), 1U);
  EXPECT_EQ(tile->frames[1].features.features[0].y_px, 32);
  ASSERT_TRUE(tile->frames[1].image.has_value());
  EXPECT_EQ((*tile->frames[1].image)[63], 0.125F);
}

TEST(FrameTable, KeepsEveryFeature) {
  std::mt19937 random(7);
  ImageDescriptorTile tile{"a-long-road", 9, {}};
  for (int i = 0; i < 10; ++i) {
    DatabaseFrame frame;
    frame.along_m = 100000.123 + 2 * i;
    for (int k = 0; k < 20; ++k) {
      frame.features.features.push_back({static_cast<float>(random() % 6000) / 10,
                                         static_cast<float>(random() % 5000) / 10,
                                         1 + static_cast<float>(random() % 100) / 7});
      for (auto& byte : frame.features.descriptors.emplace_back()) {
        byte = static_cast<std::uint8_t>(random());
      }
    }
    tile.frames.push_back(std::move(frame));
  }
  const auto decoded = decode_frames(encode_frames(tile));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  ASSERT_EQ(decoded->frames.size(), tile.frames.size());
  for (std::size_t i = 0; i < tile.frames.size(); ++i) {
    const DatabaseFrame& was = tile.frames[i];
    const DatabaseFrame& is = decoded->frames[i];
    EXPECT_NEAR(is.along_m, was.along_m, 1e-5);
    EXPECT_FALSE(is.image.has_value());
    EXPECT_EQ(is.features.descriptors, was.features.descriptors);
    for (std::size_t k = 0; k < was.features.size(); ++k) {
      EXPECT_EQ(is.features.features[k].scale_px, was.features.features[k].scale_px);
      EXPECT_NEAR(is.features.features[k].x_px, was.features.features[k].x_px, 0.5);
      EXPECT_NEAR(is.features.features[k].y_px, was.features.features[k].y_px, 0.5);
    }
  }
  EXPECT_EQ(encode_frames(tile), encode_frames(tile));
}

TEST(FrameTable, KeepsImageDescriptorsExactly) {
  ImageDescriptorTile tile{"s", 0, {{10, {}, ImageDescriptor{}}, {12, {}, ImageDescriptor{}}}};
  (*tile.frames[1].image)[5] = -0.7F;
  const auto decoded = decode_frames(encode_frames(tile));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_EQ(decoded->frames[0].image, tile.frames[0].image);
  EXPECT_EQ(decoded->frames[1].image, tile.frames[1].image);
}

TEST(FrameTable, TakesATileWithoutFrames) {
  const auto decoded = decode_frames(encode_frames({"s", 4, {}}));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_TRUE(decoded->frames.empty());
}

using Violation = testing::Violation<Table>;

class FrameViolation : public ::testing::TestWithParam<Violation> {};

TEST_P(FrameViolation, IsNamedWithItsParagraph) {
  Table table;
  GetParam().make(table);
  EXPECT_THAT(message(bytes_of(table)), HasSubstr(GetParam().message));
}

const char* const kImages =
    "the length of image_descriptors is not image_values times along_m's (FORMAT.md 4.8)";
const char* const kImageValue =
    "tile s/12, frame 1: a value of the image descriptor is not in [-1, 1] (FORMAT.md 4.8)";
const char* const kSum = "the length of scale_px is not the sum of features (FORMAT.md 4.9)";
const char* const kDescriptors =
    "the length of descriptors is not 128 times that of scale_px (FORMAT.md 4.9)";
const char* const kScale = "frame 0: a scale is not finite and above 0 (FORMAT.md 4.9)";
const char* const kAlong = "frame 1: its along_m is out of range (FORMAT.md 4.7)";

const std::vector<Violation> kViolations = testing::with_broken_heads<Table>({
    {"ShortCounts", [](Table& t) { t.features.pop_back(); },
     "tile s/12: the length of features is not that of along_m (FORMAT.md 4.7)"},
    {"NanAlong", [](Table& t) { t.along_m[1] = kNan; }, kAlong},
    {"FarAlong", [](Table& t) { t.along_m[1] = 2e8F; }, kAlong},
    {"AlongOrder", [](Table& t) { t.along_m[1] = 0; },
     "frame 1: along_m of the frames does not ascend (FORMAT.md 4.7)"},
    {"ImageValues", [](Table& t) { t.image_values = 32; },
     "an image descriptor does not have 64 values (FORMAT.md 4.8)"},
    {"ShortImages", [](Table& t) { t.image_descriptors.pop_back(); }, kImages},
    {"UnannouncedImages", [](Table& t) { t.image_values = 0; }, kImages},
    {"NanImage", [](Table& t) { t.image_descriptors[64] = kNan; }, kImageValue},
    {"LargeImage", [](Table& t) { t.image_descriptors[127] = -1.1F; }, kImageValue},
    {"DescriptorBytes", [](Table& t) { t.descriptor_bytes = 64; },
     "a descriptor does not have 128 bytes (FORMAT.md 4.9)"},
    {"TooManyCounted", [](Table& t) { t.features[1] = 2; }, kSum},
    {"OverflowingCounts",
     [](Table& t) {
       t.features = {0xffffffff, 4};
     },
     kSum},
    {"ShortScale", [](Table& t) { t.scale_px.pop_back(); }, kSum},
    {"ShortDescriptors", [](Table& t) { t.descriptors.pop_back(); }, kDescriptors},
    {"ShortX", [](Table& t) { t.x_px.pop_back(); },
     "the length of x_px is not that of scale_px (FORMAT.md 4.9)"},
    {"LongY", [](Table& t) { t.y_px.push_back(1); }, "the length of y_px is not"},
    {"ZeroScale", [](Table& t) { t.scale_px[1] = 0; }, kScale},
    {"NanScale", [](Table& t) { t.scale_px[1] = kNan; }, kScale},
    {"InfiniteScale", [](Table& t) { t.scale_px[1] = kInfinity; }, kScale},
});

INSTANTIATE_TEST_SUITE_P(Each, FrameViolation, ::testing::ValuesIn(kViolations),
                         testing::name_of<Table>);

TEST(FrameTable, ATileOfTrackletsIsNone) {
  EXPECT_THAT(message(bytes_of({}, "MPT1")), HasSubstr("identifier MPF1 (FORMAT.md 4.6)"));
}

TEST(FrameTable, EveryTruncationIsRefused) {
  testing::expect_truncations_refused(bytes_of({}), frames_from_table);
}

TEST(FrameTable, DamagedBytesNeverDoHarm) {
  testing::expect_damage_harmless(bytes_of({}), frames_from_table, table_from_frames);
}

}  // namespace
}  // namespace milepost
