#include "mapper/import/ros/expansion.h"

#include <bzlib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <string>

namespace milepost::ros {
namespace {

using ::testing::HasSubstr;

const std::string kContent = std::string(100'000, 'a') + "the end";

std::string by_bz2() {
  std::string text = kContent;
  std::string packed(1000, '\0');
  auto size = static_cast<unsigned>(packed.size());
  BZ2_bzBuffToBuffCompress(packed.data(), &size, text.data(), static_cast<unsigned>(text.size()), 9,
                           0, 0);
  return packed.substr(0, size);
}

std::string by_lz4() {
  std::string packed(LZ4F_compressFrameBound(kContent.size(), nullptr), '\0');
  packed.resize(
      LZ4F_compressFrame(packed.data(), packed.size(), kContent.data(), kContent.size(), nullptr));
  return packed;
}

std::string by_zstd() {
  std::string packed(ZSTD_compressBound(kContent.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), kContent.data(), kContent.size(), 3));
  return packed;
}

std::string outcome(const Result<ExpandedBytes>& content) {
  if (!content) return content.error().line();
  return as_text(content->view()) == kContent ? "as it was" : "other content";
}

std::string chunk(const std::string& packed, const std::string& compression,
                  std::size_t size = kContent.size()) {
  return outcome(expanded_chunk(as_bytes(packed), compression, size));
}

TEST(ExpandedChunk, HasItsContent) {
  EXPECT_EQ(chunk(kContent, "none"), "as it was");
  EXPECT_EQ(chunk(by_bz2(), "bz2"), "as it was");
  EXPECT_EQ(chunk(by_lz4(), "lz4"), "as it was");
}

TEST(ExpandedChunk, IsOfTheSizeThatIsStated) {
  for (const std::size_t size : {std::size_t{0}, kContent.size() - 1, kContent.size() + 1}) {
    EXPECT_THAT(chunk(kContent, "none", size), HasSubstr("cannot be decompressed")) << size;
    EXPECT_THAT(chunk(by_bz2(), "bz2", size), HasSubstr("cannot be decompressed")) << size;
    EXPECT_THAT(chunk(by_lz4(), "lz4", size), HasSubstr("cannot be decompressed")) << size;
  }
  EXPECT_THAT(chunk(by_lz4(), "lz4", 0xffffffff), HasSubstr("states more than 1 GiB"));
}

TEST(ExpandedChunk, IsRefusedWhereverItIsCut) {
  for (const auto& [packed, compression] : {std::pair{by_bz2(), "bz2"}, {by_lz4(), "lz4"}}) {
    for (std::size_t size = 0; size < packed.size(); ++size)
      EXPECT_THAT(chunk(packed.substr(0, size), compression), HasSubstr("cannot be decompressed"))
          << compression << size;
  }
}

TEST(ExpandedChunk, NamesAnUnknownCompression) {
  EXPECT_THAT(chunk(kContent, "xz"), HasSubstr("is compressed as 'xz'"));
}

TEST(ExpandedZstd, HasItsContent) {
  const std::string packed = by_zstd();
  EXPECT_TRUE(is_zstd(as_bytes(packed)));
  EXPECT_FALSE(is_zstd(as_bytes(kContent)));
  EXPECT_FALSE(is_zstd({}));
  EXPECT_EQ(outcome(expanded_zstd(as_bytes(packed))), "as it was");
  for (std::size_t size = 0; size < packed.size(); ++size)
    EXPECT_THAT(outcome(expanded_zstd(as_bytes(packed).first(size))),
                HasSubstr("cannot be decompressed"));
}

}  // namespace
}  // namespace milepost::ros
