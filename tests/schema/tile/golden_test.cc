// The golden tile (tests/golden/README.md): bytes of the format's first version.
#include <gtest/gtest.h>

#include "schema/base/file.h"
#include "schema/tile/codec.h"
#include "schema/tile/frame.h"
#include "tests/schema/tile/example_tile.h"

namespace milepost {
namespace {

std::string golden_frame() {
  const auto frame = read_text_file(MILEPOST_GOLDEN_DIR "/tracklets-1.tile");
  return frame.ok() ? *frame : frame.error().line();
}

TEST(GoldenTile, StillHoldsItsTracklets) {
  const auto tile = decode_tile(as_bytes(golden_frame()));
  ASSERT_TRUE(tile.ok()) << tile.error().line();
  EXPECT_EQ(testing::text_of(*tile), *read_text_file(MILEPOST_GOLDEN_DIR "/tracklets-1.txt"));
}

// The content only: another version of zstd may make another frame of it.
TEST(GoldenTile, IsStillWrittenTheSame) {
  const auto golden = expand_frame(as_bytes(golden_frame()));
  ASSERT_TRUE(golden.ok()) << golden.error().line();
  EXPECT_EQ(*expand_frame(encode_tile(testing::example_tile())), *golden);
}

}  // namespace
}  // namespace milepost
