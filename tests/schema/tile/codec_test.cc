#include "schema/tile/codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/schema/tile/example_tile.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

// Random tracklets around `from_m`, distributed like real ones.
TrackletTile random_tile(double from_m, int count) {
  std::mt19937 random(7);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  TrackletTile tile{"a-long-road", 9, ScaleModel::inverse_scale, {}};
  for (int i = 0; i < count; ++i) {
    Tracklet t;
    for (auto& byte : t.descriptor) byte = static_cast<std::uint8_t>(uniform(0, 255));
    t.along = {from_m + uniform(0, 20), from_m + uniform(20, 120)};
    t.offset_m = t.along.to_m + uniform(5, 800);
    t.scale_min_px = static_cast<float>(uniform(1.5, 10));
    t.scale_max_px = t.scale_min_px * 2;
    t.slope = uniform(5, 3000);
    t.pixels = {static_cast<float>(uniform(0, 600)), static_cast<float>(uniform(600, 1240)),
                static_cast<float>(uniform(0, 200)), static_cast<float>(uniform(200, 375))};
    t.r_squared = static_cast<float>(uniform(0.8, 1));
    t.residual_sigma_m = static_cast<float>(uniform(0, 0.3));
    t.observations = static_cast<std::uint16_t>(uniform(3, 60));
    tile.tracklets.push_back(t);
  }
  return tile;
}

TEST(TileCodec, GivesBackWhatTheFormKeepsExactly) {
  const TrackletTile tile = testing::example_tile();
  const auto decoded = decode_tile(encode_tile(tile));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_EQ(testing::text_of(*decoded), testing::text_of(tile));
}

TEST(TileCodec, KeepsTheModel) {
  TrackletTile tile = testing::example_tile();
  tile.model = ScaleModel::scale;
  EXPECT_EQ(decode_tile(encode_tile(tile))->model, ScaleModel::scale);
}

// FORMAT.md 3.11 guarantees these bounds.
TEST(TileCodec, KeepsPositionsToAFractionOfAMillimetreFarAlong) {
  const TrackletTile tile = random_tile(100000.123456789, 500);
  const auto decoded = decode_tile(encode_tile(tile));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  ASSERT_EQ(decoded->tracklets.size(), tile.tracklets.size());
  for (std::size_t i = 0; i < tile.tracklets.size(); ++i) {
    const Tracklet& was = tile.tracklets[i];
    const Tracklet& is = decoded->tracklets[i];
    EXPECT_NEAR(is.along.from_m, was.along.from_m, 1e-5);
    EXPECT_NEAR(is.along.to_m, was.along.to_m, 1e-5);
    for (const float scale_px : {was.scale_min_px, was.scale_max_px}) {
      EXPECT_NEAR(is.along_estimate_m(tile.model, scale_px),
                  was.along_estimate_m(tile.model, scale_px), 1e-4);
    }
  }
}

TEST(TileCodec, KeepsDescriptorsScalesAndQualityExactly) {
  const TrackletTile tile = random_tile(40, 100);
  const auto decoded = decode_tile(encode_tile(tile));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  for (std::size_t i = 0; i < tile.tracklets.size(); ++i) {
    const Tracklet& was = tile.tracklets[i];
    const Tracklet& is = decoded->tracklets[i];
    EXPECT_EQ(is.descriptor, was.descriptor);
    EXPECT_EQ(is.scale_min_px, was.scale_min_px);
    EXPECT_EQ(is.scale_max_px, was.scale_max_px);
    EXPECT_EQ(is.r_squared, was.r_squared);
    EXPECT_EQ(is.residual_sigma_m, was.residual_sigma_m);
    EXPECT_EQ(is.observations, was.observations);
  }
}

TEST(TileCodec, RoundsPixelRangesOutwards) {
  TrackletTile tile = testing::example_tile();
  tile.tracklets.resize(1);
  tile.tracklets[0].pixels = {10.2F, 20.2F, -0.4F, 70000};
  const auto decoded = decode_tile(encode_tile(tile));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  const PixelRange& pixels = decoded->tracklets[0].pixels;
  EXPECT_EQ(pixels.x_min_px, 10);
  EXPECT_EQ(pixels.x_max_px, 21);
  EXPECT_EQ(pixels.y_min_px, 0);      // clamped to the range of the format
  EXPECT_EQ(pixels.y_max_px, 65535);  // the same
}

TEST(TileCodec, TakesATileWithoutTracklets) {
  const auto decoded = decode_tile(encode_tile({"s", 4, ScaleModel::scale, {}}));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_EQ(decoded->index, 4U);
  EXPECT_TRUE(decoded->tracklets.empty());
}

TEST(TileCodec, TheSameTileGivesTheSameBytes) {
  const TrackletTile tile = random_tile(0, 300);
  EXPECT_EQ(encode_tile(tile), encode_tile(tile));
}

TEST(TileCodec, WhatWasDecodedGivesTheSameContentAgain) {
  const auto decoded = decode_tile(encode_tile(random_tile(0, 50)));
  ASSERT_TRUE(decoded.ok());
  const auto again = decode_tile(encode_tile(*decoded));
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(testing::text_of(*again), testing::text_of(*decoded));
}

TEST(TileCodec, EveryTruncationIsAnError) {
  const Bytes frame = encode_tile(testing::example_tile());
  for (std::size_t length = 0; length < frame.size(); ++length) {
    const auto decoded = decode_tile(ByteView(frame).first(length));
    ASSERT_FALSE(decoded.ok()) << length;
    EXPECT_EQ(decoded.error().code, ErrorCode::corrupt);
    EXPECT_THAT(decoded.error().line(), HasSubstr("the frame is truncated (FORMAT.md 3.2)"));
  }
}

// A few bits of a frame do not affect its content; the checksum detects every other change.
TEST(TileCodec, AChangedByteIsAnErrorOrWithoutEffect) {
  const std::string text = testing::text_of(testing::example_tile());
  const Bytes good = encode_tile(testing::example_tile());
  std::size_t caught = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const int flip : {0x01, 0x80, 0xff}) {
      Bytes frame = good;
      frame[i] = static_cast<std::uint8_t>(frame[i] ^ flip);
      const auto decoded = decode_tile(frame);
      if (decoded.ok()) {
        EXPECT_EQ(testing::text_of(*decoded), text) << "byte " << i << " flipped by " << flip;
      } else {
        ++caught;
        EXPECT_EQ(decoded.error().code, ErrorCode::corrupt);
        EXPECT_THAT(decoded.error().line(), HasSubstr("FORMAT.md 3.2"));
      }
    }
  }
  EXPECT_GT(caught, 3 * good.size() - 10);
}

TEST(StoredFrameLength, CutsARangeAnswerIntoItsTiles) {
  const Bytes first = encode_tile(testing::example_tile());
  const Bytes second = encode_tile(random_tile(30, 40));
  Bytes stream = first;
  stream.insert(stream.end(), second.begin(), second.end());
  EXPECT_EQ(*stored_frame_length(stream), first.size());
  const ByteView rest = ByteView(stream).subspan(first.size());
  EXPECT_EQ(*stored_frame_length(rest), second.size());
  EXPECT_EQ(*stored_frame_length(rest.subspan(second.size())), 0U);
}

TEST(StoredFrameLength, IsZeroWhileTheFrameIsNotThere) {
  const Bytes frame = encode_tile(testing::example_tile());
  for (std::size_t length = 0; length < frame.size(); ++length) {
    const auto found = stored_frame_length(ByteView(frame).first(length));
    ASSERT_TRUE(found.ok()) << length << ": " << found.error().line();
    EXPECT_EQ(*found, 0U) << length;
  }
}

TEST(StoredFrameLength, RefusesWhatIsNoFrame) {
  for (const std::string text : {"<", "<html>", "\x28x", "\x28\xb5\x2f\xfe 123456789"}) {
    const auto length = stored_frame_length(as_bytes(text));
    ASSERT_FALSE(length.ok()) << text;
    EXPECT_EQ(length.error().code, ErrorCode::corrupt);
    EXPECT_THAT(length.error().line(), HasSubstr("no zstd frame starts here (FORMAT.md 3.2)"));
  }
}

}  // namespace
}  // namespace milepost
