// The golden tiles (tests/golden/README.md): bytes of the format's first version.
#include <gtest/gtest.h>

#include "schema/base/file.h"
#include "schema/tile/codec.h"
#include "schema/tile/zstd_frame.h"
#include "tests/schema/tile/example_landmarks.h"
#include "tests/schema/tile/example_tile.h"

namespace milepost {
namespace {

std::string golden(const std::string& name) {
  const auto content = read_text_file(MILEPOST_GOLDEN_DIR "/" + name);
  return content.ok() ? *content : content.error().line();
}

TEST(GoldenTile, StillHoldsItsTracklets) {
  const auto tile = decode_tile(as_bytes(golden("tracklets-1.tile")));
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_EQ(testing::text_of(*tile), golden("tracklets-1.txt"));
}

TEST(GoldenTile, StillHoldsItsLandmarks) {
  const auto tile = decode_landmarks(as_bytes(golden("landmarks-1.tile")));
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_EQ(testing::text_of(*tile), golden("landmarks-1.txt"));
}

// The content only: another version of zstd may compress it differently.
TEST(GoldenTile, IsStillWrittenTheSame) {
  const auto written_as = [](const Bytes& frame, const std::string& name) {
    const auto content = expand_frame(as_bytes(golden(name)));
    ASSERT_TRUE(content.ok()) << content.error().line();
    EXPECT_EQ(*expand_frame(frame), *content) << name;
  };
  written_as(encode_tile(testing::example_tile()), "tracklets-1.tile");
  written_as(encode_landmarks(testing::example_landmarks()), "landmarks-1.tile");
}

}  // namespace
}  // namespace milepost
