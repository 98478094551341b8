// zstd frames that another program could produce from a tile's content, but FORMAT.md 3.2 forbids.
#include "schema/tile/zstd_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <array>
#include <random>

namespace milepost {
namespace {

using ::testing::HasSubstr;

struct FrameSettings {
  int checksum = 1;
  int content_size = 1;
};

Bytes compressed(const Bytes& content, const FrameSettings& settings) {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, settings.checksum);
  ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, settings.content_size);
  Bytes frame(ZSTD_compressBound(content.size()));
  frame.resize(ZSTD_compress2(context, frame.data(), frame.size(), content.data(), content.size()));
  ZSTD_freeCCtx(context);
  return frame;
}

std::string message(const Bytes& frame) {
  const auto content = expand_frame(frame);
  return content.ok() ? "no error" : content.error().line();
}

const Bytes kContent(1000, 'x');

TEST(Frame, GivesBackItsContent) {
  EXPECT_EQ(*expand_frame(compress_frame(kContent)), kContent);
  EXPECT_EQ(*expand_frame(compress_frame({})), Bytes());
}

// Bytes of two successive distributions.
Bytes two_halves() {
  std::mt19937 random(3);
  Bytes content;
  for (int i = 0; i < 2000; ++i) content.push_back(static_cast<std::uint8_t>(random() % 4));
  for (int i = 0; i < 2000; ++i) content.push_back(static_cast<std::uint8_t>(128 + random() % 64));
  return content;
}

TEST(Frame, CutsMakeItSmallerButNothingElse) {
  const Bytes content = two_halves();
  const Bytes whole = compress_frame(content);
  const Bytes cut = compress_frame(content, std::array<std::size_t, 1>{2000});
  EXPECT_EQ(*expand_frame(cut), content);
  EXPECT_LT(cut.size() + 200, whole.size());
  EXPECT_EQ(*frame_length(cut), cut.size());
  EXPECT_EQ(ZSTD_getFrameContentSize(cut.data(), cut.size()), 4000U);
}

TEST(Frame, TakesAnyCut) {
  const Bytes content = two_halves();
  const std::vector<std::size_t> cuts = {0, 0, 1, 2, 3, 3, 3999, 4000};
  EXPECT_EQ(*expand_frame(compress_frame(content, cuts)), content);
  EXPECT_EQ(*expand_frame(compress_frame({}, std::vector<std::size_t>{0, 0})), Bytes());
}

TEST(Frame, StatesSizeAndChecksumOfItsContent) {
  const Bytes frame = compress_frame(kContent);
  EXPECT_EQ(ZSTD_getFrameContentSize(frame.data(), frame.size()), 1000U);
  EXPECT_THAT(message(compressed(kContent, {0, 1})),
              HasSubstr("the frame has no checksum (FORMAT.md 3.2)"));
}

TEST(Frame, MustStateItsSize) {
  EXPECT_THAT(message(compressed(kContent, {1, 0})),
              HasSubstr("does not state its content's size (FORMAT.md 3.2)"));
}

TEST(Frame, MustNotStateMoreThanTheLimit) {
  const Bytes allowed(kMaxTileContentBytes);
  EXPECT_EQ(*expand_frame(compress_frame(allowed)), allowed);
  const Bytes more(kMaxTileContentBytes + 1);
  EXPECT_THAT(message(compress_frame(more)),
              HasSubstr("states more than 16 MiB of content (FORMAT.md 3.2)"));
}

TEST(Frame, NothingMayFollow) {
  Bytes frame = compress_frame(kContent);
  frame.push_back(0);
  EXPECT_THAT(message(frame), HasSubstr("bytes follow the frame (FORMAT.md 3.2)"));
  Bytes twice = compress_frame(kContent);
  const Bytes once = twice;
  twice.insert(twice.end(), once.begin(), once.end());
  EXPECT_THAT(message(twice), HasSubstr("bytes follow the frame (FORMAT.md 3.2)"));
}

TEST(Frame, ADamagedContentBreaksTheChecksum) {
  Bytes frame = compress_frame(kContent);
  frame.back() ^= 1U;
  EXPECT_THAT(message(frame), HasSubstr("cannot be decompressed: "));
  EXPECT_THAT(message(frame), HasSubstr("checksum"));
}

TEST(Frame, ASkippableFrameIsNone) {
  const Bytes skippable = {0x50, 0x2A, 0x4D, 0x18, 1, 0, 0, 0, 'x'};
  EXPECT_THAT(message(skippable), HasSubstr("no zstd frame starts here (FORMAT.md 3.2)"));
}

// An endless sequence of empty raw blocks, which must not be read to its end.
TEST(Frame, AnEndlessFrameIsRefused) {
  Bytes stream = {0x28, 0xB5, 0x2F, 0xFD, 0x04, 0x00};
  stream.resize(stream.size() + 3 * 5'700'000, 0);
  const auto length = frame_length(stream);
  ASSERT_FALSE(length.ok());
  EXPECT_THAT(length.error().line(), HasSubstr("longer than one of 16 MiB"));
}

TEST(Frame, AReservedBlockIsDamage) {
  Bytes frame = {0x28, 0xB5, 0x2F, 0xFD, 0x04, 0x00, 0x07, 0, 0, 0, 0, 0, 0};
  const auto length = frame_length(frame);
  ASSERT_FALSE(length.ok());
  EXPECT_THAT(length.error().line(), HasSubstr("the frame is damaged (FORMAT.md 3.2)"));
}

}  // namespace
}  // namespace milepost
