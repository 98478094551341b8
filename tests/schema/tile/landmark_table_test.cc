// Tiles of landmarks: the round trip to the nearest step, and tables that each violate one
// paragraph of FORMAT.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "schema/tile/codec.h"
#include "schema/tile/columns.h"
#include "schema/tile/landmark_steps.h"
#include "schema/tile/landmark_tile_generated.h"
#include "schema/tile/table.h"
#include "schema/tile/zstd_frame.h"
#include "tests/schema/tile/hostile_table.h"

namespace milepost {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The arrays of a valid table of two landmarks.
struct Table {
  std::string segment = "s";
  double origin_m = 240;
  std::uint16_t descriptor_values = 32;
  std::vector<std::int8_t> descriptors = std::vector<std::int8_t>(2 * 32, -3);
  std::vector<std::uint8_t> position_low = {0x00, 0x18, 0x34, 0xff, 0x2c, 0x9c};
  std::vector<std::uint8_t> position_high = {0x80, 0xfc, 0x12, 0x7f, 0x01, 0xff};
  std::vector<std::uint8_t> depth_sigma = {0, 100};
  std::vector<std::uint8_t> size = {50, 255};
  std::vector<std::uint8_t> size_sigma = {0, 250};
  std::vector<std::uint16_t> begin_dm = {15, 20};
  std::vector<std::uint16_t> length_dm = {400, 0};
  std::vector<std::uint8_t> observations = {3, 255};
  std::optional<std::vector<std::uint8_t>> passes = {};
  std::optional<std::vector<std::int8_t>> right_dm = {};
};

Bytes bytes_of(const Table& t, const char* identifier = "MPL1") {
  flatbuffers::FlatBufferBuilder builder;
  const auto root = fbs::CreateLandmarkTileDirect(
      builder, t.segment.c_str(), 12, t.origin_m, t.descriptor_values, &t.descriptors,
      &t.position_low, &t.position_high, &t.depth_sigma, &t.size, &t.size_sigma, &t.begin_dm,
      &t.length_dm, &t.observations, t.passes ? &*t.passes : nullptr,
      t.right_dm ? &*t.right_dm : nullptr);
  return testing::content_of(builder, root, identifier);
}

std::string message(const Bytes& content) { return testing::message_of(content, decode_landmarks); }

TEST(LandmarkTable, TheSoundOneIsTaken) {
  Table table;
  table.descriptors[2 * 31 + 1] = 127;
  const auto tile = decode_landmarks(compress_frame(bytes_of(table)));
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_EQ(tile->segment, "s");
  EXPECT_EQ(tile->index, 12U);
  EXPECT_EQ(tile->origin_m, 240);
  ASSERT_EQ(tile->landmarks.size(), 2U);
  const Landmark& first = tile->landmarks[0];
  EXPECT_EQ(first.descriptor[31], -3);
  EXPECT_DOUBLE_EQ(first.position.east_m, -327.68);
  EXPECT_DOUBLE_EQ(first.position.north_m, 46.6);
  EXPECT_DOUBLE_EQ(first.position.up_m, 3);
  EXPECT_EQ(first.depth_sigma_m, 100);
  EXPECT_FLOAT_EQ(first.size_m, 8.7203727F);  // 100 / 1.05^50
  EXPECT_EQ(first.size_sigma, 0);
  EXPECT_DOUBLE_EQ(first.along.from_m, 241.5);
  EXPECT_DOUBLE_EQ(first.along.to_m, 281.5);
  EXPECT_EQ(first.observations, 3);
  const Landmark& second = tile->landmarks[1];
  EXPECT_EQ(second.descriptor[0], -3);
  EXPECT_EQ(second.descriptor[31], 127);
  EXPECT_DOUBLE_EQ(second.position.east_m, -10);
  EXPECT_DOUBLE_EQ(second.position.north_m, 327.67);
  EXPECT_DOUBLE_EQ(second.position.up_m, -1);
  EXPECT_EQ(second.size_sigma, 1);
  EXPECT_DOUBLE_EQ(second.along.from_m, 243.5);
  EXPECT_DOUBLE_EQ(second.along.to_m, 243.5);
  EXPECT_EQ(second.observations, 255);
}

TEST(LandmarkTable, WithoutPassesEachWasSeenByOneDrive) {
  Table table;
  const auto single = decode_landmarks(compress_frame(bytes_of(table)));
  ASSERT_TRUE(single.ok()) << single.error().line();
  EXPECT_EQ(single->landmarks[0].passes, 1);
  EXPECT_EQ(single->landmarks[1].passes, 1);
  table.passes = {1, 255};
  auto fused = decode_landmarks(compress_frame(bytes_of(table)));
  ASSERT_TRUE(fused.ok()) << fused.error().line();
  EXPECT_EQ(fused->landmarks[0].passes, 1);
  EXPECT_EQ(fused->landmarks[1].passes, 255);
  EXPECT_EQ(decode_landmarks(encode_landmarks(*fused))->landmarks[1].passes, 255);
  // A map of single drives has the bytes that it had before there were passes.
  fused->landmarks[1].passes = 1;
  EXPECT_EQ(encode_landmarks(*fused), encode_landmarks(*single));
}

TEST(LandmarkTable, WithoutRightEachWasMappedFromTheLine) {
  Table table;
  const auto on_line = decode_landmarks(compress_frame(bytes_of(table)));
  ASSERT_TRUE(on_line.ok()) << on_line.error().line();
  EXPECT_EQ(on_line->landmarks[1].right_m, 0);
  table.right_dm = {-127, 35};
  auto beside = decode_landmarks(compress_frame(bytes_of(table)));
  ASSERT_TRUE(beside.ok()) << beside.error().line();
  EXPECT_FLOAT_EQ(beside->landmarks[0].right_m, -12.7F);
  EXPECT_FLOAT_EQ(beside->landmarks[1].right_m, 3.5F);
  EXPECT_FLOAT_EQ(decode_landmarks(encode_landmarks(*beside))->landmarks[1].right_m, 3.5F);
  for (Landmark& landmark : beside->landmarks) landmark.right_m = 0.04F;  // less than half a step
  EXPECT_EQ(encode_landmarks(*beside), encode_landmarks(*on_line));
}

// Distributed like real ones: descriptors with decreasing variance, landmarks on both sides of a
// road to the north-east, nearly all of them visible for some metres.
LandmarkTile random_tile(double origin_m, int count) {
  std::mt19937 random(7);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const auto normal = [&](double sigma) {
    return std::normal_distribution<double>(0, sigma)(random);
  };
  LandmarkTile tile{"a-long-road", 9, origin_m, {}};
  for (int i = 0; i < count; ++i) {
    Landmark landmark;
    for (std::size_t k = 0; k < kCompactValues; ++k) {
      landmark.descriptor[k] =
          static_cast<std::int8_t>(std::clamp(normal(10 * std::pow(0.95, k)), -128.0, 127.0));
    }
    const double ahead_m = uniform(5, 120);
    const double right_m = normal(8);
    landmark.position = {0.6 * ahead_m + 0.8 * right_m, 0.8 * ahead_m - 0.6 * right_m,
                         uniform(-1.6, 8)};
    landmark.depth_sigma_m = static_cast<float>(0.02 * ahead_m * std::exp(normal(0.5)));
    landmark.size_m = static_cast<float>(0.4 * std::exp(normal(0.7)));
    landmark.size_sigma = static_cast<float>(uniform(0, 0.2));
    landmark.along.from_m = origin_m + uniform(0, 20);
    landmark.along.to_m = landmark.along.from_m + uniform(1, 30);
    landmark.observations = static_cast<std::uint8_t>(uniform(3, 20));
    tile.landmarks.push_back(landmark);
  }
  std::ranges::sort(tile.landmarks, {}, [](auto& landmark) { return landmark.along.from_m; });
  return tile;
}

// landmark.h guarantees these steps.
TEST(LandmarkTable, KeepsEveryLandmarkToHalfAStep) {
  const LandmarkTile tile = random_tile(100000.123456789, 300);
  const auto decoded = decode_landmarks(encode_landmarks(tile));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_EQ(decoded->origin_m, tile.origin_m);
  ASSERT_EQ(decoded->landmarks.size(), tile.landmarks.size());
  for (std::size_t i = 0; i < tile.landmarks.size(); ++i) {
    const Landmark& was = tile.landmarks[i];
    const Landmark& is = decoded->landmarks[i];
    EXPECT_EQ(is.descriptor, was.descriptor);
    EXPECT_NEAR(is.position.east_m, was.position.east_m, 0.005 + 1e-9);
    EXPECT_NEAR(is.position.north_m, was.position.north_m, 0.005 + 1e-9);
    EXPECT_NEAR(is.position.up_m, was.position.up_m, 0.005 + 1e-9);
    EXPECT_NEAR(is.depth_sigma_m / was.depth_sigma_m, 1, 0.025);
    EXPECT_NEAR(is.size_m / was.size_m, 1, 0.025);
    EXPECT_NEAR(is.size_sigma, was.size_sigma, 0.002 + 1e-6);
    EXPECT_NEAR(is.along.from_m, was.along.from_m, 0.05 + 1e-6);
    EXPECT_NEAR(is.along.to_m, was.along.to_m, 0.05 + 1e-6);
    EXPECT_EQ(is.observations, was.observations);
  }
}

TEST(LandmarkTable, WhatComesBackIsTheQuantizedTile) {
  const LandmarkTile expected = quantized(random_tile(99999.987654321, 100));
  const auto decoded = decode_landmarks(encode_landmarks(random_tile(99999.987654321, 100)));
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  ASSERT_EQ(decoded->landmarks.size(), expected.landmarks.size());
  for (std::size_t i = 0; i < expected.landmarks.size(); ++i) {
    const Landmark& was = expected.landmarks[i];
    const Landmark& is = decoded->landmarks[i];
    EXPECT_EQ(is.position.east_m, was.position.east_m);
    EXPECT_EQ(is.position.north_m, was.position.north_m);
    EXPECT_EQ(is.position.up_m, was.position.up_m);
    EXPECT_EQ(is.depth_sigma_m, was.depth_sigma_m);
    EXPECT_EQ(is.size_m, was.size_m);
    EXPECT_EQ(is.size_sigma, was.size_sigma);
    EXPECT_EQ(is.along.from_m, was.along.from_m);
    EXPECT_EQ(is.along.to_m, was.along.to_m);
  }
  EXPECT_EQ(decoded->along().from_m, expected.along().from_m);
  EXPECT_EQ(decoded->along().to_m, expected.along().to_m);
}

TEST(LandmarkTable, WhatWasDecodedGivesTheSameBytesAgain) {
  for (const double origin_m : {-1e8, 0.0, 123.456, 99990000.3}) {
    const Bytes frame = encode_landmarks(random_tile(origin_m, 150));
    const auto decoded = decode_landmarks(frame);
    ASSERT_TRUE(decoded.ok()) << decoded.error().line();
    EXPECT_EQ(encode_landmarks(*decoded), frame) << origin_m;
  }
}

TEST(LandmarkTable, EveryStepIsKept) {
  for (int value = INT16_MIN; value <= UINT16_MAX; ++value) {
    LandmarkSteps steps;
    steps.east_cm = steps.north_cm = steps.up_cm = static_cast<std::int16_t>(value);
    steps.depth_sigma = steps.size = static_cast<std::uint8_t>(value);
    steps.size_sigma = static_cast<std::uint8_t>((value & 0xff) % 251);
    steps.right_dm = static_cast<std::int8_t>(std::max(-127, value % 128));
    steps.begin_dm = static_cast<std::uint16_t>(value);
    steps.length_dm = static_cast<std::uint16_t>(65535 - value);
    const LandmarkSteps again = steps_of(landmark_of(steps, 98765.4321), 98765.4321);
    ASSERT_EQ(again.east_cm, steps.east_cm);
    ASSERT_EQ(again.north_cm, steps.north_cm);
    ASSERT_EQ(again.up_cm, steps.up_cm);
    ASSERT_EQ(again.depth_sigma, steps.depth_sigma);
    ASSERT_EQ(again.size, steps.size);
    ASSERT_EQ(again.size_sigma, steps.size_sigma);
    ASSERT_EQ(again.right_dm, steps.right_dm);
    ASSERT_EQ(again.begin_dm, steps.begin_dm);
    ASSERT_EQ(again.length_dm, steps.length_dm);
  }
}

TEST(LandmarkTable, ValuesBeyondTheLastStepTakeIt) {
  Landmark landmark;
  landmark.position = {400, -400, 0};
  landmark.depth_sigma_m = 1000;
  landmark.size_m = 1e-9F;
  landmark.size_sigma = 1.5F;
  landmark.along = {9, 9000};
  landmark.right_m = -40;
  const LandmarkSteps steps = steps_of(landmark, 10);
  EXPECT_THAT((std::array{steps.east_cm, steps.north_cm}), ElementsAre(INT16_MAX, INT16_MIN));
  EXPECT_EQ(steps.depth_sigma, 0);
  EXPECT_EQ(steps.size, 255);
  EXPECT_EQ(steps.size_sigma, 250);
  EXPECT_EQ(steps.begin_dm, 0);
  EXPECT_EQ(steps.length_dm, 65535);
  EXPECT_EQ(steps.right_dm, -127);
}

TEST(LandmarkTable, TakesATileWithoutLandmarks) {
  const Bytes frame = encode_landmarks({"a-long-road", 4, 80, {}});
  const auto decoded = decode_landmarks(frame);
  ASSERT_TRUE(decoded.ok()) << decoded.error().line();
  EXPECT_TRUE(decoded->landmarks.empty());
  EXPECT_LT(frame.size(), 140U);  // the overhead of a tile
}

TEST(LandmarkTable, ALandmarkTakesLessThan31Bytes) {
  EXPECT_LT(encode_landmarks(random_tile(500, 200)).size(), 200U * 31);
}

TEST(LandmarkTable, AlongHoldsEveryLandmark) {
  LandmarkTile tile{"s", 0, 0, std::vector<Landmark>(3)};
  tile.landmarks[0].along = {1, 5};
  tile.landmarks[1].along = {2, 90};
  tile.landmarks[2].along = {3, 8};
  EXPECT_EQ(tile.along().from_m, 1);
  EXPECT_EQ(tile.along().to_m, 90);
}

using Violation = testing::Violation<Table>;

class LandmarkViolation : public ::testing::TestWithParam<Violation> {};

TEST_P(LandmarkViolation, IsNamedWithItsParagraph) {
  Table table;
  GetParam().make(table);
  EXPECT_THAT(message(bytes_of(table)), HasSubstr(GetParam().message));
}

const char* const kPositions =
    "tile s/12: the positions are not 3 times as many as observations (FORMAT.md 5.5)";
const char* const kDescriptors =
    "tile s/12: the length of descriptors is not 32 times that of observations (FORMAT.md 5.4)";

const std::vector<Violation> kViolations = testing::with_broken_heads<Table>({
    {"ShortObservations", [](Table& t) { t.observations.pop_back(); },
     "tile s/12: the length of depth_sigma is not that of observations (FORMAT.md 5.3)"},
    {"LongDepthSigma", [](Table& t) { t.depth_sigma.push_back(9); },
     "the length of depth_sigma is not that of observations (FORMAT.md 5.3)"},
    {"ShortSize", [](Table& t) { t.size.pop_back(); },
     "the length of size is not that of observations (FORMAT.md 5.3)"},
    {"ShortSizeSigma", [](Table& t) { t.size_sigma.pop_back(); },
     "the length of size_sigma is not that of observations (FORMAT.md 5.3)"},
    {"ShortBegin", [](Table& t) { t.begin_dm.pop_back(); },
     "the length of begin_dm is not that of observations (FORMAT.md 5.3)"},
    {"LongLength", [](Table& t) { t.length_dm.push_back(1); },
     "the length of length_dm is not that of observations (FORMAT.md 5.3)"},
    {"DescriptorValues", [](Table& t) { t.descriptor_values = 16; },
     "tile s/12: a descriptor does not have 32 values (FORMAT.md 5.4)"},
    {"ShortDescriptors", [](Table& t) { t.descriptors.pop_back(); }, kDescriptors},
    {"LongDescriptors", [](Table& t) { t.descriptors.push_back(0); }, kDescriptors},
    {"ShortLow", [](Table& t) { t.position_low.pop_back(); }, kPositions},
    {"ShortHigh", [](Table& t) { t.position_high.pop_back(); }, kPositions},
    {"LongHigh", [](Table& t) { t.position_high.push_back(0); }, kPositions},
    {"LargeSizeSigma", [](Table& t) { t.size_sigma[1] = 251; },
     "tile s/12, landmark 1: the size sigma is above 1 (FORMAT.md 5.6)"},
    {"FarBegin",
     [](Table& t) {
       t.begin_dm = {65535, 1};
     },
     "tile s/12, landmark 1: it begins more than 6553.5 m after the origin (FORMAT.md 5.7)"},
    {"FarEnd", [](Table& t) { t.origin_m = 1e8 - 30; },
     "tile s/12, landmark 0: the along range is out of range (FORMAT.md 5.7)"},
    {"TwoObservations", [](Table& t) { t.observations[0] = 2; },
     "tile s/12, landmark 0: fewer than 3 observations (FORMAT.md 5.8)"},
    {"ShortPasses", [](Table& t) { t.passes = {2}; },
     "tile s/12: passes are not as many as observations (FORMAT.md 5.10)"},
    {"NoPass",
     [](Table& t) {
       t.passes = {2, 0};
     },
     "tile s/12, landmark 1: no pass (FORMAT.md 5.10)"},
    {"ShortRight", [](Table& t) { t.right_dm = {2}; },
     "tile s/12: right_dm are not as many as observations (FORMAT.md 5.11)"},
    {"RightBelowTheLeast",
     [](Table& t) {
       t.right_dm = {0, -128};
     },
     "tile s/12, landmark 1: right_dm is -128 (FORMAT.md 5.11)"},
});

INSTANTIATE_TEST_SUITE_P(Each, LandmarkViolation, ::testing::ValuesIn(kViolations),
                         testing::name_of<Table>);

TEST(LandmarkTable, HoldsAtMost65536Landmarks) {
  Table table;
  table.observations.assign(kMaxLandmarksPerTile + 1, 3);
  EXPECT_THAT(message(bytes_of(table)), HasSubstr("more than 65536 landmarks (FORMAT.md 5.3)"));
}

TEST(LandmarkTable, ATileOfTrackletsIsNone) {
  EXPECT_THAT(message(bytes_of({}, "MPT1")), HasSubstr("identifier MPL1 (FORMAT.md 5.2)"));
}

TEST(LandmarkTable, EveryTruncationIsRefused) {
  testing::expect_truncations_refused(bytes_of({}), landmarks_from_table);
}

TEST(LandmarkTable, DamagedBytesNeverDoHarm) {
  testing::expect_damage_harmless(bytes_of({}), landmarks_from_table, table_from_landmarks);
}

}  // namespace
}  // namespace milepost
